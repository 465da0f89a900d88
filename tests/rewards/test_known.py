"""The return of a known reward against rewards that the environment gives."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.rewards.known import KnownReward
from hybrid_rl.types import Params, Path


def test_return_is_the_discounted_sum_of_the_rewards_of_an_episode() -> None:
    env, discount = Pendulum(), 0.9
    objective = PredictedReturn(KnownReward(env), discount)
    u = np.random.default_rng(0).uniform(-1, 1, (6, 1)).astype(np.float32)
    state = env.reset(jax.random.key(1))
    x, rewards = [state.obs], []
    for action in u:
        state = env.step(state, jnp.asarray(action))
        x.append(state.obs)
        rewards.append(float(state.reward))
    path = Path(jnp.stack(x), jnp.asarray(u))
    want = [sum(discount ** (i - t) * rewards[i] for i in range(t, 6)) for t in range(7)]
    np.testing.assert_allclose(objective.reward_to_go(Params(), path), want, rtol=1e-5)
    value, _ = objective.prepare(Params(), (), path.x[0], path.u[0], jax.random.key(0))
    assert float(value(path)) == pytest.approx(want[0], rel=1e-5)
