"""The soft return over several decisions, against a loop in NumPy."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import begun, learned

from hybrid_rl.core import returns
from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.learners.model_based import ModelBased, ModelBasedState
from hybrid_rl.learners.sac import SAC
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.types import Batch, Imagined, Params, Spec

A = np.array([[0.9, 0.2], [-0.1, 0.8]], np.float32)
B = np.array([[0.1], [0.7]], np.float32)
DISCOUNT, ALPHA = 0.9, 0.2


@dataclass(frozen=True)
class Line:
    """Linear dynamics and policy, quadratic reward and critic."""

    def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
        return x @ A.T + u @ B.T + 0.1 * noise

    def outcome(self, params: Any, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """Reward, and a chance to end that grows with x[0]."""
        return -(x @ x) - 0.1 * u @ u, x[0] - 2

    def sample(self, params: Any, x: Array, noise: Array) -> tuple[Array, Array]:
        return x @ params.T + 0.3 * noise, -0.5 * jnp.sum(noise**2, -1) + x[..., 0]

    def value(self, params: Any, x: Array, u: Array) -> Array:
        return -2 * jnp.sum(x**2, -1) - 0.5 * jnp.sum(u**2, -1)


PART: Any = Line()
GAIN = jnp.array([[-0.3, -0.4]])
PARAMS = Params(model=None, reward=None, critic=None, policy=GAIN)
X = jax.random.normal(jax.random.key(0), (4, 2))
KEY = jax.random.key(1)
START = Batch(X, jnp.zeros((4, 1)), *(jnp.zeros(4) for _ in range(3)), X)


def looped(gain: np.ndarray, steps: int) -> np.ndarray:
    """R [4] by a loop in float64."""
    acting, moving, _ = jax.random.split(KEY, 3)
    for_policy = np.asarray(jax.random.normal(acting, (steps + 1, 4, 1)), np.float64)
    for_model = np.asarray(jax.random.normal(moving, (steps, 4, 2)), np.float64)
    x, weight, total = np.asarray(X, np.float64), np.ones(4), np.zeros(4)
    for t in range(steps + 1):
        u = x @ gain.T + 0.3 * for_policy[t]
        log_prob = -0.5 * (for_policy[t] ** 2).sum(-1) + x[:, 0]
        if t == steps:
            last = -2 * (x**2).sum(-1) - 0.5 * (u**2).sum(-1)
            return total + weight * (last - ALPHA * log_prob)
        total = total + weight * (-(x**2).sum(-1) - 0.1 * (u**2).sum(-1) - ALPHA * log_prob)
        weight = weight * DISCOUNT / (1 + np.exp(x[:, 0] - 2))
        x = x @ A.T + u @ B.T + 0.1 * for_model[t]
    raise AssertionError


@partial(jax.jit, static_argnums=1)
def returned(gain: Array, steps: int) -> Array:
    """R [4] of the part."""
    ahead = ModelBased(PART, PART, PART, PART, steps=steps)
    paths = ahead.imagine(PARAMS._replace(policy=gain), X, 1, KEY)
    last = PART.value(None, paths.x[-1], paths.u[-1])
    return returns.soft(paths, jnp.float32(ALPHA), DISCOUNT, last)[0]


@pytest.mark.parametrize("steps", [0, 1, 3])
def test_the_return_and_its_slope_are_those_of_a_loop(steps: int) -> None:
    """R, and its gradient by central differences."""
    gain = np.asarray(GAIN, np.float64)
    np.testing.assert_allclose(returned(GAIN, steps), looped(gain, steps), rtol=1e-5)
    slope = jax.jit(jax.grad(lambda k: returned(k, steps).sum()))(GAIN)
    for i in range(2):
        h = np.eye(1, 2, i) * 1e-6
        difference = looped(gain + h, steps).sum() - looped(gain - h, steps).sum()
        assert float(slope[0, i]) == pytest.approx(difference / 2e-6, rel=1e-4)


def test_how_likely_a_decision_is_reached() -> None:
    """The product of the chances to continue before it."""
    continues = jnp.array([[0.5, 1.0], [0.2, 0.0], [1.0, 0.3]])
    x = jnp.zeros((4, 2, 1))
    paths = Imagined(x, x, x[..., 0], continues, continues)
    np.testing.assert_allclose(returns.reached(paths), [[1, 1], [0.5, 1], [0.1, 0]], atol=1e-6)


def test_the_critic_s_error_counts_where_it_is_reached_and_its_goal_is_the_target_s() -> None:
    """0.5 sum_i mean w (Q_i - y)^2 at two of three decisions, by loops; and the policy's loss."""
    policy, critic, spec = TanhGaussian((8,)), EnsembleQ((8,)), Spec(obs=2, act=1, dt=1.0)
    given = {"steps": 3, "value_steps": 2, "discount": DISCOUNT, "alpha": ALPHA}
    learner = ModelBased(policy, critic, PART, PART, branch_steps=0, **given)
    first = begun(learner, spec, 3).learner
    first = first.replace(target=begun(critic, spec, 4))

    @jax.jit
    def made(state: Any) -> tuple:
        params = PARAMS._replace(policy=state.policy)
        paths = learner.imagine(params, X, 1, jax.random.split(KEY)[1])
        found = learner.update(
            ModelBasedState(state, None, jnp.inf, jnp.full(2, jnp.inf)), params, START, KEY
        )[1]
        last = [critic.value(q, paths.x[-1], paths.u[-1]) for q in (state.target, state.critic)]
        return paths, found, last, jax.vmap(critic.all, (None, 0, 0))(state.critic, *paths[:2])

    paths, found, last, q = jax.tree.map(np.asarray, made(first))

    def goals(last: np.ndarray) -> dict[int, np.ndarray]:
        value, y = last - ALPHA * paths.log_prob[3], {}
        for t in (2, 1, 0):
            y[t] = paths.reward[t] + DISCOUNT * paths.continues[t] * value
            value = y[t] - ALPHA * paths.log_prob[t]
        return y

    y = goals(last[0])
    errors = [(q[0] - y[0]) ** 2, paths.continues[0] * (q[1] - y[1]) ** 2]
    assert paths.continues[0].min() < 0.95
    wanted = {
        "critic_loss": 0.5 * np.mean(errors, (0, 2)).sum(),
        "q": q[:2].mean(),
        "policy_loss": -(goals(last[1])[0] - ALPHA * paths.log_prob[0]).mean(),
        "entropy": -paths.log_prob[0].mean(),
        "alpha": ALPHA,
    }
    for name, value in wanted.items():
        assert float(found[f"sac/{name}"]) == pytest.approx(value, rel=1e-4), name


