"""Learned features: a linear world, the trivial solution, gradients, the regression, windows."""

from typing import Any

import jax
import jax.flatten_util
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.envs.analytic.cart_pendulum import CartPendulum
from hybrid_rl.features.monomials import Monomials
from hybrid_rl.features.network import Network
from hybrid_rl.learners.embedding import Decisions, EmbeddingLearner
from hybrid_rl.learners.regulator import RegulatorLearner
from hybrid_rl.models.koopman import Koopman
from hybrid_rl.policies.linear import Linear
from hybrid_rl.types import Batch, Params, Spec

A = np.array([[0.9, 0.3], [-0.2, 0.8]])  # eigenvalues 0.85 +- 0.24i
B = np.array([[0.1], [0.3]])
SPEC = Spec(obs=2, act=1, dt=0.1)


def linear_world(rounds: int, worlds: int = 1, length: int = 25) -> Decisions:
    """Decisions [rounds, worlds, ...] of x' = A x + B u, in episodes with random starts."""
    rng = np.random.default_rng(0)
    x, rows = rng.uniform(-0.3, 0.3, (worlds, 2)), []
    for t in range(rounds):
        u = rng.uniform(-0.5, 0.5, (worlds, 1))
        after = x @ A.T + u @ B.T
        ends = (t + 1) % length == 0
        rows.append((x, u, np.full(worlds, float(ends)), after))
        x = rng.uniform(-0.3, 0.3, (worlds, 2)) if ends else after
    columns = (jnp.asarray(np.stack(column), jnp.float32) for column in zip(*rows, strict=True))
    return Decisions(*columns)


def learn(learner: Any, decisions: Decisions, spec: Spec = SPEC, every: bool = False) -> Any:
    """The learner's state after the decisions [rounds, worlds, ...], and metrics [rounds].

    every: the states after each decision instead of the metrics.
    """
    rounds, worlds = decisions.ended.shape

    def one(state: Any, each: Any) -> Any:
        new, t, key = each
        nothing = jnp.zeros(worlds)
        batch = Batch(new.obs, new.action, nothing, nothing, new.ended, new.next_obs)
        state, metrics = learner.update(state, Params(decisions=t * worlds), batch, key)
        return state, state if every else metrics

    @jax.jit
    def run() -> Any:
        keys = jax.random.split(jax.random.key(1), rounds)
        first = learner.init(jax.random.key(0), spec)
        return jax.lax.scan(one, first, (decisions, jnp.arange(rounds), keys))

    return run()


def windows(decisions: Decisions, size: int) -> Decisions:
    """All windows [B, size, ...] of the first world."""
    starts = np.arange(len(decisions.ended) - size + 1)
    return jax.tree.map(lambda x: x[starts[:, None] + np.arange(size), 0], decisions)


def test_a_linear_world_is_embedded():
    koopman = Koopman(Network(size=4, hidden=(8,)))
    learner = EmbeddingLearner(koopman, steps=1000, learning_rate=1e-2, prior=1e-6)
    decisions = linear_world(400)
    model = learn(learner, decisions)[0].model
    assert learner.loss(model, windows(decisions, 5)) < 1e-8
    found = np.linalg.eigvals(np.asarray(model["K"][:, :6], np.float64))
    for true in np.linalg.eigvals(A):
        assert np.abs(found - true).min() < 1e-3


