"""Protocols of models, policies, critics, rewards and beliefs, which have parameters."""

from typing import Protocol

from jax import Array

from hybrid_rl.protocols.contract import gives
from hybrid_rl.protocols.environments import AnalyticEnv
from hybrid_rl.types import Params, PyTree, Room, Spec, Step


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

    def observe(self, params: PyTree, obs: Array, next_obs: Array) -> PyTree:
        """Parameters with statistics updated by observations [B, o] and their successors."""

    def loss(self, params: PyTree, obs: Array, action: Array, next_obs: Array) -> Array:
        """Mean loss [] of transitions [members * B, ...]."""

    def losses(self, params: PyTree, obs: Array, action: Array, next_obs: Array) -> Array:
        """Loss [members, B] of each member on each of the transitions [B, ...]."""

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

    def regressors(self, params: PyTree, x: Array, u: Array) -> Array:
        """s [r] at x [n] and u [m]."""

    def draw_model(self, params: PyTree, noise: float, key: Array) -> PyTree:
        """Parameters with K from its posterior, for a standard deviation `noise` of the data."""


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


class Belief(Protocol):
    """A distribution over an unknown function, updated recursively by measurements y at s."""

    @gives("key, spec -> state")
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


class InformedBelief(Belief, Protocol):
    """A belief that measures what a measurement would tell it."""

    def information(self, state: PyTree, s: Array) -> Array:
        """The information [] of a measurement at s [v], up to a factor."""

    def gain(self, state: PyTree, s: Array) -> Array:
        """The entropy [nat] that a measurement at s [v] is expected to remove."""

    def gain_along(self, state: PyTree, path: Array) -> Array:
        """The entropy [nat] that measurements on path [T, v] remove, if each is the likelier."""

    def informed(self, state: PyTree) -> Array:
        """[] bool: whether any measurement distinguished one region from another."""
