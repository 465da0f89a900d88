"""The protocols that parts follow; shapes as in hybrid_rl.types.

Parts do not inherit from them: a class that has these methods and fields is a part.
"""

from typing import Literal, Protocol

from jax import Array

from hybrid_rl.types import (
    Batch,
    EnvState,
    Params,
    Path,
    PyTree,
    Return,
    Spec,
    Step,
    Transition,
)


class Env(Protocol):
    """An environment. Frozen and hashable; everything that changes is in EnvState."""

    spec: Spec

    def reset(self, key: Array) -> EnvState:
        """The first state of an episode."""

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [m] in [-1, 1]."""

    def scene(self) -> str:
        """MJCF text, for drawing."""

    def pose(self, state: EnvState) -> Array:
        """The positions qpos [nq] of `scene` at `state`."""


class BalancedEnv(Env, Protocol):
    """An environment that stays at its equilibrium under a constant action."""

    def equilibrium(self) -> tuple[Array, Array]:
        """The observation [o] and the action [m] at rest."""


class TrackingEnv(BalancedEnv, Protocol):
    """An environment whose observation contains a reference that the robot is to follow."""

    def reference(self, obs: Array) -> tuple[Array, Array]:
        """The observations [o] that the robot should have at `obs` [o] and one decision later.

        Their own reference entries are those of `obs`.
        """


class AnalyticEnv(BalancedEnv, Protocol):
    """An environment with known dynamics whose observation is its whole state.

    Near its equilibrium it has local coordinates e [d], zero there, in which it is linearised.
    """

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [o] after action u [m] at x [o]; at the equilibrium, x itself."""

    def to_local(self, x: Array) -> Array:
        """Local coordinates e [d] of x [o]."""

    def from_local(self, e: Array) -> Array:
        """x [o] of local coordinates e [d]."""


class Features(Protocol):
    """z(o): the functions of an observation in which a model is linear."""

    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial parameters, with "weights" as an entry if they are learned."""

    def __call__(self, params: PyTree, obs: Array) -> Array:
        """z [n] of an observation [o]."""


class Model(Protocol):
    """x' = f(x, u)."""

    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial parameters."""

    def lift(self, params: PyTree, obs: Array) -> Array:
        """The planning state x [n] of an observation [o].

        Parts that read observations in planning states need x[:o] to be the observation.
        """

    def step(self, params: PyTree, x: Array, u: Array) -> Array:
        """Mean of the next planning state [n]."""


class Trainable(Model, Protocol):
    """A model that learns by gradients of its "weights", an entry of its parameters."""

    members: int  # models in an ensemble, each with a batch of its own

    def observe(self, params: PyTree, obs: Array, next_obs: Array) -> PyTree:
        """Parameters with statistics updated by observations [B, o] and their successors."""

    def loss(self, params: PyTree, obs: Array, action: Array, next_obs: Array) -> Array:
        """Mean loss [] of transitions [members * B, ...]."""

    def draw(self, params: PyTree, x: Array, u: Array, noise: Array, key: Array) -> Array:
        """Samples of the next planning states [B, n], for noise [B, n] ~ N(0, I)."""


class Uncertain(Model, Protocol):
    """A model with a predictive standard deviation."""

    def std(self, params: PyTree, x: Array) -> Array:
        """Standard deviation [n] of the change at x [n], in running standard deviations."""


class LinearModel(Uncertain, Protocol):
    """x' = K s(x, u), linear in its parameters.

    Parameters: "K" [n, r], and "root" U [r, r], upper triangular, with U'U the information of the
    data about K.
    """

    def regressors(self, params: PyTree, x: Array, u: Array) -> Array:
        """s [r] at x [n] and u [m]."""


class Policy(Protocol):
    """u = pi(x), stochastic."""

    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial parameters, for planning states of size spec.n."""

    def mean(self, params: PyTree, x: Array) -> Array:
        """The action [m] without noise."""

    def sample(self, params: PyTree, x: Array, noise: Array) -> tuple[Array, Array]:
        """The action [m] for noise [m] ~ N(0, I), and its log-density []."""

    def variance(self, params: PyTree, x: Array) -> Array:
        """Variance [m] of the action."""


