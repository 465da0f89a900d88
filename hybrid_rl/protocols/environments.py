"""Environments."""

from typing import Protocol

from jax import Array

from hybrid_rl.types import EnvState, Spec


class Simulator(Protocol):
    """What steps the state of an environment: the environment, or its episodes."""

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [m] in [-1, 1]."""


class Env(Protocol):
    """An environment. Frozen and hashable; everything that changes is in EnvState."""

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""

    def reset(self, key: Array) -> EnvState:
        """The first state of an episode."""

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [m] in [-1, 1]."""


class DrawnEnv(Env, Protocol):
    """An environment that can be drawn."""

    def scene(self) -> str:
        """MJCF text, for drawing."""

    def pose(self, state: EnvState) -> Array:
        """The positions qpos [nq] of `scene` at `state`."""


class BalancedEnv(Env, Protocol):
    """An environment that stays at its equilibrium under a constant action."""

    def equilibrium(self) -> tuple[Array, Array]:
        """The observation [o] and the action [m] at rest."""


class RewardedEnv(Env, Protocol):
    """An environment whose reward is a known function of observations and action."""

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [m] at the observation x [o], which led to `after` [o]."""


class EndingEnv(Env, Protocol):
    """An environment whose observation shows where it terminates."""

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [o]."""


class TurningEnv(Env, Protocol):
    """An environment whose dynamics are the same in several horizontal directions.

    R(a) turns a scene by the angle a [rad] about the vertical.
    """

    def heading(self, obs: Array) -> Array:
        """The direction [] [rad] of an object at obs [o]; R(a) adds a to it."""

    def turned(self, obs: Array, angle: Array) -> Array:
        """R(angle) obs [o]; entries that the dynamics depend on in the world may stay."""

    def turned_action(self, action: Array, angle: Array) -> Array:
        """R(angle) action [m]."""


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


class ContactEnv(Env, Protocol):
    """An environment on a plane in which a round robot touches objects."""

    radius: float  # [m] of the robot
    low: tuple[float, ...]  # [m] of the plane
    high: tuple[float, ...]

    def distance(self, s: Array) -> Array:
        """Signed distance [] [m] of s [2] to the nearest object, at rest where they are listed."""
