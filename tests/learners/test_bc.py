"""Behaviour cloning recovers a known policy and does not depend on experience."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import Shown, begun, learned

from hybrid_rl.learners.bc import BehaviourCloning
from hybrid_rl.policies.deterministic import Deterministic
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.types import Batch, Params, Spec

SPEC = Spec(obs=3, act=2, dt=0.1)
GAIN = np.array([[0.5, -0.3, 0.2], [-0.4, 0.1, 0.6]])
STD = 0.2  # of the expert's noise before tanh
SMALL = TanhGaussian(hidden=(8,))
NORMALISED = TanhGaussian(hidden=(4,), normalise=True)


def shown(count: int = 100) -> Shown:
    """Decisions of an expert with u = tanh(GAIN x + noise)."""
    rng = np.random.default_rng(0)
    x = rng.normal(size=(count, 3)).astype(np.float32)
    return Shown(x, np.tanh(x @ GAIN.T + STD * rng.normal(size=(count, 2))))


def policies(learner: BehaviourCloning, steps: int) -> list:
    """The learned policy before the first update and after each."""
    state, update = begun(learner, SPEC), jax.jit(learner.update)
    found = [learner.params(state)["policy"]]
    for key in jax.random.split(jax.random.key(1), steps):
        state, _ = update(state, Params(), None, key)
        found.append(learner.params(state)["policy"])
    return found


def train(learner: BehaviourCloning, steps: int, fill: float = jnp.nan) -> Any:
    """The state after `steps` updates, with a batch of experience that is all `fill`."""
    shapes = {"obs": (3,), "next_obs": (3,), "action": (2,), "next_action": (2,)}
    batch = Batch(*(jnp.full((4, *shapes.get(name, ())), fill) for name in Batch._fields))
    return learned(learner, SPEC, lambda key: batch, steps)[0]


def test_a_linear_policy_is_recovered() -> None:
    """Its mean, and the standard deviation of its noise."""
    policy = TanhGaussian(hidden=(32,), log_std_activation="relu")
    known = train(BehaviourCloning(policy, shown(4000), learning_rate=3e-3), 3000).policy
    x = np.random.default_rng(1).normal(size=(500, 3)).astype(np.float32)
    mu, sigma = policy.gaussian(known, x)
    assert np.abs(np.asarray(mu) - x @ GAIN.T).mean() < 0.05
    assert float(sigma.mean()) == pytest.approx(STD, rel=0.1)


def test_a_linear_clone_is_least_squares() -> None:
    """A linear policy becomes the regression of NumPy."""
    x = np.random.default_rng(0).normal(size=(200, 3))
    u = np.clip(np.stack([x[:, 0] - x[:, 1] ** 2, np.sin(x[:, 2])], 1), -0.9, 0.9)
    policy = Deterministic(hidden=(), squash="clip")
    clone = BehaviourCloning(policy, Shown(x, u), learning_rate=3e-3, batch_size=200)
    got = train(clone, 3000).policy["weights"]["Dense_0"]
    wanted = np.linalg.lstsq(np.c_[x, np.ones(200)], u, rcond=None)[0]
    np.testing.assert_allclose([*got["kernel"], got["bias"]], wanted, atol=0.03)


def test_experience_does_not_change_the_policy() -> None:
    """The result is equal bit for bit for a batch of NaN and one of numbers."""
    learner = BehaviourCloning(SMALL, shown())
    one, other = train(learner, 20, jnp.nan), train(learner, 20, 7.0)
    jax.tree.map(np.testing.assert_array_equal, one, other)
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(one))


def test_actions_at_the_edge_are_bounded() -> None:
    """An action of exactly 1 has a finite likelihood."""
    x = shown(50).obs
    learner = BehaviourCloning(SMALL, Shown(x, np.ones((50, 2))), edge=0.9, learning_rate=0.01)
    mean = SMALL.mean(train(learner, 2000).policy, jnp.asarray(x))
    np.testing.assert_allclose(mean, 0.9, atol=0.05)


def test_matrices_decay_and_nothing_else() -> None:
    """After one step by rate x decay x first matrix; biases and statistics as without decay."""
    clone = partial(BehaviourCloning, NORMALISED, shown(), learning_rate=0.01)
    first, plain = policies(clone(), 1)
    decayed = policies(clone(weight_decay=0.5), 1)[1]
    trees = map(jax.tree.leaves_with_path, (first, plain, decayed))
    kinds = set()
    for (path, w0), (_, w), (_, w_decayed) in zip(*trees, strict=True):
        decay = 0.01 * 0.5 if getattr(path[-1], "key", None) == "kernel" else 0.0
        kinds.add(decay)
        np.testing.assert_allclose(w_decayed, w - decay * w0, rtol=1e-5, atol=1e-7)
    assert len(kinds) == 2


def test_the_mean_of_the_weights_acts() -> None:
    """It is the recursion in NumPy over the weights of a learner without it."""
    plain = policies(BehaviourCloning(NORMALISED, shown()), 3)
    got = policies(BehaviourCloning(NORMALISED, shown(), average=0.2), 3)[-1]
    paths = zip(*map(jax.tree.leaves, plain), strict=True)
    for leaf, path in zip(jax.tree.leaves(got), paths, strict=True):
        wanted = np.asarray(path[0], np.float64)
        for new in path[1:]:
            wanted = wanted + 0.2 * (np.asarray(new) - wanted)
        np.testing.assert_allclose(leaf, wanted, rtol=1e-4, atol=1e-6)
