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

from typing import Annotated

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
class ComputedTorque:
    """Feedback linearisation of `sawyer_torque`."""

    world: Arm
    frequency: Positive = 20.0  # [rad/s] w of the errors
    integral: NotNegative = 0.0  # [1/s] k

    def init(self, spec: Spec) -> Array:
        """z [7] = 0."""
        return jnp.zeros(spec.act)

    def act(
        self, params: Params, state: Array, obs: Array, key: Array
    ) -> tuple[Array, Array, dict[str, Array]]:
        """Action [7], the next z [7], no metrics; deterministic."""
        q, rate, q_ref, rate_ref, _, rate_next = jnp.split(obs, 6)
        error, state = _integrated(q_ref - q, state, self.integral)
        feedback = self.frequency**2 * error + 2 * self.frequency * (rate_ref - rate)
        acceleration = (rate_next - rate_ref) / DT + feedback
        model = sawyer_torque.asset(self.world.damping)
        return _action(kinematics.torques(model, q, rate, acceleration)), state, {}

    def greedy(self) -> "ComputedTorque":
        """This controller, which does not explore."""
        return self


@part
class JointPD:
    """Proportional and derivative feedback at each joint of `sawyer_torque`."""

    world: Arm
    stiffness: tuple[NotNegative, ...] = (400.0, 400.0, 200.0, 200.0, 40.0, 20.0, 10.0)  # [N m/rad]
    damping: tuple[NotNegative, ...] = (40.0, 40.0, 20.0, 20.0, 4.0, 2.0, 1.0)  # [N m s/rad]
    integral: NotNegative = 0.0  # [1/s] k

    def init(self, spec: Spec) -> Array:
        """z [7] = 0."""
        return jnp.zeros(spec.act)

    def act(
        self, params: Params, state: Array, obs: Array, key: Array
    ) -> tuple[Array, Array, dict[str, Array]]:
        """Action [7], the next z [7], no metrics; deterministic."""
        q, rate, q_ref, rate_ref, *_ = jnp.split(obs, 6)
        error, state = _integrated(q_ref - q, state, self.integral)
        stiffness, damping = jnp.array(self.stiffness), jnp.array(self.damping)
        return _action(stiffness * error + damping * (rate_ref - rate)), state, {}

    def greedy(self) -> "JointPD":
        """This controller, which does not explore."""
        return self


def _integrated(error: Array, z: Array, k: float) -> tuple[Array, Array]:
    """e + k z [7], and the next z [7], of the error e [7] [rad]."""
    z = z + DT * error
    return error + k * z, z


def _action(torques: Array) -> Array:
    """The action [7] that gives these torques [7] [N m], within their limits."""
    return jnp.clip(torques / jnp.array(LIMITS), -1.0, 1.0)