def test_without_imagined_decisions_it_is_soft_actor_critic() -> None:
    """From real states, with a policy that takes no notice of random numbers."""

    class Quiet(TanhGaussian):
        def sample(self, params: Any, x: Array, noise: Array) -> tuple[Array, Array]:
            return super().sample(params, x, jnp.full(noise.shape, 0.4))

    parts, spec = (Quiet((8,)), EnsembleQ((8,))), Spec(obs=2, act=1, dt=1.0)
    given: dict[str, Any] = {"max_grad_norm": 0.1, "discount": 0.9, "alpha": 0.3}
    ours = ModelBased(*parts, PART, PART, steps=0, branch_steps=0, **given)
    sac, batch = SAC(*parts, **given), START._replace(action=X[:, :1], reward=X[:, 0])

    @jax.jit
    def updated() -> tuple:
        first = begun(sac, spec)
        by_sac = sac.update(first, Params(), batch, KEY)
        by_ours = ours.update(ModelBasedState(first, None, jnp.inf, jnp.inf), Params(), batch, KEY)
        return (by_ours[0].learner, by_ours[1]), by_sac

    for mine, its in zip(*map(jax.tree.leaves, updated()), strict=True):
        np.testing.assert_allclose(mine, its, rtol=1e-5, atol=1e-7)


