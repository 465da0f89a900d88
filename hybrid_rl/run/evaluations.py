"""Evaluations of all learners, in training and of a run that is read back: the same episodes.

A call takes a few seconds at most, so that a signal is heard between two calls.
"""

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from time import perf_counter
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.outside.host_loop import HostEvaluator
from hybrid_rl.protocols import Controller
from hybrid_rl.run.schedule import Pace
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loop import REPLICATED, SEEDS, Axis, Loop, compile_lowered
from hybrid_rl.training.rollout import advance, begin, evaluation_keys, scores
from hybrid_rl.types import Params

if TYPE_CHECKING:
    from hybrid_rl.run.saved import Trained

EVALUATED = {  # mode -> what its outcomes' names begin with
    "full": "eval/",
    "policy": "eval/policy_",
    "planner": "eval/planner_",
}


class Evaluations:
    """Evaluations of all learners of `loop` in every mode; `controllers` are by mode."""

    def __init__(
        self, loop: Loop, controllers: Mapping[str, Controller], episodes: int, params: Params
    ) -> None:
        """Compile all of them, beside what the caller compiles; params: [S, ...]."""
        keys = self.keys = jnp.stack([evaluation_keys(seed, episodes) for seed in loop.seeds])
        episode = loop.agent.episode
        self._evaluators = {
            mode: evaluator_of(episode)(episode, controller, params, keys, loop, mode)
            for mode, controller in controllers.items()
        }

    def wait(self) -> None:
        """Return when all are compiled."""
        for each in self._evaluators.values():
            if isinstance(each, Evaluator):
                each.program.result()

    def __call__(self, params: Params, cut: Callable[[], bool]) -> list[dict[str, float]] | None:
        """The mean of every outcome for each learner; None once `cut` is true."""
        means: dict[str, np.ndarray] = {}  # [S]
        for mode, evaluator in self._evaluators.items():
            outcomes = evaluator(params, self.keys, lambda made: cut())
            if outcomes is None:
                return None
            means |= {EVALUATED[mode] + name: each.mean(-1) for name, each in outcomes.items()}
        return [{name: float(m[s]) for name, m in means.items()} for s in range(len(self.keys))]


class Evaluator:
    """Episodes of every learner under `controller`, in calls of a few seconds at most.

    It compiles in a thread when it is made. params: [S, ...]; keys: [S, N], one per episode; loop:
    whose devices and numbers it has, None for one device; mode: of the controller.
    """

    def __init__(
        self,
        episode: Episode,
        controller: Controller,
        params: Params,
        keys: Array,
        loop: Loop | None = None,
        mode: str = "full",
    ) -> None:
        self.steps = episode.steps
        axis, self.numbers = (Axis(), {}) if loop is None else (loop.axis, loop.numbers)

        def one(f: Callable[..., Any], numbers: Any, *given: Any) -> Any:
            """`begin` or `advance` of one learner with numbers [] of the axis."""
            acting = axis.put(controller, f"controllers.{mode}", numbers)
            return f(axis.put(episode, "agent.episode", numbers), acting, *given)

        def program(f: Callable[..., Any], ins: Any, **options: Any) -> Any:
            """`jit(f)`, on the devices of the loop."""
            return jax.jit(f, **options) if loop is None else loop.shard(f, ins, SEEDS, **options)

        first = program(jax.vmap(partial(one, begin)), SEEDS)
        self._begin = compile_lowered(first.lower(self.numbers, keys))
        given = self.numbers, params, self._begin(self.numbers, keys), jnp.int32(0)
        more = jax.vmap(partial(one, advance), (0, 0, 0, None))
        more = program(more, (SEEDS, SEEDS, SEEDS, REPLICATED), donate_argnums=2)
        beside = ThreadPoolExecutor(1)
        self.program = beside.submit(compile_lowered, more.lower(*given))
        beside.shutdown(wait=False)

    def __call__(
        self, params: Params, keys: Array, cut: Callable[[int], bool | None]
    ) -> dict[str, np.ndarray] | None:
        """The `scores` [S, N] at the end of the episodes; None once `cut` is true.

        cut: is called with the decisions made, between calls of a few seconds at most.
        """
        carry, pace, made = self._begin(self.numbers, keys), Pace(), 0
        call = self.program.result()
        while not np.asarray(carry[0].done).all():
            if cut(made):
                return None
            rounds, began = pace.rounds(self.steps), perf_counter()
            given = self.numbers, params, carry, jnp.int32(rounds)
            carry = jax.block_until_ready(call(*given))
            pace.took(rounds, perf_counter() - began)
            made += rounds
        return {name: np.asarray(value) for name, value in scores(carry[0]).items()}


def evaluator_of(episode: Episode) -> type[Evaluator] | type[HostEvaluator]:
    """What evaluates in the environment of these episodes."""
    return HostEvaluator if isinstance(episode.env, External) else Evaluator


def evaluate(
    trained: "Trained",
    mode: str = "full",
    episodes: int = 10,
    on_decisions: Callable[[int], bool | None] = lambda made: None,
) -> dict[str, np.ndarray]:
    """Undiscounted `return` [S, episodes] of the same episodes as in training.

    If the task measures it, also `success` [S, episodes], 0 or 1; with a constraint also
    `violations` [S, episodes], in decisions. on_decisions: is called now and then with the number
    of decisions that every episode has made; once it returns True, there is no result, {}.

    Raises:
        UsageError: for a mode that the method does not have.
    """
    episode, (controller, _) = trained.episode, trained.learner(mode=mode, world=True)
    keys = jnp.stack([evaluation_keys(seed, episodes) for seed in trained.seeds])
    evaluator = evaluator_of(episode)(episode, controller, trained.params, keys)
    return evaluator(trained.params, keys, on_decisions) or {}


def report(trained: "Trained", mode: str, got: dict[str, np.ndarray]) -> dict[str, Any]:
    """What evaluation_<mode>.json holds."""
    more, returns = {}, got["return"]
    if (success := got.get("success")) is not None:
        more = {"success": success.mean(1).tolist(), "succeeded": success.astype(bool).tolist()}
    if (number := got.get("violations")) is not None:
        more |= {"violations": number.mean(1).tolist(), "violated": number.astype(int).tolist()}
    return {
        "mode": mode,
        "step": trained.step,
        "seeds": list(trained.seeds),
        "episodes": returns.shape[1],
        "mean": returns.mean(1).tolist(),
        "std": returns.std(1).tolist(),
        **more,
        "returns": returns.tolist(),
    }
