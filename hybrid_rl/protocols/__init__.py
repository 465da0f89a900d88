"""The protocols that parts follow; shapes as in hybrid_rl.types.

Parts do not inherit from them: a class that has these methods and fields is a part.
"""

from typing import Annotated, Literal, Protocol

from jax import Array

from hybrid_rl.fields import has
from hybrid_rl.protocols.beliefs import Belief as Belief
from hybrid_rl.protocols.beliefs import InformedBelief as InformedBelief
from hybrid_rl.protocols.contract import gives
from hybrid_rl.types import Batch, EnvState, Params, PyTree, Return, Room, Spec, Step, Transition


class Env(Protocol):
    """An environment. Frozen and hashable; everything that changes is in EnvState."""

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""

    @gives("key -> env")
    def reset(self, key: Array) -> EnvState:
        """The first state of an episode."""

    @gives("env, action [m] -> env")
    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [m] in [-1, 1]."""


class BalancedEnv(Env, Protocol):
    """An environment that stays at its equilibrium under a constant action."""

    @gives("-> obs [o], action [m]")
    def equilibrium(self) -> tuple[Array, Array]:
        """The observation [o] and the action [m] at rest."""


class Goal(Protocol):
    """A reward that is a known function of observations and action.

    One with jumps may have `smoothed`, with the same arguments, which planners maximise instead:
    some take gradients.
    """

    @gives("x [o], u [m], after [o] -> reward []")
    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [m] at the observation x [o], which led to `after` [o]."""


class Constraint(Protocol):
    """A limit on decisions, a known function of observations and action."""

    @property
    def price(self) -> float:
        """What a violated decision costs, for learners and planners."""

    @property
    def chance(self) -> float | None:
        """A planner's largest probability of a violation in one decision; None: any."""

    @property
    def width(self) -> float:
        """The width of the smooth indicator sigmoid(excess / width), in the unit of `excess`."""

    @gives("x [o], u [m], after [o] -> excess []")
    def excess(self, x: Array, u: Array, after: Array) -> Array:
        """How far [] action u [m] at x [n], which led to `after` [n], is beyond the limit.

        Above 0: violated; in the unit of what is limited. The first entries of x and of `after` are
        the observation.
        """


class MeasuredEnv(Env, Protocol):
    """An environment whose observation has quantities with a name and a unit."""

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Name -> value [] or [k] at obs [o], such as the speed [m/s] of a robot."""


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


# of fields: what a part needs of the environment, which `python -m hybrid_rl.list` shows
Analytic = Annotated[AnalyticEnv, has("dynamics", "needs an analytic environment")]
Balanced = Annotated[BalancedEnv, has("equilibrium", "needs an environment with an equilibrium")]
Rewarded = Annotated[Goal, has("reward_of", "needs an environment with a known reward")]
Measured = Annotated[MeasuredEnv, has("quantities", "needs an environment with `quantities`")]


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
    labelled states x [n] it gets as `params.labels.evidence`. One that scores paths has
    `along(params, path)`, the value [] of measurements on a path [T, v].
    """

    @gives("Params, s [v] -> log_density []")
    def log_density(self, params: Params, s: Array) -> Array:
        """log p(s) [] at s [v], up to a constant."""


class Proposal(Protocol):
    """The distribution from which a sampling planner draws its candidates.

    A mixture has `split(quantiles [K])` alone: its proposals, each with those of its candidates.
    """

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


