"""Parts check their own fields."""

from dataclasses import FrozenInstanceError
from typing import Literal

import numpy as np
import pytest

from hybrid_rl import config
from hybrid_rl.fields import Count, Discount, FieldError, NotNegative, Positive, Share, part
from hybrid_rl.protocols import Objective


@part
class Probe:
    """A part with a field of each sort."""

    count: Count = 1
    rate: Positive = 1.0
    tau: Share = 1.0
    discount: Discount | None = None
    kind: Literal["slow", "fast"] = "slow"
    low: tuple[float, float] = (0.0, 0.0)
    weights: tuple[NotNegative, ...] = ()
    rows: tuple[tuple[float, ...], ...] = ()
    which: tuple[int, ...] = ()
    factors: tuple[Positive, ...] | Positive = 1.0
    aim: Objective | None = None

    def __post_init__(self) -> None:
        """Check what depends on two fields."""
        if self.kind == "fast" and self.rate < 1:
            raise FieldError(self, "rate", "must be 1 or more")


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"count": 0}, "count=0: must be a whole number, 1 or more"),
        ({"count": 1.5}, "count=1.5: must be a whole number, 1 or more"),
        ({"count": True}, "count=true: must be a whole number, 1 or more"),
        ({"rate": float("nan")}, "rate=nan: must be above 0"),
        ({"tau": 3}, "tau=3: must lie in (0, 1]"),
        ({"discount": 1.0}, "discount=1.0: must lie in [0, 1), or null"),
        ({"kind": "faster"}, "kind=faster: choose one of slow, fast"),
        ({"low": [1.0]}, "low=[1.0]: must have 2 entries"),
        ({"weights": [1.0, -1.0]}, "weights=[1.0, -1.0]: must be 0 or more"),
        ({"weights": [1.0, "a"]}, "weights=[1.0, 'a']: must be 0 or more"),
        ({"aim": True}, "aim=true: must be a part, or null"),
        ({"weights": 1.0}, "weights=1.0: must be a list"),
        ({"weights": [np.eye(2)]}, "weights=[[[1.0, 0.0], [0.0, 1.0]]]: must be 0 or more"),
        ({"rows": [1.0, 2.0]}, "rows=[1.0, 2.0]: must be a list of lists"),
        ({"rows": [[float("nan")], [1.0]]}, "rows=[[nan], [1.0]]: must hold finite numbers"),
        ({"rows": [[1.0], ["a"]]}, "rows=[[1.0], ['a']]: must hold finite numbers"),
        ({"which": [0, 1.5]}, "which=[0, 1.5]: must hold whole numbers"),
        ({"factors": 0.0}, "factors=0.0: must be above 0"),
        ({"factors": [1.0, 0.0]}, "factors=[1.0, 0.0]: must be above 0"),
        ({"kind": "fast", "rate": 0.5}, "rate=0.5: must be 1 or more"),
    ],
)
def test_a_field_out_of_its_range_is_one_line_that_names_the_part(given, line):
    with pytest.raises(FieldError) as caught:
        Probe(**given)
    assert str(caught.value) == f"Probe: {line}"


def test_lists_and_arrays_become_tuples_and_a_part_is_a_frozen_dataclass():
    made = Probe(low=np.zeros(2), weights=[1.0], rows=[[1.0, 2.0], [3.0]], factors=[2])
    same = Probe(weights=(1.0,), rows=((1.0, 2.0), (3.0,)), factors=(2,))
    assert made == same
    assert hash(made) == hash(same)
    with pytest.raises(FrozenInstanceError):
        made.rate = 2.0


def test_a_run_names_the_shortest_key_of_the_field():
    """Also in Python, and for a part inside of another one."""
    for algo, typed in (
        ("sac", "policy_learner.tau=3"),
        ("hybrid_stochastic", "planner.horizon=0"),
        ("hybrid_stochastic", "critic.members=0"),
    ):
        key = typed.partition("=")[0]
        with pytest.raises(config.UsageError, match=rf"^{key}=\d: must"):
            config.build(config.load(["task=pendulum", f"algo={algo}", typed]))
