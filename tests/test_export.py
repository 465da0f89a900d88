"""Exported controllers act as they did, in a process without hybrid_rl."""

import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import call_command, refusal

from hybrid_rl import export
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.models.world import World
from hybrid_rl.networks import ACTIVATIONS
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.policies.deterministic import Clones
from hybrid_rl.policies.linear import Linear
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.policies.unit_gaussian import UnitGaussian
from hybrid_rl.proposals.policy import PolicyProposal
from hybrid_rl.rewards.known import KnownReward
from hybrid_rl.run import exported
from hybrid_rl.run.saved import Trained
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Params

pytestmark = pytest.mark.turns(3)

SPEC = Pendulum().spec
KEYS = jax.random.split(jax.random.key(0), 2)
MODEL = Gaussian(hidden=(8,))
POLICY = TanhGaussian((8, 4), "silu", normalise=True)
GOAL = PredictedReturn(KnownReward(Pendulum()))
PLANNER = SamplingController(MODEL, GOAL, PolicyProposal(POLICY), horizon=2, samples=4)
OBS = np.random.default_rng(0).normal(size=(4, 3)).astype(np.float32)
ELSEWHERE = """
import sys
import numpy as np

import jax
from jax import export

obs, actions = np.load("obs.npy"), {}

def read(name):
    return jax.jit(export.deserialize(bytearray(open(name, "rb").read())).call)

actions["policy"] = list(map(read("policy.stablehlo"), obs))
planner, state, actions["plans"] = read("planner.stablehlo"), np.zeros(SIZE, np.uint32), []
for i, x in enumerate(obs):
    action, state = planner(x, state, np.array([5, i], np.uint32))
    actions["plans"].append(action)
assert "hybrid_rl" not in sys.modules
np.savez("actions.npz", **actions)
"""


@pytest.fixture(scope="module")
def learned():
    """Parameters of two learners, whose inputs have been normalised."""

    def params(key):
        policy = POLICY.observe(POLICY.init(key, SPEC), 3 + 2 * jax.random.normal(key, (9, 3)))
        return Params(model=MODEL.init(key, SPEC), policy=policy)

    return jax.jit(jax.vmap(params))(KEYS)


@pytest.fixture
def trained(learned, monkeypatch):
    """A run of them."""
    modes = {"policy": PolicyController(POLICY, explore=False), "full": PLANNER.greedy()}
    run = Trained("pendulum", Episode(Pendulum()), modes, learned, (3, 4), 7000, ())
    monkeypatch.setattr("hybrid_rl.run.saved.load", lambda folder: run)
    return run


def first(leaf):
    return leaf[0]


main = partial(call_command, export.main, "run=x")


def test_files_act_as_the_run_does_without_hybrid_rl(trained, tmp_path, capsys):
    """Of the second learner; the planner over four decisions of an episode."""
    assert main("seed=4", f"out={tmp_path / 'policy.stablehlo'}") == 0
    assert main("seed=4", "mode=full", f"out={tmp_path / 'planner.stablehlo'}") == 0
    size = capsys.readouterr().out.split("numpy.zeros(")[1].partition(",")[0]
    np.save(tmp_path / "obs.npy", OBS)
    code = ELSEWHERE.replace("SIZE", size)
    subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=True)
    controller, params = trained.learner(4, "policy")
    want = [controller.act(params, (), x, KEYS[0])[0] for x in OBS]
    planner, params = trained.learner(4, "full")
    decide = jax.jit(lambda *given: planner.act(params, *given)[:2])
    state, plans = planner.init(SPEC), []
    for i, x in enumerate(OBS):
        key = jax.random.wrap_key_data(jnp.array([5, i], jnp.uint32))
        u, state = decide(state, x, key)
        plans.append(u)
    with np.load(tmp_path / "actions.npz") as got:
        np.testing.assert_allclose(got["policy"], want, atol=1e-5)
        np.testing.assert_allclose(got["plans"], plans, atol=1e-5)
    assert np.ptp(want) > 0.01


def linear():
    """A linear policy, whose action is clipped."""
    rng = np.random.default_rng(1)
    params = {key: jnp.zeros((SPEC.act, SPEC.n)) for key in ("gain", "inverse")}
    params |= {"gain": jnp.asarray(rng.normal(size=(SPEC.act, SPEC.n)), jnp.float32)}
    params |= {"goal": jnp.arange(SPEC.n, dtype=jnp.float32) / 3, "hold": jnp.full(SPEC.act, 0.2)}
    return Linear(), params


def clones():
    """The first of several clones, whose outputs are clipped."""
    policy = Clones((6,), squash="clip", members=2)
    return policy, jax.tree.map(lambda leaf: 9 * leaf, policy.init(KEYS[0], SPEC))


