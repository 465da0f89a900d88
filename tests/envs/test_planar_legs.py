"""What hopper and walker observe."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from worlds import TASKS, jitted


@pytest.mark.parametrize("task", ["hopper", "walker2d"])
def test_observed_velocities_are_clipped_as_asked(task):
    kind = TASKS[task]
    state = kind("native").reset(jax.random.key(0))
    fast = state.data.replace(qvel=12.0 * jnp.ones_like(state.data.qvel))
    state, still = state.replace(data=fast), jnp.zeros(kind("native").spec.act)
    seen = {}
    for limit in (10.0, 4.0, None):
        env = kind("native", velocity_limit=limit)
        after = jitted(env, "step")(state, still)
        seen[limit], qvel = after.obs[-len(fast.qvel) :], after.data.qvel
    assert jnp.abs(qvel).max() > 11.0
    np.testing.assert_array_equal(seen[None], qvel)
    for limit in (10.0, 4.0):
        np.testing.assert_array_equal(seen[limit], jnp.clip(qvel, -limit, limit))
    with pytest.raises(ValueError, match=r"velocity_limit=0.0: must be above 0, or null"):
        kind("native", velocity_limit=0.0)