@dataclass(frozen=True)
class Staying:
    """One state, in which each decision pays 1 and the episode continues with a chance."""

    chance: float

    def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
        return x

    def outcome(self, params: Any, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """1, and the logit of the end."""
        return jnp.ones(()), jnp.log((1 - self.chance) / self.chance)


def branching(world: Any, policy: Any, critic: Any, **given: Any) -> ModelBased:
    """A learner in a known world, whose policy and entropy hardly matter."""
    rates = {"critic_learning_rate": 3e-3, "alpha_learning_rate": 1e-9, "alpha": 1e-6}
    given = {"steps": 3, "discount": 0.5, "tau": 0.05, "batch_size": 64, **rates, **given}
    return ModelBased(policy, critic, world, world, **given)


@pytest.mark.parametrize(
    ("value_steps", "chance", "wanted"),
    [(None, 1.0, 2.0), *((each, 0.5, 4 / 3) for each in (None, 1, 0))],
)
def test_the_critic_learns_the_imagined_returns(value_steps, chance, wanted) -> None:
    """Q = 1 / (1 - c / 2), at three states, at the first, or by one decision, as in SAC.

    The rewards of the batch, which are larger, do not matter.
    """
    critic, given = EnsembleQ(hidden=(32, 32)), {"branch_steps": 2, "branch_memory": 128}
    parts = Staying(chance), TanhGaussian(hidden=(32,)), critic
    learner = branching(*parts, value_steps=value_steps, **given)
    zero = jnp.zeros(64)
    seen = Batch(zero[:, None], zero[:, None], zero - 7, zero, zero, zero[:, None])
    state, _ = learned(learner, Spec(obs=1, act=1, dt=1.0), lambda key: seen, 1000)
    q = critic.value(state.learner.critic, jnp.zeros(1), jnp.zeros(1))
    assert float(q) == pytest.approx(wanted, abs=0.05)
    assert int(state.branches.count) == 1000


class Leaving(Staying):
    """A model that doubles the state, which is paid."""

    def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
        return 2 * x

    def outcome(self, params: Any, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """The state, without an end."""
        return x[0], jnp.float32(-20)


@pytest.mark.parametrize("value_steps", [None, 0])
def test_the_critic_stays_within_what_decisions_earned(value_steps: int | None) -> None:
    """3 in each of 1 / (1 - 0.5) decisions, though 2^9 are imagined; states change that much."""
    critic = EnsembleQ((32, 32), normalise=True, scale=True)
    parts, given = (Leaving(1.0), TanhGaussian((32,)), critic), {"branch_memory": 576}
    learner = branching(*parts, value_steps=value_steps, branch_steps=9, **given)
    zero, one = jnp.zeros(64), jnp.ones((64, 1))
    seen = Batch(one, one, zero - 3, zero, zero, 1000 * one)
    state, _ = learned(learner, Spec(obs=1, act=1, dt=1.0), lambda key: seen, 1000)
    q = jax.vmap(critic.value, (None, 0, None))(
        state.learner.critic, jnp.array([[4.0], [16.0], [256.0]]), jnp.zeros(1)
    )
    assert q.min() > 3
    assert q.max() < 6.6


def test_imagined_states_change_by_no_more_than_real_ones() -> None:
    """Of nine decisions that would double it each time: by twice the 0.25 of the data."""
    parts, given = (Leaving(1.0), TanhGaussian((8,)), EnsembleQ((8,))), {"branch_memory": 64}
    learner = branching(*parts, value_steps=0, branch_steps=9, change_limit=2, **given)
    zero, one = jnp.zeros(64), jnp.ones((64, 1))
    moved = jnp.where(jnp.arange(64)[:, None] < 9, 0.2, -0.25)
    seen = Batch(one, one, zero, zero, zero, one + moved)
    state, _ = learned(learner, Spec(obs=1, act=1, dt=1.0), lambda key: seen, 20)
    rows = state.branches.rows
    np.testing.assert_allclose(rows.next_obs - rows.obs, 0.5, rtol=1e-6)
    assert rows.obs.max() == 1 + 8 * 0.5