@pytest.mark.parametrize("name", [*ACTIVATIONS, "linear", "clones"])
def test_onnx_acts_as_every_policy(learned, tmp_path, name):
    """At observations of 2 and of 20 standard deviations."""
    onnxruntime = pytest.importorskip("onnxruntime")
    if name in ACTIVATIONS:
        policy, params = replace(POLICY, activation=name), jax.tree.map(first, learned.policy)
    else:
        policy, params = {"linear": linear, "clones": clones}[name]()
    obs = np.random.default_rng(0).normal(size=(2000, 3)).astype(np.float32)
    obs *= np.repeat([2, 20], 1000)[:, None]
    want = jax.vmap(lambda x: policy.mean(params, x))(jnp.asarray(obs))
    net = policy.perceptron(params, SPEC)
    if name == "linear":  # in a world whose actions are from 2.5 to 3.5
        net, want = net._replace(span=np.float32([[3], [0.5]])), 3 + want / 2
    exported.save_onnx(tmp_path / "policy.onnx", "pendulum", SPEC, net)
    (got,) = onnxruntime.InferenceSession(tmp_path / "policy.onnx").run(None, {"obs": obs})
    np.testing.assert_allclose(got, want, atol=1e-5)
    assert np.ptp(want) > 0.1


def test_the_node_of_the_how_to_publishes_only_what_a_fresh_observation_gives(monkeypatch):
    """Without ROS: the safe action before the first observation and after a stale one."""
    page = (Path(__file__).parents[1] / "docs" / "howto_deploy.md").read_text(encoding="utf-8")
    code = page.split("## A trained policy on a robot")[1].split("```python\n")[1].split("```")[0]
    clock, sent = SimpleNamespace(now=0.0), []

    class Time(float):
        def __sub__(self, other):
            return SimpleNamespace(nanoseconds=1e9 * (float(self) - float(other)))

    class Node:
        def __init__(self, name):
            self.timers, self.topics = [], {}

        def get_clock(self):
            return SimpleNamespace(now=lambda: Time(1 + clock.now))

        def create_subscription(self, kind, topic, call, depth):
            self.topics[topic] = call

        def create_publisher(self, kind, topic, depth):
            return SimpleNamespace(publish=lambda message: sent.append(message.data))

        def create_timer(self, period, call):
            self.timers.append((period, call))

    class Session:
        def __init__(self, file):
            pass

        def run(self, names, given):
            return [given["obs"][:, :6] / 10]

    ros = SimpleNamespace(init=lambda: None, spin=lambda node: None)
    message = SimpleNamespace(JointState=object, Float64MultiArray=SimpleNamespace)
    stubs = {"rclpy": ros, "rclpy.node": SimpleNamespace(Node=Node), "sensor_msgs.msg": message}
    stubs |= {"std_msgs.msg": message, "onnxruntime": SimpleNamespace(InferenceSession=Session)}
    for name, module in stubs.items():
        monkeypatch.setitem(sys.modules, name, module)
    names: dict = {}
    exec(compile(code, "howto_deploy.md", "exec"), names)
    node = names["Policy"]()
    ((period, decide),), observe = node.timers, node.topics["joint_states"]
    for age, value in ((0.0, None), (0.02, 1.0), (0.2, None), (0.0, np.nan)):
        if value is not None:
            observe(SimpleNamespace(position=[value] * 6, velocity=[0.0] * 6))
        clock.now += age
        decide()
    assert period == names["DT"]
    np.testing.assert_allclose([row[0] for row in sent], [0, 0.1, 0, 0], atol=1e-6)


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ("out=a.npz", "out=a.npz: must end in .stablehlo, .onnx"),
        ("mode=full out=a.onnx", "a multilayer perceptron of observations, this is Sampling"),
        ("mode=unit out=a.onnx", "a multilayer perceptron of observations, this is UnitGauss"),
        ("mode=lifted out=a.onnx", "of observations, this is a policy of features"),
        ("mode=world out=a.stablehlo", "mode=world: plans from the state of the world"),
        ("mode=both out=a.onnx", "mode=both: choose one of policy, full"),
        ("seed=5 out=a.onnx", "seed=5: choose one of 3, 4"),
        ("platforms=gpu out=a.stablehlo", "platforms=gpu: choose one of cpu, cuda"),
    ],
)
def test_what_cannot_be_exported_is_one_line(trained, tmp_path, monkeypatch, capfd, given, line):
    monkeypatch.chdir(tmp_path)
    squares = SimpleNamespace(lift=lambda params, obs: obs**2)
    trained.controllers["world"] = replace(PLANNER, model=World(Pendulum()))
    trained.controllers["unit"] = PolicyController(UnitGaussian())
    trained.controllers["lifted"] = PolicyController(POLICY, squares)
    assert line in refusal(capfd, "run=x", *given.split(), of=export.main)
    assert not [*tmp_path.iterdir()]
