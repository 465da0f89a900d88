"""The belief of a support vector machine against its formulas in NumPy."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import begun

from hybrid_rl.beliefs.support_vectors import SupportVectors
from hybrid_rl.types import Spec

SPEC = Spec(obs=4, act=2, dt=0.1)
BELIEF = SupportVectors(capacity=64, length=0.3, cost=5.0, slope=2.0)
decision, predict, add = (jax.jit(f) for f in (BELIEF.decision, BELIEF.predict, BELIEF.add))


@pytest.fixture(scope="module")
def measured():
    """A belief after 40 measurements: 1 inside a disc."""
    rng = np.random.default_rng(0)
    s = rng.uniform(-1, 1, (40, 2)).astype(np.float32)
    y = (np.hypot(*s.T) < 0.6).astype(np.float32)

    def one(state, point):
        return BELIEF.add(state, *point, None), BELIEF.loss(state, *point)

    first = begun(BELIEF, SPEC)
    return jax.jit(lambda: jax.lax.scan(one, first, (jnp.asarray(s), jnp.asarray(y))))()


def test_predictions_follow_the_decision_function(measured) -> None:
    """High inside, low outside; information and entropy as printed."""
    state, _ = measured
    inside, outside = jnp.zeros(2), jnp.array([0.9, 0.9])
    assert float(predict(state, inside)[0]) > 0.85 > 0.15 > float(predict(state, outside)[0])
    s = np.array([0.5, 0.2], np.float32)

    def f(s):
        k = np.exp(-((np.asarray(state.s) - s) ** 2).sum(1) / (2 * 0.09))
        return float(k @ np.asarray(state.dual)) + bias

    bias = float(decision(state, outside)) - (
        np.exp(-((np.asarray(state.s) - np.asarray(outside)) ** 2).sum(1) / 0.18)
        @ np.asarray(state.dual)
    )
    p = 1 / (1 + np.exp(-2 * f(s)))
    got, std = predict(state, jnp.asarray(s))
    np.testing.assert_allclose([got, std], [p, np.sqrt(p * (1 - p))], rtol=1e-4)
    entropy = -p * np.log(p) - (1 - p) * np.log(1 - p)
    assert float(jax.jit(BELIEF.gain)(state, jnp.asarray(s))) == pytest.approx(entropy, rel=1e-4)
    way = np.array([[0.5, 0.2], [0.4, 0.3], [0.1, 0.6]], np.float32)
    each = [1 / (1 + np.exp(-2 * f(one))) for one in way]
    both = -sum(p * np.log(p) + (1 - p) * np.log(1 - p) for p in each)
    assert float(jax.jit(BELIEF.gain_along)(state, jnp.asarray(way))) == pytest.approx(
        both, rel=1e-4
    )
    slope = [(f(s + d) - f(s - d)) / 2e-3 for d in np.eye(2) * 1e-3]
    assert float(jax.jit(BELIEF.information)(state, jnp.asarray(s))) == pytest.approx(
        p * (1 - p), rel=1e-4
    )
    fisher = replace(BELIEF, measure="fisher")
    want = p * (1 - p) * 4 * np.dot(slope, slope)
    assert float(jax.jit(fisher.information)(state, jnp.asarray(s))) == pytest.approx(
        want, rel=1e-2
    )


def test_losses_are_those_before_the_measurement_and_fall(measured) -> None:
    """The first is -log p(0) or -log p(1) for f = -1."""
    losses = np.asarray(measured[1])
    assert losses[0] in np.float32(np.log1p(np.exp([-2.0, 2.0])))
    assert losses[20:].mean() < losses[:20].mean()


def test_a_belief_without_contact_is_uniform() -> None:
    """f = -1 before any measurement and after zeros alone."""
    state = begun(BELIEF, SPEC)
    for _ in range(2):
        points = jax.random.uniform(jax.random.key(1), (10, 2))
        np.testing.assert_array_equal(jax.vmap(decision, (None, 0))(state, points), -1)
        state = add(state, jnp.array([0.3, 0.1]), jnp.float32(0), None)


def test_a_full_memory_is_reported() -> None:
    """It keeps adding weight."""
    belief = SupportVectors(capacity=3)
    state = begun(belief, SPEC)
    more = jax.jit(belief.add)
    for i in range(5):
        state = more(state, jnp.array([0.1 * i, 0.0]), jnp.float32(0), None)
    report = belief.report(state)
    assert (float(report["belief/full"]), float(report["belief/points"])) == (1, 3)
    assert float(state.weight.sum()) == 5
