"""The sampling controller with known candidates."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import SPEC, Acting, Cart, Fast, Grid, begun, speed

from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.core import sampling
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.proposals.noise import NoiseProposal
from hybrid_rl.rewards.network import RewardNetwork
from hybrid_rl.types import Params, Path

X = jnp.array([0.3, -0.4])
T, K = 3, 4


@pytest.mark.parametrize(
    ("staged", "execute"), [(False, "mean"), (True, "mean"), (True, "sample"), (True, "best")]
)
def test_a_decision_is_that_of_numpy(staged: bool, execute: str) -> None:
    """A sum over time weighs each decision by what follows it, another objective all by J."""
    objective = PredictedReturn(Fast()) if staged else speed(0.1)
    given: dict[str, Any] = {"log_density": staged, "normalise": not staged, "execute": execute}
    parts = Cart(), objective, NoiseProposal(std=0.5)
    controller = SamplingController(*parts, None, T, K, temperature=0.08, rest=0.7, **given)
    plan = np.array([[0.2], [-0.3], [0.4]])
    key = jax.random.key(486)  # later returns, or wrong odds, would choose another candidate
    state = controller.init(SPEC)._replace(plan=jnp.asarray(plan, jnp.float32))
    u, state, metrics = jax.jit(controller.act)(Params(), state, X, key)
    rolling, choosing = jax.random.split(key)
    drawing = rolling if staged else jax.random.split(rolling)[0]
    noise = np.asarray(jax.random.normal(drawing, (K, T, 1)))
    v = np.clip(plan + 0.5 * noise, -1, 1)
    rewards = (float(X[1]) + 0.1 * np.cumsum(v, 1) - 0.1 * v**2)[:, :, 0]
    S = np.cumsum(rewards[:, ::-1], 1)[:, ::-1]
    if staged:
        w = np.exp(S / 0.08 - 0.5 * noise[:, :, 0] ** 2)
    else:
        S = np.repeat(S[:, :1], T, 1)
        w = np.exp(S / S.std(0) / 0.08)
    w = w / w.sum(0)
    chosen = int(jax.random.categorical(choosing, jnp.log(w[:, 0])))
    mean, best = np.einsum("kt,ktm->tm", w, v), v[S[:, 0].argmax()]
    wanted = {"mean": mean[0], "sample": v[chosen, 0], "best": best[0]}[execute]
    np.testing.assert_allclose(u, wanted, rtol=1e-4)
    np.testing.assert_array_equal(state.u, u)
    after = best if execute == "best" else mean
    np.testing.assert_allclose(state.plan, [*after[1:], [0.7]], rtol=1e-4)
    found = [float(metrics[f"planner/{name}"]) for name in ("effective_samples", "planned_return")]
    np.testing.assert_allclose(found, [1 / (w[:, 0] ** 2).sum(), w[:, 0] @ S[:, 0]], rtol=1e-4)


@pytest.mark.parametrize("ends", [False, True])
def test_the_candidate_that_weighs_most_is_chosen(ends: bool) -> None:
    """By the returns of a reward network, whether or not episodes end."""
    reward = RewardNetwork(hidden=(8,), ends=ends)
    objective = PredictedReturn(reward, discount=0.9, critic=Acting(), policy=Acting())
    params = Params(reward=begun(reward, SPEC))
    paths = Path(np.zeros((K, T + 1, 2), np.float32), np.zeros((K, T, 1), np.float32))
    for k in range(K):
        paths.x[k, 0], paths.u[k] = X, k / K
        for t in range(T):
            paths.x[k, t + 1] = Cart().step((), paths.x[k, t], paths.u[k, t])
    to_go = jax.jit(jax.vmap(lambda path: objective.reward_to_go(params, path)))(paths)
    w = np.asarray(sampling.weights(to_go[:, :-1], 0.1))[:, 0]
    controller = SamplingController(Cart(), objective, Grid(), horizon=T, samples=K)
    given = params, controller.init(SPEC), X, jax.random.key(1)
    found = jax.jit(controller.considered)(*given)[3]
    np.testing.assert_allclose(found.paths.x, paths.x, atol=1e-5)
    assert int(found.chosen) == np.argmax(w)


def test_agreement_is_measured_now_and_then() -> None:
    """At multiples of `agreement_every` decisions, and in evaluations; the plan is the same."""
    reward = RewardNetwork(hidden=(8,))
    params = Params(reward=begun(reward, SPEC))

    @partial(jax.jit, static_argnums=0)
    def decided(every: int, decisions: int | None) -> tuple[Array, Array]:
        parts = Cart(), PredictedReturn(reward), Grid(), Acting()
        controller = SamplingController(*parts, horizon=T, samples=K, agreement_every=every)
        known = params._replace(decisions=decisions)
        u, _, metrics = controller.act(known, controller.init(SPEC), X, jax.random.key(1))
        return u[0], metrics["planner/insertion_per_variance"]

    def act(every: int, decisions: int | None) -> tuple[float, ...]:
        return tuple(map(float, decided(every, decisions)))

    always = act(1, 20)
    assert abs(always[1]) > 1e-4
    assert act(10, 20) == pytest.approx(always, rel=1e-5)
    assert act(10, None) == pytest.approx(always, rel=1e-5)
    assert act(10, 21) == pytest.approx((always[0], np.nan), rel=1e-5, nan_ok=True)


@pytest.mark.parametrize(("execute", "then"), [("mean", "mean"), ("sample", "mean"), ("best",) * 2])
def test_in_evaluations_no_candidate_is_drawn(execute: Any, then: str) -> None:
    """The mean acts, or the best candidate where it acts in training."""
    parts = Cart(), PredictedReturn(Fast()), Grid()
    assert SamplingController(*parts, execute=execute).greedy().execute == then
