"""Exported controllers act as they did, in a process without hybrid_rl."""

import runpy
import shutil
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
from tiny import call, only_line

from hybrid_rl import export
from hybrid_rl.cli import command
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.data import layers
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

sys.path.insert(0, ".")
from policy import act

obs = np.load("obs.npy")
actions = {"numpy": act(obs), "one": act(obs[0])}
assert not {"jax", "hybrid_rl"} & set(sys.modules)

import jax
from jax import export

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


main = partial(call, lambda: command.run(export.main), "run=x")


def test_files_act_as_the_run_does_without_hybrid_rl(trained, tmp_path, capsys):
    """Of the second learner; the planner over four decisions of an episode."""
    for name, mode in (("policy.npz", "policy"), ("policy.stablehlo", "policy")):
        assert main("seed=4", f"mode={mode}", f"out={tmp_path / name}") == 0
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
        for name in ("numpy", "policy"):
            np.testing.assert_allclose(got[name], want, atol=1e-5)
        np.testing.assert_allclose(got["one"], want[0], atol=1e-5)
        np.testing.assert_allclose(got["plans"], plans, atol=1e-5)
    assert np.ptp(want) > 0.01


MAIN = """#include <stdio.h>
#include "policy.h"
int main(void) {
    float x[POLICY_PENDULUM_OBS], u[POLICY_PENDULUM_ACT];
    int i;
    while (fread(x, sizeof x, 1, stdin) == 1) {
        if (policy_pendulum_act(x, u)) return 3;
        for (i = 0; i < POLICY_PENDULUM_ACT; i++) printf("%.9g ", u[i]);
    }
    return 0;
}
"""
FLAGS = "-std=c99 -O1 -Wall -Wextra -Werror -pedantic main.c -lm -o main"


def in_numpy(folder, net, obs):
    """The actions at obs [N, o] of the file of a policy."""
    layers.save_numpy(folder / "saved.npz", "pendulum", SPEC, net)
    return runpy.run_path(str(folder / "saved.py"))["act"](obs)


def in_onnx(folder, net, obs):
    onnxruntime = pytest.importorskip("onnxruntime")
    layers.save_onnx(folder / "policy.onnx", "pendulum", SPEC, net)
    (actions,) = onnxruntime.InferenceSession(folder / "policy.onnx").run(None, {"obs": obs})
    return actions


def in_c(folder, net, obs):
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    layers.save_c(folder / "policy.h", "pendulum", SPEC, net)
    (folder / "main.c").write_text(MAIN)
    subprocess.run(["gcc", *FLAGS.split()], cwd=folder, check=True)
    given = obs.astype(np.float32).tobytes()
    out = subprocess.run([folder / "main"], input=given, check=True, capture_output=True).stdout
    return np.array(out.split(), np.float32).reshape(len(obs), SPEC.act)


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


@pytest.mark.parametrize("saved", [in_numpy, in_onnx, in_c])
@pytest.mark.parametrize("name", [*ACTIVATIONS, "linear", "clones"])
def test_every_format_acts_as_every_policy(learned, tmp_path, saved, name):
    """At observations of 2 and of 20 standard deviations; C sums in double."""
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
    got = saved(tmp_path, net, obs)
    np.testing.assert_allclose(got, want, atol=2e-5 if saved is in_c else 1e-5)
    assert np.ptp(want) > 0.1


def test_the_functions_of_numpy_and_c_refuse_what_is_not_finite(tmp_path):
    net, obs = clones()[0].perceptron(clones()[1], SPEC), np.array([[0, np.nan, 0]])
    with pytest.raises(ValueError, match="obs: an entry is not finite"):
        in_numpy(tmp_path, net, obs)
    with pytest.raises(subprocess.CalledProcessError, match="exit status 3"):
        in_c(tmp_path, net, obs)


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

    ros = SimpleNamespace(init=lambda: None, spin=lambda node: None)
    message = SimpleNamespace(JointState=object, Float64MultiArray=SimpleNamespace)
    stubs = {"rclpy": ros, "rclpy.node": SimpleNamespace(Node=Node), "sensor_msgs.msg": message}
    stubs |= {"std_msgs.msg": message, "policy": SimpleNamespace(act=lambda obs: obs[:6] / 10)}
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


def test_a_state_of_several_types_comes_back():
    state = {"a": jnp.array([1.5, -jnp.inf]), "b": jnp.array(True), "c": jnp.arange(-2, 4)}
    words = exported._words(state)
    assert (words.shape, words.dtype) == ((9,), jnp.uint32)
    for got, want in zip(
        jax.tree.leaves(exported._tree(words, state)), jax.tree.leaves(state), strict=True
    ):
        np.testing.assert_array_equal(got, want)
        assert got.dtype == want.dtype


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ("out=a.pt", "out=a.pt: must end in .stablehlo, .npz, .onnx, .h"),
        ("out=a", "out=a: must end in .stablehlo, .npz, .onnx, .h"),
        (
            "mode=full out=a.npz",
            "a multilayer perceptron of observations, this is SamplingController",
        ),
        (
            "mode=unit out=a.npz",
            "out: the file holds a multilayer perceptron of observations, this is UnitGauss",
        ),
        (
            "mode=lifted out=a.npz",
            "of observations, this is a policy of features",
        ),
        (
            "mode=world out=a.stablehlo",
            "mode=world: plans from the state of the world (model=world)",
        ),
        ("mode=both out=a.npz", "mode=both: the run has policy, full"),
        ("seed=5 out=a.npz", "seed=5: the run has 3, 4"),
        ("platforms=gpu out=a.stablehlo", "platforms=gpu: choose one of cpu, cuda"),
        ("out=mine.npz", "out=mine.npz: mine.py would be replaced; choose another name"),
        ("", "out: not given; give out=policy with .stablehlo, .npz, .onnx or .h"),
    ],
)
def test_what_cannot_be_exported_is_one_line(trained, tmp_path, monkeypatch, capfd, given, line):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text("print(1)\n")
    squares = SimpleNamespace(lift=lambda params, obs: obs**2)
    trained.controllers["world"] = replace(PLANNER, model=World(Pendulum()))
    trained.controllers["unit"] = PolicyController(UnitGaussian())
    trained.controllers["lifted"] = PolicyController(POLICY, squares)
    assert main(*given.split()) == 2
    assert line in only_line(capfd)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.py"]


def test_a_run_without_a_policy_has_a_planner_to_export(trained, monkeypatch, capfd):
    monkeypatch.delitem(trained.controllers, "policy")
    assert main("out=a.npz") == 2
    assert "the run has no policy, only a planner; give mode=full" in only_line(capfd)
