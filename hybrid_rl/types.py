"""The nouns that parts exchange, and the protocols that parts follow.

Shapes, once for the whole project:

    o observation   n planning state   m action   T planning horizon [decisions]
    K samples       B batch            E parallel worlds   C capacity
    s search state  v its size         N points of it

Everything is written for ONE world and ONE sample; `jax.vmap` adds E, K, B and
the seeds. Actions u lie in [-1, 1]^m everywhere; a world scales them to its own
units. J is a return and is maximised everywhere. A key is always the last
argument and is consumed.
"""

from typing import Any, NamedTuple, Protocol

from flax import struct
from jax import Array

PyTree = Any


class Spec(NamedTuple):
    """Sizes and rate of a world, as every part sees it."""

    obs: int  # o
    act: int  # m
    dt: float  # [s] between two decisions


@struct.dataclass
class EnvState:
    """What a world is between two decisions (a superset of Brax's fields)."""

    data: PyTree  # the world's own physical state
    obs: Array  # [o]
    reward: Array  # []
    terminated: Array  # [] bool: the task ended, nothing comes after
    truncated: Array  # [] bool: the clock ended it, the task would go on
    metrics: dict[str, Array]  # name -> [], for logs alone
    info: dict[str, Array]  # task memory

    @property
    def done(self) -> Array:
        """[] bool: the episode is over, for either reason."""
        return self.terminated | self.truncated


class Transition(NamedTuple):
    """One decision, as remembered."""

    obs: Array  # [o]
    action: Array  # [m]
    reward: Array  # []
    terminated: Array  # [] bool
    truncated: Array  # [] bool
    next_obs: Array  # [o] the true next observation, also where the episode ends


class Batch(NamedTuple):
    """B transitions, as recalled; arrays lead with [B]."""

    obs: Array  # [B, o]
    action: Array  # [B, m]
    reward: Array  # [B]
    terminated: Array  # [B] 0 or 1
    truncated: Array  # [B] 0 or 1
    next_obs: Array  # [B, o]
    next_action: Array  # [B, m] executed at next_obs; meaningless where the episode ended


class Path(NamedTuple):
    """A trajectory, real or imagined: the currency between parts."""

    x: Array  # [T+1, n]
    u: Array  # [T, m]


class Params(NamedTuple):
    """Read-only view of all that is learned."""

    model: PyTree = None  # f(x, u)
    reward: PyTree = None  # r(x, u)
    policy: PyTree = None  # pi(x)
    critic: PyTree = None  # Q(x, u)
    belief: PyTree = None  # whatever else a method learns
    decisions: Array | None = None  # [] into the run, where it is training


class Env(Protocol):
    """A world. Frozen and hashable; all that changes is in EnvState."""

    spec: Spec

    def reset(self, key: Array) -> EnvState:
        """A first state, drawn with `key`."""

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [m] in [-1, 1]."""

    def scene(self) -> str:
        """MJCF text of the world as it is drawn."""

    def pose(self, state: EnvState) -> Array:
        """Qpos [nq] of `scene` that shows `state`."""


class AnalyticEnv(Env, Protocol):
    """A world whose motion is known in full: its observation is its whole state.

    Around its equilibrium it has coordinates e [d], zero there, in which it can be linearised.
    """

    def dynamics(self, x: Array, u: Array) -> Array:
        """The observation [o] that follows x [o] under u [m]."""

    def equilibrium(self) -> tuple[Array, Array]:
        """The equilibrium: x [o] and u [m] with flow(x, u) = x."""

    def to_local(self, x: Array) -> Array:
        """e [d] of x [o]."""

    def from_local(self, e: Array) -> Array:
        """x [o] of e [d]; the inverse of `deviation`."""


class Model(Protocol):
    """x' = f(x, u)."""

    def init(self, key: Array, spec: Spec) -> PyTree:
        """First parameters."""

    def lift(self, params: PyTree, obs: Array) -> Array:
        """Planning state x [n] of an observation [o]."""

    def step(self, params: PyTree, x: Array, u: Array) -> Array:
        """Mean of the next planning state [n]."""


class Policy(Protocol):
    """u = pi(x), stochastic."""

    def init(self, key: Array, spec: Spec) -> PyTree:
        """First parameters."""

    def mean(self, params: PyTree, x: Array) -> Array:
        """The action [m] without noise."""

    def sample(self, params: PyTree, x: Array, noise: Array) -> tuple[Array, Array]:
        """The action [m] that `noise` [m] ~ N(0, I) becomes, and its log-density []."""

    def variance(self, params: PyTree, x: Array) -> Array:
        """Of the action [m]."""


class Objective(Protocol):
    """J(path), a return: what a planner maximises. It may couple all times, and the past."""

    def begin(self, spec: Spec) -> PyTree:
        """What it remembers before the first decision of an episode."""

    def look(self, params: Params, memory: PyTree, x: Array, key: Array) -> PyTree:
        """Memory at the planning state x [n] of now, with all chance that J needs, from `key`."""

    def value(self, params: Params, memory: PyTree, path: Path) -> Array:
        """J [] of a path that begins at that state."""


class Staged(Objective, Protocol):
    """An objective that is a sum over time."""

    discount: float  # per decision

    def rewards(self, params: Params, path: Path) -> Array:
        """r [T] of each decision of the path."""

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1]: the return from each time on. S[0] is J, S[T] the value of the last state."""


class Target(Protocol):
    """p(s): where in the search space there is something to learn."""

    def log_density(self, params: Params, s: Array) -> Array:
        """log p(s) [] at s [v], up to a constant."""


class Lyapunov(Protocol):
    """V(x) that falls under a policy."""

    def lyapunov(self, x: Array) -> Array:
        """V [] at x [n]."""


class Proposal(Protocol):
    """v ~ ?: where a sampling planner draws its candidates from."""

    def init(self, spec: Spec, place: Array) -> PyTree:
        """Carry of one imagined path before its first action; `place` [] in [0, 1) is k / K."""

    def __call__(
        self, params: Params, carry: PyTree, x: Array, plan: Array, noise: Array
    ) -> tuple[Array, Array, PyTree]:
        """A candidate v [m] at x [n] beside the plan [m], its log-density [], the next carry.

        All chance is in `noise` [m] ~ N(0, I): the planner draws it for all candidates at once.
        """


class Controller(Protocol):
    """obs -> action."""

    def init(self, spec: Spec) -> PyTree:
        """State at the start of an episode."""

    def act(
        self, params: Params, state: PyTree, obs: Array, key: Array
    ) -> tuple[Array, PyTree, dict[str, Array]]:
        """Action [m] in [-1, 1], next state, metrics (name -> [])."""

    def greedy(self) -> "Controller":
        """The same controller without exploration, for evaluation."""


class Learner(Protocol):
    """data -> parameters."""

    batch_size: int  # transitions of a batch
    batches: int  # that one update takes, one after the other in its rows
    updates: float  # per decision
    early: bool  # whether it learns while decisions are random, too

    def init(self, key: Array, spec: Spec) -> PyTree:
        """First state: parameters, optimisers, targets."""

    def params(self, state: PyTree) -> dict[str, PyTree]:
        """The fields of `Params` that this learner owns."""

    def update(
        self, state: PyTree, params: Params, batch: Batch, key: Array
    ) -> tuple[PyTree, dict[str, Array]]:
        """One gradient step on `batch` [batches * batch_size]; `params` of all learners."""
