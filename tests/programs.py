"""Equal runs of a test session share their programs: each is traced and compiled once.

Equal are agents, controllers and episodes by value, and the numbers of learners and of rounds. A
test that changes code which is traced puts an empty list for `KEPT`.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from hybrid_rl.run.evaluations import Evaluator
from hybrid_rl.training.loop import Loop

KEPT: list[tuple[tuple, Any]] = []  # (what it was made of, what was made)


def once(make: Callable[[], Any], *of: Any) -> Any:
    """The value of `make`, called for the first of equal `of` only."""
    for known, made in KEPT:
        if known == of:
            return made
    KEPT.append((of, make()))
    return KEPT[-1][1]


@contextmanager
def shared() -> Iterator[None]:
    """Within it, runs take the programs of equal runs before them."""
    trace, compiled, evaluator = Loop.trace, Loop.compile, Evaluator.__init__

    def trace_once(self: Loop, state: Any) -> Any:
        of = self.agent, len(self.seeds), self.stride
        return once(lambda: trace(self, state), "trace", *of)

    def compile_once(self: Loop, state: Any, traced: Any = None) -> Any:
        traced = self.trace(state) if traced is None else traced
        return once(lambda: compiled(self, state, traced), "compile", traced)

    def evaluate_once(self: Evaluator, loop: Loop, controller: Any, params: Any, keys: Any) -> None:
        def make() -> dict[str, Any]:
            evaluator(self, loop, controller, params, keys)
            return vars(self)

        of = loop.agent.episode, controller, keys.shape
        vars(self).update(once(make, "evaluator", *of))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Loop, "trace", trace_once)
        patch.setattr(Loop, "compile", compile_once)
        patch.setattr(Evaluator, "__init__", evaluate_once)
        yield
