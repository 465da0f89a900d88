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


@pytest.mark.parametrize(("name", "method"), [("reward", "reward_of"), ("constraint", "excess")])
def test_what_is_paid_is_one_number(name, method):
    for function, words in (
        (lambda x, u, after: after[0] - u**2, "float32[1]"),
        (lambda x, u, after: None, "None"),
        (lambda x, u, after: 1.0 if x[0] > 0 else 0.0, "jnp.where"),
        (lambda x, u, after: (x[:, None] - after).sum(), "(3, 1) (3,)"),
        (lambda x, u, after: sys.exit(), "SystemExit"),
        (lambda x, u: x[0], "positional arguments"),
    ):
        with pytest.raises(ValueError, match=re.escape(words)) as error:
            Episode(Pendulum(), **{name: Mine(**{method: function})})
        assert f"Mine.{method}" in str(error.value)
        assert "\n" not in str(error.value)
    Episode(Pendulum(), **{name: Mine(**{method: lambda x, u, after: after[0] - u.sum()})})


def test_a_method_that_is_not_there_is_named():
    other: Any = type("Priced", (), {"price": 0.0, "chance": None, "width": 1.0})()
    with pytest.raises(ValueError, match=r"Priced.* has no excess"):
        Episode(Pendulum(), constraint=other)