class Features(Protocol):
    """z(o): the functions of an observation in which a model is linear."""

    @gives("key, spec -> params")
    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial parameters, with "weights" as an entry if they are learned."""

    @gives("params, obs [o] -> z [z]")
    def __call__(self, params: PyTree, obs: Array) -> Array:
        """z [n] of an observation [o]."""


class Model(Protocol):
    """x' = f(x, u)."""

    @gives("key, spec -> params")
    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial parameters."""

    @gives("params, obs [o] -> x [x]")
    def lift(self, params: PyTree, obs: Array) -> Array:
        """The planning state x [n] of an observation [o].

        Parts that read observations in planning states need x[:o] to be the observation.
        """

    @gives("params, x, u [m] -> x")
    def step(self, params: PyTree, x: Array, u: Array) -> Array:
        """Mean of the next planning state [n]."""


class Trainable(Model, Protocol):
    """A model that learns by gradients of its "weights", an entry of its parameters."""

    members: int  # models in an ensemble, each with a batch of its own

    @gives("key, spec -> params", "weights")
    def init(self, key: Array, spec: Spec) -> dict[str, PyTree]:
        """Initial parameters."""

    def observe(self, params: PyTree, obs: Array, next_obs: Array) -> PyTree:
        """Parameters with statistics updated by observations [B, o] and their successors."""

    def loss(self, params: PyTree, obs: Array, action: Array, next_obs: Array, key: Array) -> Array:
        """Mean loss [] of transitions [members * B, ...]. The key is consumed."""

    def draw(self, params: PyTree, x: Array, u: Array, noise: Array, key: Array) -> Array:
        """Samples of the next planning states [B, n], for noise [B, n] ~ N(0, I)."""


class Uncertain(Model, Protocol):
    """A model with a predictive standard deviation."""

    def std(self, params: PyTree, x: Array) -> Array:
        """Standard deviation [n] of the change at x [n], in running standard deviations."""


class LinearModel(Uncertain, Protocol):
    """x' = K s(x, u), linear in its parameters.

    Parameters: "K" [n, r], and "spread" W [r, r], with W W' the covariance of each row of K in
    units of the noise's variance.
    """

    @gives("key, spec -> params", "K", "spread")
    def init(self, key: Array, spec: Spec) -> dict[str, PyTree]:
        """Initial parameters."""

    def regressors(self, params: PyTree, x: Array, u: Array) -> Array:
        """s [r] at x [n] and u [m]."""


class Policy(Protocol):
    """u = pi(x), stochastic."""

    @gives("key, spec -> params")
    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial parameters, for planning states of size spec.n."""

    @gives("params, x [n] -> action [m]")
    def mean(self, params: PyTree, x: Array) -> Array:
        """The action [m] without noise."""

    @gives("params, x [n], noise [m] -> action [m], log_prob []")
    def sample(self, params: PyTree, x: Array, noise: Array) -> tuple[Array, Array]:
        """The action [m] for noise [m] ~ N(0, I), and its log-density []."""

    @gives("params, x [n] -> variance [m]")
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

    def room(self) -> Room | None:
        """The largest safe corrections of its action; None: any, as the world is stable."""


class Critic(Protocol):
    """Q(x, u), an ensemble."""

    @gives("key, spec -> params")
    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial parameters, for planning states of size spec.n."""

    def observe(self, params: PyTree, x: Array, returns: Array) -> PyTree:
        """Parameters with statistics updated by states x [B, n] and reward / (1 - discount) [B]."""

    def all(self, params: PyTree, x: Array, u: Array) -> Array:
        """Q [members, ...] at x [..., n] and u [..., m]."""

    @gives("params, x [n], u [m] -> Q []")
    def value(self, params: PyTree, x: Array, u: Array) -> Array:
        """Q [...], reduced over the members."""


class Reward(Protocol):
    """r(x, u, x'), learned or known."""

    @gives("Params, x [n], u [m], after [n] -> reward [], logit []")
    def outcome(self, params: Params, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """The reward [] of u [m] at x [n], and the logit [] of the episode ending there.

        after: [n] the next planning state, real or imagined.
        """


class Demonstrations(Protocol):
    """An expert's decisions."""

    def load(self) -> Transition:
        """All of them [N, ...], in order."""


class Schedule(Protocol):
    """How learning rates change along a run."""

    def factor(self, decisions: Array) -> Array:
        """The factor [] of the learning rates, so many decisions [] into the run."""


class Learner(Protocol):
    """Data -> parameters.

    A `uniform` learner, UniformLearner, learns from batches of the memory. A `latest` one takes
    each decision once, with its true next observation: its updates get the transitions [E] of the
    step that just ended, without delay, from the first decision of the run on, random ones
    included. It has `every`: decisions of each environment between two updates; 1 uses them all.
    """

    owns: tuple[str, ...]  # fields of `Params` that it learns; that of "model" has a field `model`
    data: Literal["uniform", "latest"]

    @gives("key, spec -> state")
    def init(self, key: Array, spec: Spec) -> PyTree:
        """Initial state: parameters, optimisers, targets."""

    @gives("state -> owned")
    def params(self, state: PyTree) -> dict[str, PyTree]:
        """The fields of `Params` that this learner owns."""

    @gives("state, Params, batch, key -> state, metrics")
    def update(
        self, state: PyTree, params: Params, batch: Batch, key: Array
    ) -> tuple[PyTree, dict[str, Array]]:
        """The next state, and metrics name -> []; `params` of all learners before the update."""


class UniformLearner(Learner, Protocol):
    """A learner whose updates get batches [batches * batch_size] of the replay memory.

    `obs` and `next_obs` are planning states [B, n] if a model is learned by another learner, and
    `init` gets their size; the agent lifts them.
    """

    batch_size: int  # transitions of a batch
    batches: int  # batches of one update, concatenated
    updates: float  # per decision
    during_random: bool  # whether it also learns while decisions are random
