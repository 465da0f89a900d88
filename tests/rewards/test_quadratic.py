"""The quadratic return against a plain sum."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.objectives.predicted_return import PredictedReturn
from hybrid_rl.rewards.quadratic import QuadraticReward
from hybrid_rl.types import Params, Path

WORLD = QuadcopterSE3()


@pytest.mark.parametrize("q", [tuple(np.linspace(0.1, 2.0, 12)), (0.7,)])
def test_return_is_the_plain_sum(q) -> None:
    """It has every state after the first and every action, and is 0 at the end.

    One weight is that of every coordinate.
    """
    objective = PredictedReturn(QuadraticReward(WORLD, q, (0.3,)), discount=0.9)
    rng = np.random.default_rng(0)
    e, u = rng.uniform(-0.4, 0.4, (5, 12)), rng.uniform(-1, 1, (4, 4))
    x = jax.jit(jax.vmap(WORLD.from_local))(jnp.asarray(e, jnp.float32))
    hover = np.asarray(WORLD.equilibrium()[1])
    rewards = [-sum(np.array(q) * e[t + 1] ** 2) - 0.3 * sum((u[t] - hover) ** 2) for t in range(4)]
    path = Path(x, jnp.asarray(u, jnp.float32))
    want = [sum(0.9 ** (i - t) * rewards[i] for i in range(t, 4)) for t in range(5)]
    to_go = jax.jit(objective.reward_to_go)(Params(), path)
    np.testing.assert_allclose(to_go, want, rtol=1e-4)
    value, _ = objective.prepare(Params(), (), path.x[0], path.u[0], jax.random.key(0))
    assert float(jax.jit(value)(path)) == pytest.approx(want[0], rel=1e-4)
