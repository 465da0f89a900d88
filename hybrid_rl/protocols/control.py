"""Protocols of objectives, targets, proposals and controllers, which decide."""

from typing import Protocol

from jax import Array

from hybrid_rl.protocols.contract import gives
from hybrid_rl.types import Params, PyTree, Return, Spec


class Objective(Protocol):
    """J(path): the return that a planner maximises; any function of the path and of the past.

    One that is a sum over time may have `reward_to_go(params, path)`, which a planner that samples
    calls instead: S [T+1] from each time on, with J = S[0] and the value of the last state in S[T].
    One with a memory may have `covered(params, memory, x, key)`: metrics of the episode up to x,
    which gradient planners log; its key is that of `prepare`.
    """

    @gives("spec -> memory")
    def init(self, spec: Spec) -> PyTree:
        """Memory before the first decision of an episode."""

    @gives("Params, memory, x, u [m], key -> J [], memory")
    def prepare(
        self, params: Params, memory: PyTree, x: Array, u_before: Array, key: Array
    ) -> tuple[Return, PyTree]:
        """J of paths that begin at the planning state x [n], and the memory after this decision.

        u_before: [m] the previous action, 0 at the first decision. J is a plain function, which
        closes over everything drawn from `key`; the memory holds only what later decisions need.
        `params.decisions` is None in evaluation, where a bonus for exploration is left out.
        """


class Target(Protocol):
    """p(s): the density in which a method explores the search space.

    One that depends on a teacher's labels so far has `evidence(params, x)`, whose sum over the
    labelled states x [n] it gets as `params.labels.evidence`. One that has `outside(low, high)`,
    whether all of it lies outside the box [low, high], [v], is refused for such a domain. One that
    scores paths has `along(params, path)`, the value [] of measurements on a path [T, v].
    """

    @gives("Params, s [v] -> log_density []")
    def log_density(self, params: Params, s: Array) -> Array:
        """log p(s) [] at s [v], up to a constant."""


class Proposal(Protocol):
    """The distribution from which a sampling planner draws its candidates."""

    @gives("spec, quantile [] -> carry")
    def init(self, spec: Spec, quantile: Array) -> PyTree:
        """Carry of one imagined path before its first action; `quantile` [] in [0, 1) is k / K."""

    def shaped(self, noise: Array) -> PyTree:
        """[T, ...] what `__call__` receives in each decision, for the noise [T, m] of a path."""

    def __call__(
        self, params: Params, carry: PyTree, x: Array, plan: Array, noise: Array
    ) -> tuple[Array, Array, PyTree]:
        """A candidate v [m] at x [n] near the plan [m], its log-density [], the next carry.

        All randomness is in the noise ~ N(0, I), which the planner draws for all candidates and
        which `shaped` returns, [m] a decision unless it depends on the whole horizon.
        """


class Controller(Protocol):
    """obs -> action.

    One that compares candidates may have `considered`, with the arguments of `act`, whose first
    three results are those of `act`; the fourth is Considered.
    """

    @gives("spec -> state")
    def init(self, spec: Spec) -> PyTree:
        """State at the start of an episode."""

    @gives("Params, state, obs [o], key -> action [m], state, metrics")
    def act(
        self, params: Params, state: PyTree, obs: Array, key: Array
    ) -> tuple[Array, PyTree, dict[str, Array]]:
        """Action [m] in [-1, 1], next state, metrics (name -> [], NaN where one does not apply)."""

    def greedy(self) -> "Controller":
        """The same controller without exploration, for evaluation."""
