"""Protocols of environments, and of the abilities that some methods need of one."""

from typing import Annotated, Protocol

from jax import Array

from hybrid_rl.fields import has
from hybrid_rl.protocols.contract import gives
from hybrid_rl.types import EnvState, Spec


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
