"""Whether a number that is not finite is the world's or that of learning."""

import numpy as np
import pytest

from hybrid_rl.run import session
from hybrid_rl.run.logs import records

WORLDS = 2


@pytest.mark.parametrize(
    ("infinite", "step", "quantity"),
    [
        ({"sac/q": 2, "world/reward": 2}, 6, "world/reward"),
        ({"sac/q": 1, "world/reward": 2}, 4, "sac/q"),
        ({"world/action": 2, "world/reward": 2}, 6, "world/action"),
    ],
)
def test_what_failed_first_or_acted_is_to_blame(infinite, step, quantity):
    """Of several at one step the world's, as what learns from it is infinite at once."""
    metrics = {name: np.zeros((5, 1)) for name in ("sac/q", "world/action", "world/reward")}
    for name, at in infinite.items():
        metrics[name][at:] = np.inf
    ((at, what),) = records.infinite(metrics, 0, WORLDS).values()
    ends = [{"seed": 3, "step": at, "quantity": what}]
    line = f"seed 3, step {step}: {quantity} is not finite"
    assert session.failure_line(ends, 0, None) == f"{line}; there is no checkpoint"
    assert f"{line}; checkpoint 4 is intact: fix what" in session.failure_line(ends, 0, 4)
