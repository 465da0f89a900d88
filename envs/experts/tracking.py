"""Controllers of Sawyer by joint torques; they learn nothing.

    computed torque   tau = M(q) (q''_ref + w^2 (e + k z) + 2 w e') + C(q, q') q' + B q'
    joint PD          tau = P (e + k z) + D e'
    e = q_ref - q,   z' = e,   q''_ref = (q'_ref next - q'_ref now) / dt

Computed torque uses the arm's true model, damping included, but without payload. The arm itself
compensates gravity. M, C, B: its inertia, Coriolis terms and joint damping; w, k: `frequency` and
`integral`; P, D: `stiffness` and `damping` of the controller. The gains are our choice; k = 0, the
default, is no integral. With the exact model the loop of computed torque is stable for k < 2 w.

Source: Siciliano et al. 2009, "Robotics", section 8.5 (inverse dynamics control, PD control).
"""

from abc import ABC, abstractmethod
from dataclasses import KW_ONLY
from typing import Annotated, Self

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs import sawyer_torque
from hybrid_rl.envs.mujoco import kinematics
from hybrid_rl.envs.sawyer_torque import DT, LIMITS, SawyerTorque
from hybrid_rl.fields import Must, NotNegative, Positive, part
from hybrid_rl.types import Params, Spec

IS_ARM = Must(lambda world: isinstance(world, SawyerTorque), "be that of task=sawyer_torque")
Arm = Annotated[SawyerTorque, IS_ARM]


@part
class Feedback(ABC):
    """What both share: the errors of `sawyer_torque` and their integral."""

    world: Arm
    _: KW_ONLY
    integral: NotNegative = 0.0  # [1/s] k

    @abstractmethod
    def torques(self, q: Array, rate: Array, e: Array, e_rate: Array, ahead: Array) -> Array:
        """Torques [7] [N m] at q and q' [7], for e + k z, e' and q''_ref [7]."""

    def init(self, spec: Spec) -> Array:
        """z [7] = 0."""
        return jnp.zeros(spec.act)

    def act(
        self, params: Params, state: Array, obs: Array, key: Array
    ) -> tuple[Array, Array, dict[str, Array]]:
        """Action [7], within its limits, the next z [7], no metrics; deterministic."""
        q, rate, q_ref, rate_ref, _, rate_next = jnp.split(obs, 6)
        e = q_ref - q
        z, ahead = state + DT * e, (rate_next - rate_ref) / DT
        torques = self.torques(q, rate, e + self.integral * z, rate_ref - rate, ahead)
        return jnp.clip(torques / jnp.array(LIMITS), -1.0, 1.0), z, {}

    def greedy(self) -> Self:
        """This controller, which does not explore."""
        return self


@part
class ComputedTorque(Feedback):
    """Feedback linearisation of `sawyer_torque`."""

    frequency: Positive = 20.0  # [rad/s] w of the errors

    def torques(self, q: Array, rate: Array, e: Array, e_rate: Array, ahead: Array) -> Array:
        """Of the model, for the reference's acceleration and that by which the errors vanish."""
        acceleration = ahead + (self.frequency**2 * e + 2 * self.frequency * e_rate)
        return kinematics.torques(sawyer_torque.asset(self.world.damping), q, rate, acceleration)


@part
class JointPD(Feedback):
    """Proportional and derivative feedback at each joint of `sawyer_torque`."""

    stiffness: tuple[NotNegative, ...] = (400.0, 400.0, 200.0, 200.0, 40.0, 20.0, 10.0)  # [N m/rad]
    damping: tuple[NotNegative, ...] = (40.0, 40.0, 20.0, 20.0, 4.0, 2.0, 1.0)  # [N m s/rad]

    def torques(self, q: Array, rate: Array, e: Array, e_rate: Array, ahead: Array) -> Array:
        """Of springs and dampers."""
        return jnp.array(self.stiffness) * e + jnp.array(self.damping) * e_rate
