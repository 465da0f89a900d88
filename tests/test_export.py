"""Exported controllers act as they did, in a process without hybrid_rl."""

import runpy
import subprocess
import sys
from dataclasses import replace
from functools import partial
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
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.models.world import World
from hybrid_rl.networks import ACTIVATIONS
from hybrid_rl.objectives.known_reward import KnownReward
from hybrid_rl.policies.deterministic import Clones
from hybrid_rl.policies.linear import Linear
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.policies.unit_gaussian import UnitGaussian
from hybrid_rl.proposals.policy import PolicyProposal
from hybrid_rl.trained import Trained
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Params

SPEC = Pendulum().spec
KEYS = jax.random.split(jax.random.key(0), 2)
MODEL = Gaussian(hidden=(8,))
POLICY = TanhGaussian((8, 4), "silu", normalise=True)
GOAL = KnownReward(Pendulum())
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
    monkeypatch.setattr("hybrid_rl.trained.load", lambda folder: run)
    return run


def first(leaf):
    return leaf[0]


main = partial(call, lambda: command.guarded(export.main), "run=x")


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


def in_numpy(folder, policy, params):
    """The actions at OBS of the file of a policy."""
    export.save_layers(folder / "saved.npz", "pendulum", SPEC, policy.perceptron(params, SPEC))
    return runpy.run_path(str(folder / "saved.py"))["act"](OBS)


@pytest.mark.parametrize("activation", ACTIVATIONS)
def test_the_function_of_numpy_has_every_activation(learned, tmp_path, activation):
    policy, params = replace(POLICY, activation=activation), jax.tree.map(first, learned.policy)
    want = policy.mean(params, jnp.asarray(OBS))
    np.testing.assert_allclose(in_numpy(tmp_path, policy, params), want, atol=1e-5)


def test_the_first_of_several_clones_is_written(tmp_path):
    """Their outputs are clipped."""
    clones = Clones((6,), squash="clip", members=2)
    params = jax.tree.map(lambda leaf: 9 * leaf, clones.init(KEYS[0], SPEC))
    want = clones.mean(params, jnp.asarray(OBS))
    assert (np.abs(want) == 1).any()
    np.testing.assert_allclose(in_numpy(tmp_path, clones, params), want, atol=1e-5)


def test_a_linear_policy_is_one_layer(tmp_path):
    rng = np.random.default_rng(1)
    params = {key: jnp.zeros((SPEC.act, SPEC.n)) for key in ("gain", "inverse")}
    params |= {"gain": jnp.asarray(rng.normal(size=(SPEC.act, SPEC.n)), jnp.float32)}
    params |= {"goal": jnp.arange(SPEC.n, dtype=jnp.float32) / 3, "hold": jnp.full(SPEC.act, 0.2)}
    want = np.stack([Linear().mean(params, x) for x in jnp.asarray(OBS)])
    assert (np.abs(want) == 1).any()
    assert (np.abs(want) < 1).any()
    np.testing.assert_allclose(in_numpy(tmp_path, Linear(), params), want, atol=1e-5)


def test_a_state_of_several_types_comes_back():
    state = {"a": jnp.array([1.5, -jnp.inf]), "b": jnp.array(True), "c": jnp.arange(-2, 4)}
    words = export._words(state)
    assert (words.shape, words.dtype) == ((9,), jnp.uint32)
    for got, want in zip(
        jax.tree.leaves(export._tree(words, state)), jax.tree.leaves(state), strict=True
    ):
        np.testing.assert_array_equal(got, want)
        assert got.dtype == want.dtype


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ("out=a.onnx", "out=a.onnx: must end in .stablehlo, .npz"),
        ("out=a", "out=a: must end in .stablehlo, .npz"),
        ("mode=full out=a.npz", "mode: .npz holds a policy, SamplingController plans; choose out="),
        ("mode=unit out=a.npz", "out: .npz holds a multilayer perceptron, the policy is UnitGauss"),
        ("mode=lifted out=a.npz", "out: .npz holds a policy of observations, this one has featur"),
        (
            "mode=world out=a.stablehlo",
            "mode=world: plans from the state of the world (model=world)",
        ),
        ("mode=both out=a.npz", "mode=both: the run has policy, full"),
        ("seed=5 out=a.npz", "seed=5: the run has 3, 4"),
        ("platforms=gpu out=a.stablehlo", "platforms=gpu: unknown; choose of cpu, cuda"),
        ("out=mine.npz", "out=mine.npz: mine.py would be replaced; choose another name"),
        ("", "out: not given; give out=policy.stablehlo or .npz"),
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
