"""The belief of a support vector machine against its formulas in NumPy."""

import json
from dataclasses import replace
from pathlib import Path

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
    at = jnp.asarray(s)
    assert float(jax.jit(BELIEF.gain)(state, at)) == pytest.approx(entropy, rel=1e-4)
    way = np.array([[0.5, 0.2], [0.4, 0.3], [0.1, 0.6]], np.float32)
    each = [1 / (1 + np.exp(-2 * f(one))) for one in way]
    both = -sum(p * np.log(p) + (1 - p) * np.log(1 - p) for p in each)
    got = jax.jit(BELIEF.gain_along)(state, jnp.asarray(way))
    assert float(got) == pytest.approx(both, rel=1e-4)
    slope = [(f(s + d) - f(s - d)) / 2e-3 for d in np.eye(2) * 1e-3]
    assert float(jax.jit(BELIEF.information)(state, at)) == pytest.approx(p * (1 - p), rel=1e-4)
    fisher = replace(BELIEF, measure="fisher")
    want = p * (1 - p) * 4 * np.dot(slope, slope)
    assert float(jax.jit(fisher.information)(state, at)) == pytest.approx(want, rel=1e-2)


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


LENGTH = 0.08
FILE = Path(__file__).with_name("svc.json")
CASES = {  # name -> number of points, share of flipped labels, C
    "clean, C 1": (200, 0.0, 1.0),
    "clean, C 10": (200, 0.0, 10.0),
    "flipped, C 1": (200, 0.05, 1.0),
    "flipped, C 10": (200, 0.05, 10.0),
}


def labelled(count: int, flipped: float) -> tuple[np.ndarray, np.ndarray]:
    """Points [N, 2] in the unit square; labels [N] are 1 inside a disc and a box."""
    rng = np.random.default_rng(0)
    s = rng.uniform(0, 1, (count, 2)).astype(np.float32)
    disc = np.hypot(s[:, 0] - 0.3, s[:, 1] - 0.6) < 0.18
    box = (np.abs(s[:, 0] - 0.7) < 0.15) & (np.abs(s[:, 1] - 0.3) < 0.1)
    return s, np.where((disc | box) ^ (rng.random(count) < flipped), 1.0, -1.0)


def queries() -> np.ndarray:
    """Points [100, 2] at which f is compared."""
    return np.random.default_rng(1).uniform(0, 1, (100, 2)).astype(np.float32)


def machine_of(cost, capacity=256) -> SupportVectors:
    """A machine that keeps every point, however close."""
    return SupportVectors(capacity=capacity, length=LENGTH, cost=cost, apart=0.0)


def learn(svm, s, label):
    """The machine after all points, each followed by its iterations."""

    def one(state, point):
        return svm.optimised(svm.joined(state, *point)), None

    points = jnp.asarray(s), jnp.asarray(label, jnp.float32)
    return jax.jit(lambda points: jax.lax.scan(one, begun(svm, SPEC), points)[0])(points)


def decisions(svm, state):
    """f [100] at the queries."""
    return jax.vmap(lambda s: svm.decision(state, s))(jnp.asarray(queries()))


@pytest.mark.parametrize("name", CASES)
def test_f_is_that_of_libsvm(name) -> None:
    count, flipped, cost = CASES[name]
    svm = machine_of(cost)
    state = learn(svm, *labelled(count, flipped))
    want = np.array(json.loads(FILE.read_text())[name])
    np.testing.assert_allclose(decisions(svm, state), want, atol=2e-3)
    assert want.max() > 0.5
    assert want.min() < -0.5
    assert float(svm.report(state)["belief/gap"]) < 1e-2


def test_constraints_hold_and_the_order_of_the_points_does_not_matter() -> None:
    s, label = labelled(150, 0.05)
    svm = machine_of(10.0)
    state, other = learn(svm, s, label), learn(svm, s[::-1], label[::-1])
    assert float(state.dual.sum()) == pytest.approx(0, abs=1e-3)
    signed = np.asarray(state.dual * state.label)
    assert signed.min() >= 0
    assert signed.max() <= 10
    np.testing.assert_allclose(decisions(svm, state), decisions(svm, other), atol=1e-2)


def test_a_full_machine_adds_weight_to_the_nearest_point_of_the_same_label() -> None:
    s = jnp.array([[0.1, 0.1], [0.9, 0.9], [0.2, 0.1], [0.8, 0.8]])
    svm = machine_of(1.0, capacity=2)
    state = svm.joined(learn(svm, s[:2], np.array([1.0, -1.0])), s[2], jnp.float32(-1))
    np.testing.assert_array_equal(state.weight, [1, 2])
    state = svm.joined(state, s[3], jnp.float32(1))
    np.testing.assert_array_equal(state.weight, [2, 2])
    assert int(state.count) == 2
    svm = machine_of(1.0, capacity=1)
    single = learn(svm, s[:1], np.array([-1.0]))
    dropped = svm.joined(single, s[1], jnp.float32(1))
    jax.tree.map(np.testing.assert_array_equal, dropped, single)


def write() -> None:
    """Write svc.json; scikit-learn must be installed."""
    from sklearn.svm import SVC

    values = {}
    for name, (count, flipped, cost) in CASES.items():
        s, label = labelled(count, flipped)
        machine = SVC(C=cost, gamma=0.5 / LENGTH**2, tol=1e-7).fit(s, label)
        values[name] = np.round(machine.decision_function(queries()), 5).tolist()
    FILE.write_text(json.dumps(values) + "\n")


if __name__ == "__main__":
    write()
