"""Limits against plain arithmetic, and what they refuse."""

import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.constraints.effort import Effort
from hybrid_rl.constraints.limit import Limit
from hybrid_rl.envs.quadcopter import Quadcopter

FLYING = Quadcopter(physics="native")
V = np.array([0.5, -2.0, 1.25], np.float32)  # [m/s]


def excess_of(limit: Limit) -> float:
    """At a velocity V of the quadcopter; a planning state may have more entries."""
    after = jnp.zeros(FLYING.spec.obs + 3).at[6:9].set(V)
    assert np.allclose(FLYING.quantities(after[: FLYING.spec.obs])["velocity"], V)
    return float(limit.excess(after, jnp.zeros(4), after))


@pytest.mark.parametrize(
    ("fields", "want"),
    [
        ({"most": 1.0}, 0.25),
        ({"least": -1.0}, 1.0),
        ({"most": 2.0, "least": -3.0}, -0.75),
        ({"most": (0.0, 1.0, 3.0)}, 0.5),
        ({"most": (None, 1.0, 3.0), "least": (0.0, None, None)}, -0.5),
        ({"most": (3.0,), "least": (-2.5,)}, -0.5),
        ({"most": 2.0, "norm": True}, np.sqrt(V @ V) - 2),
        ({"least": 3.0, "norm": True}, 3 - np.sqrt(V @ V)),
    ],
)
def test_the_excess_is_the_distance_beyond_the_nearest_limit(fields, want) -> None:
    assert excess_of(Limit(FLYING, "velocity", **fields)) == pytest.approx(want, abs=1e-6)


def test_effort_is_the_largest_entry_of_an_action() -> None:
    o = jnp.zeros(3)
    for u, want in (([0.2, -0.9], 0.4), ([0.2, 0.1], -0.3)):
        assert float(Effort(0.5).excess(o, jnp.array(u), o)) == pytest.approx(want)