class LearnedPolicy(Policy, Protocol):
    """A policy that learns by gradients."""

    def observe(self, params: PyTree, x: Array) -> PyTree:
        """Parameters with statistics updated by planning states x [B, n]."""

    def log_prob(self, params: PyTree, x: Array, u: Array) -> Array:
        """Log-density [...] of actions u [..., m] at x [..., n]."""


class GoalPolicy(Policy, Protocol):
    """A policy that leads to a goal, which can be changed."""

    def aim(self, params: PyTree, goal: Array, after: Array, step: Step) -> PyTree:
        """Parameters for the goal [n] now and `after` [n] a decision later, by the model `step`."""


class StabilizingPolicy(Policy, Protocol):
    """A policy that holds an analytic environment at its equilibrium."""

    world: AnalyticEnv

    def towards(self, x: Array, goal: Array) -> Array:
        """The action [m] at x [n] that leads to `goal` [o] instead of the equilibrium."""

    def lyapunov(self, x: Array) -> Array:
        """V(x) [], a Lyapunov function under the policy."""


class Critic(Protocol):
    """Q(x, u), an ensemble."""

    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial parameters, for planning states of size spec.n."""

    def all(self, params: PyTree, x: Array, u: Array) -> Array:
        """Q [members, ...] at x [..., n] and u [..., m]."""

    def value(self, params: PyTree, x: Array, u: Array) -> Array:
        """Q [...], reduced over the members."""


class Reward(Protocol):
    """r(x, u), learned; its parameters hold "weights" as a Trainable's do."""

    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial parameters, for planning states of size spec.n."""

    def observe(self, params: PyTree, x: Array) -> PyTree:
        """Parameters with statistics updated by planning states x [B, n]."""

    def outcome(self, params: PyTree, x: Array, u: Array) -> tuple[Array, Array]:
        """The reward [] of u [m] at x [n], and the logit [] of the episode ending there."""

    def loss(self, params: PyTree, x: Array, u: Array, target: Array, ended: Array) -> Array:
        """Loss [] of one transition against target [] and `ended` [], 0 or 1."""


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


class Belief(Protocol):
    """A distribution over an unknown function, updated recursively by measurements y at s."""

    def init(self, key: Array, spec: Spec) -> PyTree:
        """The belief before any measurement."""

    def add(self, state: PyTree, s: Array, y: Array, key: Array) -> PyTree:
        """The belief after y [] was measured at s [v]."""

    def predict(self, state: PyTree, s: Array) -> tuple[Array, Array]:
        """Mean and standard deviation [] of the function at s [v]."""

    def loss(self, state: PyTree, s: Array, y: Array) -> Array:
        """Negative log-likelihood [] of y [] at s [v], before it is added."""

    def report(self, state: PyTree) -> dict[str, Array]:
        """Metrics, name -> []."""


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


class Demonstrations(Protocol):
    """An expert's decisions."""

    def load(self) -> Transition:
        """All of them [N, ...], in order."""


class _Learner(Protocol):
    """What both kinds of learners have."""

    owns: tuple[str, ...]  # the fields of `Params` that it learns

    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial state: parameters, optimisers, targets."""

    def params(self, state: PyTree) -> dict[str, PyTree]:
        """The fields of `Params` that this learner owns."""

    def update(
        self, state: PyTree, params: Params, batch: Batch, key: Array
    ) -> tuple[PyTree, dict[str, Array]]:
        """The next state, and metrics name -> []; `params` of all learners before the update."""


class UniformLearner(_Learner, Protocol):
    """A learner whose updates get batches [batches * batch_size] of the replay memory."""

    data: Literal["uniform"]
    batch_size: int  # transitions of a batch
    batches: int  # batches of one update, concatenated
    updates: float  # per decision
    early: bool  # whether it also learns while decisions are random


class LatestLearner(_Learner, Protocol):
    """A learner that takes each decision once, with its true next observation.

    Its updates get the transitions [E] of the step that just ended, without delay, from the
    first decision of the run on, random ones included.
    """

    data: Literal["latest"]
    every: int  # decisions of each environment between two updates; 1: uses them all


Learner = UniformLearner | LatestLearner  # data -> parameters
