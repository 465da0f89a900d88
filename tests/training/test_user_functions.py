"""A reward or a constraint of one's own that is wrong is one line, before anything is compiled."""

import re
import sys
from dataclasses import dataclass
from typing import Any

import pytest

from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.training.episode import Episode


@dataclass(frozen=True)
class Mine:
    """One function as a reward and as a constraint."""

    reward_of: Any = None
    excess: Any = None
    price, chance, width = 0.0, None, 1.0  # of a constraint


GIVES = "it must be float32[]"


@pytest.mark.parametrize("name", ["reward", "constraint"])
@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda x, u, after: after[0] - u**2, f"float32[1]; {GIVES}"),
        (lambda x, u, after: 1, f"a int; {GIVES}"),
        (lambda x, u, after: None, f"None; {GIVES}"),
        (lambda x, u, after: 1.0 if x[0] > 0 else 0.0, "write jnp.where or jax.lax.cond"),
        (lambda x, u, after: x[3], "index 3 is out of bounds for axis 0 with size 3; JAX takes"),
        (
            lambda x, u, after: (x[:, None] - after).sum(),
            "Operands could not be broadcast together for subtract on shapes (3, 1) (3,)",
        ),
        (lambda x, u, after: sys.exit(), "SystemExit; raise an error instead of sys.exit()"),
    ],
)
def test_what_is_paid_is_one_number(name, function, words):
    method = {"reward": "reward_of", "constraint": "excess"}[name]
    with pytest.raises(ValueError, match=re.escape(words)) as error:
        Episode(Pendulum(), **{name: Mine(**{method: function})})
    assert re.search(rf"test_user_functions\S*: Mine\.{method}: ", str(error.value))
    assert "\n" not in str(error.value)
    Episode(Pendulum(), **{name: Mine(**{method: lambda x, u, after: after[0] - u.sum()})})


def test_a_method_that_takes_other_things_or_is_not_there_is_named():
    def wrong(**given):
        with pytest.raises(ValueError, match=r"test_user_functions\S*: Mine") as error:
            Episode(Pendulum(), **given)
        return str(error.value)

    other: Any = Mine(reward_of=lambda x, u: x[0])
    assert wrong(reward=other).endswith("(x, u): must be reward_of(self, x, u, after)")
    assert wrong(constraint=other).endswith("has no excess; write def excess(self, x, u, after)")
