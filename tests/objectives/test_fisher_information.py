"""Information about a Gaussian model: the objective, the data so far, and copies of the model."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import begun

from hybrid_rl.core import fisher
from hybrid_rl.learners.history import ModelHistory
from hybrid_rl.learners.information import InformationLearner, InformationState
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.objectives.fisher import FisherInformation
from hybrid_rl.types import Batch, Params, Path, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)
LINEAR, NETWORK = Gaussian(hidden=()), Gaussian(hidden=(6,), activation="sin")
RNG = np.random.default_rng(0)
X, U = RNG.normal(size=(9, 2)), RNG.uniform(-1, 1, (8, 1))
PATH = Path(jnp.asarray(X, jnp.float32), jnp.asarray(U, jnp.float32))
NO = jnp.zeros(8)
BATCH = Batch(PATH.x[:-1], PATH.u, NO, NO, NO, PATH.x[1:])
DECISIONS = jnp.asarray(200)


def observed(model: Gaussian) -> dict[str, Any]:
    """Parameters with statistics of the data."""
    return model.observe(begun(model, SPEC), BATCH.obs, BATCH.next_obs)


def value(objective: FisherInformation, params: Params, seed: int = 0) -> Array:
    """J [] of PATH."""
    held = objective.init(SPEC)
    key = jax.random.key(seed)
    return objective.prepare(params, held, PATH.x[0], PATH.u[0], key)[0](PATH)


def squares(params: dict[str, Any]) -> np.ndarray:
    """The diagonal [8] of Z'Z in each of two outputs: Z of normalised states and actions."""
    x = X[:-1]
    z = np.column_stack([np.ones(8), (x - x.mean(0)) / x.std(0), U])
    assert params["state"].mean == pytest.approx(x.mean(0), abs=1e-6)
    return np.repeat((z**2).sum(0), 2)


def test_units_of_the_change_cancel() -> None:
    """D of a linear model with sigma in deviations of the change, whatever these are."""
    params = observed(LINEAR)
    assert not np.allclose(params["change"].std, 1, atol=0.1)
    expected = np.log1p(squares(params) / 0.2**2 / 0.05).sum()
    objective = FisherInformation(LINEAR, sigma=0.2, floor=0.05, past=False)
    np.testing.assert_allclose(value(objective, Params(model=params)), expected, rtol=1e-5)


def test_the_data_so_far_are_the_prior() -> None:
    """D counts what the path adds to them; without sigma the model's own s is taken."""
    params = observed(LINEAR)
    past = RNG.uniform(0, 9, 8)
    known = InformationState(jnp.asarray(past / 3, jnp.float32), jnp.asarray(3.0), jnp.zeros(()))
    for sigma, s in ((0.2, 0.2), (None, 1.0)):
        expected = np.log1p(squares(params) / s**2 / (past + 0.05)).sum()
        objective = FisherInformation(LINEAR, sigma=sigma, floor=0.05)
        result = value(objective, Params(model=params, information=known))
        np.testing.assert_allclose(result, expected, rtol=1e-5)
    alone = FisherInformation(LINEAR, sigma=None, floor=0.05, past=False)
    assert value(objective, Params(model=params)) == value(alone, Params(model=params))


def test_the_learner_has_the_information_of_all_decisions() -> None:
    """200 decisions like those of a batch, under the same model."""
    params = observed(LINEAR)
    learner = InformationLearner(LINEAR, sigma=0.2, floor=1e9)
    state = begun(learner, SPEC)
    for _ in range(3):
        known = Params(model=params, decisions=DECISIONS)
        state, metrics = learner.update(state, known, BATCH, jax.random.key(0))
    expected = 200 * squares(params) / 8 / 0.2**2
    np.testing.assert_allclose(learner.params(state)["information"].total, expected, rtol=1e-5)
    np.testing.assert_allclose(metrics["information/trace"], expected.sum(), rtol=1e-5)
    assert metrics["information/floored"] == 8


def test_a_singular_information_is_counted_and_stays_finite() -> None:
    """An action that is always zero leaves its two weights without information."""
    params = observed(LINEAR)
    batch = BATCH._replace(action=jnp.zeros((8, 1)))
    learner = InformationLearner(LINEAR)
    known, key = Params(model=params, decisions=DECISIONS), jax.random.key(0)
    state, metrics = learner.update(learner.init(key, SPEC), known, batch, key)
    assert metrics["information/floored"] == 2
    for name in fisher.CRITERIA:
        objective = FisherInformation(LINEAR, criterion=name)
        assert np.isfinite(value(objective, Params(model=params, information=state))), name


@pytest.mark.parametrize("kind", fisher.KINDS)
def test_probes_estimate_the_trace(kind) -> None:
    """4,000 directions: the deviation of the mean of the chi-squared products is below 3%."""
    params = Params(model=observed(NETWORK))
    exact = FisherInformation(NETWORK, "T", kind, past=False)
    probed = FisherInformation(NETWORK, "T", kind, past=False, probes=4000)
    assert abs(value(exact, params) - value(probed, params)) < 0.12
    assert value(probed, params) != value(probed, params, seed=1)


def test_copies_are_those_of_their_decisions() -> None:
    """Three copies of models 0 to 3; the ring has dropped the first one."""
    learner = ModelHistory(LINEAR, every=10, copies=3)
    first = observed(LINEAR)
    state = begun(learner, SPEC)
    assert learner.params(state) == {}
    for i in range(4):
        model = jax.tree.map(lambda x, i=i: 0 * x + i, first)
        state, metrics = learner.update(state, Params(model=model), BATCH, jax.random.key(0))
        assert metrics == {}
    for copies in jax.tree.leaves(state.models):
        np.testing.assert_array_equal(copies.reshape(3, -1)[:, 0], [3, 1, 2])