@pytest.mark.parametrize("capacity", [1000, 300])
def test_the_operator_is_the_ridge_regression_of_the_decisions_in_the_memory(capacity):
    decisions = linear_world(200, worlds=2)
    features = Monomials(terms=((0, 1), (0, 0)), constant=True)
    learner = EmbeddingLearner(Koopman(features), interval=100, capacity=capacity, prior=0.1)
    model = learn(learner, decisions)[0].model
    kept = [np.asarray(x, np.float64)[-capacity // 2 :].reshape(-1, x.shape[-1]) for x in
            (decisions.obs, decisions.action, decisions.next_obs)]  # fmt: skip

    def z(x: np.ndarray) -> np.ndarray:
        return np.stack([x[:, 0], x[:, 1], np.ones(len(x)), x[:, 0] * x[:, 1], x[:, 0] ** 2], 1)

    s, mean = np.concatenate([z(kept[0]), kept[1]], 1), np.eye(5, 6)
    information = s.T @ s + 0.1 * np.eye(6)
    K = np.linalg.solve(information, s.T @ z(kept[2]) + 0.1 * mean.T).T
    np.testing.assert_allclose(model["K"], K, atol=2e-5)
    covered = model["spread"] @ model["spread"].T @ information
    np.testing.assert_allclose(covered, np.eye(6), atol=1e-3)


def test_windows_hold_successive_decisions_of_one_world_also_in_a_full_ring():
    worlds, rounds, capacity = 3, 50, 60
    time, world = np.meshgrid(np.arange(rounds), np.arange(worlds), indexing="ij")
    obs = jnp.asarray(np.stack([time, world], -1), jnp.float32)
    flags = jnp.zeros((rounds, worlds))
    decisions = Decisions(obs, flags[..., None], flags, obs)
    learner = EmbeddingLearner(Koopman(Monomials()), interval=60, capacity=capacity, batch_size=500)
    memory = learn(learner, decisions)[0].memory
    drawn = learner._windows(memory, jnp.int32(rounds * worlds), worlds)(jax.random.key(0)).obs
    assert np.all(np.diff(drawn[..., 0], axis=1) == 1)
    assert np.all(np.diff(drawn[..., 1], axis=1) == 0)
    kept = capacity // worlds
    starts = {(t, w) for t in range(rounds - kept, rounds - 4) for w in range(worlds)}
    assert {(int(t), int(w)) for t, w in drawn[:, 0]} == starts


def test_the_loss_ends_with_the_episode():
    """Windows that run into the next episode, whose start no model predicts."""
    decisions = linear_world(100, length=7)
    koopman = Koopman(Monomials())
    model = {**koopman.init(jax.random.key(0), SPEC), "K": jnp.asarray(np.hstack([A, B]), float)}
    part = windows(decisions, 5)
    assert EmbeddingLearner(koopman).loss(model, part) < 1e-12
    assert EmbeddingLearner(koopman).loss(model, part._replace(ended=0 * part.ended)) > 1e-3


def test_features_operator_and_gain_change_together_at_the_end_of_an_iteration():
    world: Any = CartPendulum()
    koopman = Koopman(Network(size=3, hidden=(4,)))
    regulator: Any = RegulatorLearner(koopman, Linear(), world, horizon=8)
    learner = EmbeddingLearner(koopman, regulator, interval=10, steps=3)
    assert learner.owns == ("model", "policy")
    rng = np.random.default_rng(4)
    obs = jnp.asarray(rng.uniform(-0.1, 0.1, (21, 1, 4)), jnp.float32)
    action = jnp.asarray(rng.uniform(-1, 1, (20, 1, 1)), jnp.float32)
    decisions = Decisions(obs[:-1], action, jnp.zeros((20, 1)), obs[1:])
    each = []
    states, solve = learn(learner, decisions, world.spec, every=True)[1], jax.jit(regulator.solve)
    for count in (9, 10, 19, 20):
        params = learner.params(jax.tree.map(lambda x, n=count: x[n - 1], states))
        solved = solve(params["model"], params["policy"])
        each.append((params["model"]["features"]["weights"], params["policy"]["gain"]))
        if count > 9:
            np.testing.assert_allclose(params["policy"]["gain"], solved["gain"], rtol=1e-4)
    before, first, same, second = ([np.asarray(x) for x in jax.tree.leaves(e)] for e in each)
    assert all(np.array_equal(a, b) for a, b in zip(first, same, strict=True))
    assert not any(np.array_equal(a, b) for a, b in zip(before, first, strict=True))
    assert not any(np.array_equal(a, b) for a, b in zip(same, second, strict=True))
