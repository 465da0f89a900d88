"""Parts check their own fields."""

import re
from dataclasses import FrozenInstanceError
from typing import Annotated, Literal

import numpy as np
import pytest

from hybrid_rl.fields import (
    FILLED,
    Count,
    Discount,
    FieldError,
    NotNegative,
    Positive,
    Several,
    Share,
    part,
)
from hybrid_rl.protocols import Objective
from hybrid_rl.settings import build as config


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
    names: Annotated[tuple[Several, ...], FILLED] = (2,)
    aim: Objective | None = None

    def __post_init__(self) -> None:
        """Check what depends on two fields."""
        if self.kind == "fast" and self.rate < 1:
            raise FieldError(self, "rate", "must be 1 or more")


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"count": 0}, "count=0: must be a whole number, 1 or more"),
        ({"count": True}, "count=true: must be a whole number, 1 or more"),
        ({"rate": float("nan")}, "rate=nan: must be above 0"),
        ({"count": 10**12}, "count=1000000000000: must be at most 1073741824"),
        ({"rate": True}, "rate=true: must be a number"),
        ({"discount": {"a": 1}}, "discount={'a': 1}: must be a number, or null"),
        ({"names": [1]}, "names=[1]: must be a whole number, 2 or more"),
        ({"tau": 3}, "tau=3: must lie in (0, 1]"),
        ({"discount": 1.0}, "discount=1.0: must lie in [0, 1), or null"),
        ({"kind": "faster"}, "kind=faster: choose one of slow, fast"),
        ({"low": [1.0]}, "low=[1.0]: must have 2 entries"),
        ({"weights": [1.0, -1.0]}, "weights=[1.0, -1.0]: must be 0 or more"),
        *(
            ({"aim": value}, f"aim={text}: must be a part, or null")
            for value, text in ((True, "true"), ([], "[]"), ({"a": 1}, "{'a': 1}"))
        ),
        ({"weights": 1.0}, "weights=1.0: must be a list"),
        ({"weights": [np.eye(2)]}, "weights=[[[1.0, 0.0], [0.0, 1.0]]]: must be 0 or more"),
        ({"rows": [1.0, 2.0]}, "rows=[1.0, 2.0]: must be a list of lists"),
        ({"rows": [[float("nan")], [1.0]]}, "rows=[[nan], [1.0]]: must hold finite numbers"),
        ({"which": [0, 1.5]}, "which=[0, 1.5]: must hold whole numbers"),
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
    assert [type(each) for each in (*made.factors, Probe(rate=2).rate)] == [float, float]
    with pytest.raises(FrozenInstanceError):
        made.rate = 2.0


def test_a_module_may_postpone_its_annotations():
    code = "from __future__ import annotations\nfrom hybrid_rl.fields import Count, part\n"
    made: dict = {"__name__": __name__}
    exec(f"{code}@part\nclass Late:\n    count: Count = 1", made)
    with pytest.raises(FieldError, match="count=0: must be a whole number, 1 or more"):
        made["Late"](count=0)


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


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ("episode.sensor_noise=[]", "episode.sensor_noise=[]: must be one number, or 3 of them"),
        ("policy_learner.updates=1e-30", "or 1 / a whole number, of at most 1073741824"),
        ("model.model.inputs=[3]", "model.inputs=[3]: must be some of the entries 0 to 2"),
        ("algo=kle3 equilibrium.free=[9]", "equilibrium.free=[9]: must be some of 0 to 1, not all"),
        ("task=two_link algo=kle3_bayesopt", "belief.size=1: must be 2, as of the domain"),
        ("algo=sac learner@policy_learner=flash_sac", "needs policy=unit_gaussian"),
    ],
)
def test_what_no_run_can_use_is_refused_before_it(given, line):
    words = ["task=pendulum", "algo=hybrid_stochastic", *re.split(r" (?=[\w.@]+=)", given)]
    with pytest.raises(config.UsageError, match=re.escape(line)):
        config.build(config.load(words))
