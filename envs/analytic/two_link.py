"""Two-link arm in a horizontal plane, led to a target configuration.

    M(q) q'' + h(q, q') = u - d q',   q = (q1, q2), q2 relative to the first link
    M = [[I1 + I2 + m2 l^2 + 2 c cos q2, I2 + c cos q2], [., I2]]
    h = c sin q2 (-(2 q1' + q2') q2', q1'^2),   c = m2 l^2 / 2, I = m l^2 / 3
    r = -(10 e1^2 + q1'^2 + 20 e2^2 + q2'^2), after the step; e = q - target

o = (q1, q1', q2, q2', target 2) [6] in rad and rad/s; a: torques u, as fractions of 0.05 N m;
start: q = 0 at rest, target ~ U(-2.6, 2.6)^2 rad; a decision is 0.01 s, four Runge-Kutta steps;
never terminates; angles do not wrap and joints have no limits. The reference is the target at
rest. Metrics: distance = |e| [rad], success: |e| < 0.05 rad.

Source: thesis section 7.4 and appendix D: 100 Hz, weights of r; lengths, masses (that of the tip is
part of the second link) and torque of pybullet's Reacher, with thin rods. Friction, start and
targets are our choice: without friction random torques let the arm spin ever faster.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.state import rk4
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import NotNegative, Positive, part
from hybrid_rl.types import EnvState, Spec

DT, SUBSTEPS = 0.01, 4  # [s] of a decision, its Runge-Kutta steps
TORQUE = 0.05  # [N m] at a = 1
LENGTH = 0.1  # [m] of each link
M1, M2 = 0.0356, 0.0398  # [kg]
WEIGHTS = (10.0, 1.0, 20.0, 1.0)  # of (e1, q1', e2, q2') in the reward


@part
class TwoLink:
    """An arm of two links without gravity."""

    friction: NotNegative = 1e-4  # [N m s] d, of each joint
    reach: Positive = 2.6  # [rad] largest target of each joint
    success_distance: Positive = 0.05  # [rad]

    spec = Spec(obs=6, act=2, dt=DT)

    def reset(self, key: Array) -> EnvState:
        """At rest at q = 0, with a random target."""
        target = jax.random.uniform(key, (2,), jnp.float32, -self.reach, self.reach)
        at_rest = jnp.concatenate([jnp.zeros(4), target])
        return self._state(at_rest).replace(reward=jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [2] in [-1, 1]."""
        x = jnp.concatenate([state.data, state.info["target"]])
        return self._state(self.dynamics(x, jnp.clip(action, -1, 1)))

    def _state(self, x: Array) -> EnvState:
        """At the observation x [6]."""
        e = self.to_local(x)
        distance = jnp.linalg.norm(e[::2])
        success = (distance < self.success_distance).astype(jnp.float32)
        metrics = {"distance": distance, "success": success}
        reward = -jnp.sum(jnp.array(WEIGHTS) * e**2)
        return EnvState(x[:4], x, reward, metrics=metrics, info={"target": x[4:]})

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [6] after action u [2] at x [6], with the same target."""
        after = rk4(lambda q: self._rate(q, TORQUE * u), x[:4], DT / SUBSTEPS, SUBSTEPS)
        return jnp.concatenate([after, x[4:]])

    def _rate(self, x: Array, u: Array) -> Array:
        """Time derivative [4] of x = (q1, q1', q2, q2') [4] under the torques u [2] [N m]."""
        w1, w2 = x[1], x[3]
        coupling, i2 = 0.5 * M2 * LENGTH**2, M2 * LENGTH**2 / 3
        cos, sin = coupling * jnp.cos(x[2]), coupling * jnp.sin(x[2])
        m11, m12 = (M1 / 3 + M2) * LENGTH**2 + i2 + 2 * cos, i2 + cos
        f1 = u[0] - self.friction * w1 + sin * (2 * w1 + w2) * w2
        f2 = u[1] - self.friction * w2 - sin * w1**2
        det = m11 * i2 - m12**2
        return jnp.stack([w1, (i2 * f1 - m12 * f2) / det, w2, (m11 * f2 - m12 * f1) / det])

    def equilibrium(self) -> tuple[Array, Array]:
        """At rest at q = 0, which is the target."""
        return jnp.zeros(6), jnp.zeros(2)

    def reference(self, obs: Array) -> tuple[Array, Array]:
        """The observation [6] at rest at the target of `obs` [6], now and one decision later."""
        at_target = jnp.concatenate([jnp.zeros(4).at[::2].set(obs[4:]), obs[4:]])
        return at_target, at_target

    def to_local(self, x: Array) -> Array:
        """(e1, q1', e2, q2') [4] of the observation x [6]; e = q - target."""
        return x[:4].at[::2].add(-x[4:])

    def from_local(self, e: Array) -> Array:
        """The observation [6] at local coordinates e [4], with target 0."""
        return jnp.concatenate([e, jnp.zeros(2)])

    scene = mjcf.scene("two_link.xml")

    def pose(self, state: EnvState) -> Array:
        """Joint angles of the arm and of the target, qpos [4], for rendering."""
        return jnp.concatenate([state.data[::2], state.info["target"]])
