"""The file of a trained policy: parameters come back bit for bit, and bad files are refused."""

from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import call_command, run

from hybrid_rl import demonstrate
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.data.trained import SavedPolicy, save
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.analytic.point_mass import PointMass
from hybrid_rl.policies.tanh_gaussian import StartedGaussian, TanhGaussian
from hybrid_rl.run.saved import load, read
from hybrid_rl.settings import build as config
from hybrid_rl.types import Params

POLICY = TanhGaussian((8, 4), "sin", normalise=True)
KEY = jax.random.key(4)
PARAMS = POLICY.init(jax.random.key(3), Pendulum().spec)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A valid file."""
    save(tmp_path / "deep" / "policy.npz", "pendulum", Pendulum().spec, PARAMS)
    return tmp_path / "deep" / "policy.npz"


def opened(file: Path, /, **fields: Any) -> SavedPolicy:
    """The policy that the pendulum reads from the file."""
    given = {"policy": POLICY, "file": str(file), "task": "pendulum", "world": Pendulum()}
    return SavedPolicy(**(given | fields))


def test_parameters_come_back_bit_for_bit(file: Path) -> None:
    """Structure, values and types; and the policy acts by them, whatever parameters it gets."""
    trained = opened(file)
    got = trained.load()
    assert jax.tree.structure(got) == jax.tree.structure(PARAMS)
    for a, b in zip(jax.tree.leaves(got), jax.tree.leaves(PARAMS), strict=True):
        np.testing.assert_array_equal(a, b)
        assert a.dtype == b.dtype
    x, noise = jnp.array([0.3, -0.2, 1.5]), jnp.array([0.7])
    np.testing.assert_array_equal(trained.mean("ignored", x), POLICY.mean(PARAMS, x))
    for a, b in zip(trained.sample((), x, noise), POLICY.sample(PARAMS, x, noise), strict=True):
        np.testing.assert_array_equal(a, b)
    np.testing.assert_array_equal(trained.variance((), x), POLICY.variance(PARAMS, x))


def test_a_started_policy_begins_with_the_parameters_of_the_file_and_acts_by_its_own(file) -> None:
    """So it learns."""
    where = {"file": str(file), "task": "pendulum", "world": Pendulum()}
    started = StartedGaussian(POLICY.hidden, "sin", normalise=True, **where)
    got = jax.vmap(lambda key: started.init(key, Pendulum().spec))(jax.random.split(KEY, 2))
    for a, b in zip(jax.tree.leaves(got), jax.tree.leaves(PARAMS), strict=True):
        np.testing.assert_array_equal(a, jnp.stack((b, b)))
    other, x = POLICY.init(KEY, Pendulum().spec), jnp.array([0.3, -0.2, 1.5])
    np.testing.assert_array_equal(started.mean(other, x), POLICY.mean(other, x))
    with pytest.raises(ValueError, match="it must be"):
        StartedGaussian((4, 4), "sin", normalise=True, **where)


def test_the_policy_is_the_one_that_the_file_describes(file: Path) -> None:
    """Of any kind and size, unless another is given; a file without a description needs one."""
    policy = TanhGaussian((6, 5), "relu", "relu", normalise=True)  # two networks
    params = policy.init(KEY, Pendulum().spec)
    part = {"_target_": "hybrid_rl.policies.tanh_gaussian.TanhGaussian", "hidden": [6, 5]}
    part |= {"log_std_activation": "relu", "normalise": True}
    about = {"env": {}, "episode": {}, "policy": part, "seed": 0, "step": 1}
    save(file, "pendulum", Pendulum().spec, params, about)
    trained, x = opened(file, policy=None), jnp.array([0.3, -0.2, 1.5])
    assert trained.policy == policy
    np.testing.assert_array_equal(trained.mean((), x), policy.mean(params, x))
    save(file, "pendulum", Pendulum().spec, params, about | {"policy": {"_target_": "os.system"}})
    with pytest.raises(ValueError, match="is no part of"):
        opened(file, policy=None)
    save(file, "pendulum", Pendulum().spec, params)
    with pytest.raises(ValueError, match="does not describe its policy; `python"):
        opened(file, policy=None)


OTHERS = [
    ({"world": PointMass()}, "is of obs 3; this run has obs 4"),
    ({"policy": TanhGaussian((4, 4), "sin", normalise=True)}, r"bias is \(8,\); .* \(4,"),
    ({"policy": TanhGaussian((8, 4), "sin")}, r"policy/state.* is .*; it must be absent"),
    ({"policy": TanhGaussian((8, 4, 2), "sin", normalise=True)}, "params/.* is absent; it must"),
]


@pytest.mark.parametrize(("fields", "words"), OTHERS)
def test_a_file_for_another_use_is_refused(file: Path, fields: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        opened(file, **fields)


def test_the_policy_of_a_run_becomes_the_expert_of_its_task(tmp_path, monkeypatch) -> None:
    """The first seed's, whose actions are those of the run."""
    monkeypatch.chdir(tmp_path)
    run(tmp_path / "run", "algo=sac", "num_seeds=2")
    write = [f"run={tmp_path / 'run'}", "policy=policy.npz", "command=as above"]
    assert call_command(demonstrate.main, *write) == 0
    given = load(tmp_path / "run")
    line = ["task=pendulum", "algo=sac", "expert=trained"]
    expert = config.expert(config.load([*line, "expert.policy.file=policy.npz"]))
    assert isinstance(expert, PolicyController)
    x = jnp.array([1.0, 0.0, 0.4])
    got = expert.act(Params(), (), x, jax.random.key(0))[0]
    first = jax.tree.map(lambda leaf: leaf[0], given.params)
    want = given.controllers["policy"].act(first, (), x, jax.random.key(0))[0]
    np.testing.assert_array_equal(got, want)
    again = read("policy.npz")
    assert (again.task, again.seeds, again.step) == ("pendulum", (0,), given.step)
    assert again.notes == ("trained by: as above",)
    assert again.episode == given.episode
    np.testing.assert_allclose(again.policy()(x), want, atol=1e-6)
