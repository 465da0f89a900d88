"""Equal runs of a test session share their programs: each is traced and compiled one time.

Equal are agents, controllers and episodes by value, the precision, and the numbers of learners and
of rounds. A test that changes code that is traced puts an empty list for `KEPT`.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from hybrid_rl.networks import precision
from hybrid_rl.run.evaluations import Evaluator
from hybrid_rl.training.loop import Loop

KEPT: list[tuple[tuple, Any]] = []  # (what it was made of, what was made)


def kept(make: Callable[[], Any], *of: Any) -> Any:
    """What `make` returned for equal `of`; it is called for the first of them."""
    for known, made in KEPT:
        if known == of:
            return made
    KEPT.append((of, make()))
    return KEPT[-1][1]


@contextmanager
def shared() -> Iterator[None]:
    """Within it, runs take the programs of equal runs before them."""
    first, trace, compiled = Loop._first, Loop.trace, Loop.compile_trace
    evaluator = Evaluator.__init__

    def begun(self: Loop) -> tuple[Any, ...]:
        program, *given = first(self)
        of = self.agent, self.axis, len(self.seeds), precision.current()
        return kept(lambda: program, "first", *of), *given

    def traced(self: Loop, state: Any) -> Any:
        of = self.agent, self.axis, len(self.seeds), self.stride, precision.current()
        return kept(lambda: trace(self, state), "trace", *of)

    def program(self: Loop, given: Any) -> Any:
        return kept(lambda: compiled(self, given), "program", given)

    def evaluation(self: Evaluator, episode: Any, controller: Any, *given: Any) -> None:
        def make() -> dict[str, Any]:
            evaluator(self, episode, controller, *given)
            return vars(self)

        _, keys, *loop = given
        of = episode, controller, [each.axis for each in loop[:1]], keys.shape, precision.current()
        vars(self).update(kept(make, "evaluation", *of))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Loop, "_first", begun)
        patch.setattr(Loop, "trace", traced)
        patch.setattr(Loop, "compile_trace", program)
        patch.setattr(Evaluator, "__init__", evaluation)
        yield
