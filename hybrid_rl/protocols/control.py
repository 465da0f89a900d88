"""What decides: objectives, targets, proposals and controllers."""

from typing import Protocol

from jax import Array

from hybrid_rl.types import Params, Path, PyTree, Return, Spec


class Objective(Protocol):
    """J(path): the return that a planner maximises; any function of the path and of the past."""

    def init(self, spec: Spec) -> PyTree:
        """Memory before the first decision of an episode."""

    def prepare(
        self, params: Params, memory: PyTree, x: Array, u_before: Array, key: Array
    ) -> tuple[Return, PyTree]:
        """J of paths that begin at the planning state x [n], and the memory after this decision.

        u_before: [m] the previous action, 0 at the first decision. J is a plain function, which
        closes over everything drawn from `key`; the memory holds only what later decisions need.
        """


class Staged(Objective, Protocol):
    """An objective that is a sum over time."""

    def rewards(self, params: Params, path: Path) -> Array:
        """r [T] of each decision of the path."""

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1]: the return from each time on. S[0] is J, S[T] the value of the last state."""


class Target(Protocol):
    """p(s): the density in which a method explores the search space."""

    def log_density(self, params: Params, s: Array) -> Array:
        """log p(s) [] at s [v], up to a constant."""


class PathTarget(Target, Protocol):
    """A target that values ways too."""

    def along(self, params: Params, path: Array) -> Array:
        """The value [] of measurements on path [T, v]."""


class LabelledTarget(Target, Protocol):
    """A target that depends on a teacher's labels so far, in `params.labels.evidence`."""

    def evidence(self, params: Params, x: Array) -> PyTree:
        """What is summed over the labelled states x [n]; None: nothing."""


class Proposal(Protocol):
    """The distribution from which a sampling planner draws its candidates."""

    def init(self, spec: Spec, quantile: Array) -> PyTree:
        """Carry of one imagined path before its first action; `quantile` [] in [0, 1) is k / K."""

    def __call__(
        self, params: Params, carry: PyTree, x: Array, plan: Array, noise: Array
    ) -> tuple[Array, Array, PyTree]:
        """A candidate v [m] at x [n] near the plan [m], its log-density [], the next carry.

        All randomness is in `noise` [m] ~ N(0, I), which the planner draws for all candidates.
        """


class ShapingProposal(Proposal, Protocol):
    """A proposal whose noise depends on the whole horizon."""

    def shaped(self, noise: Array) -> PyTree:
        """[T, ...] what `__call__` receives in each decision, for the noise [T, m] of a path."""


class Controller(Protocol):
    """obs -> action."""

    def init(self, spec: Spec) -> PyTree:
        """State at the start of an episode."""

    def act(
        self, params: Params, state: PyTree, obs: Array, key: Array
    ) -> tuple[Array, PyTree, dict[str, Array]]:
        """Action [m] in [-1, 1], next state, metrics (name -> [], NaN where one does not apply)."""

    def greedy(self) -> "Controller":
        """The same controller without exploration, for evaluation."""
