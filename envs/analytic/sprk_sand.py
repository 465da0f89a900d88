"""A ball robot in sand: it moves for a while, then follows a reference.

    v' = k(p) Rot(slip) c - d1 v - d2 |v| v - mu tanh(|v| / 0.02) v / |v|,   c' = (a - c) / tau
    k(p) = k (1 + variation sin(2 pi x) sin(2 pi y)),   p = (x, y) in m
    r = -(60 |e|^2 + 5 |e'|^2 + 0.1 |a|^2), after the step; e, e': errors of p and v

The reference rests at its first point for `learn` decisions; then it is

    (0.5 cos t + 1.12, 0.3 sin 2t + 0.85) [m],   t = 0 at decision `learn`,

whose position is continuous there, while its velocity jumps from 0 to (0, 0.6) m/s.
o = (x, y, x', y', reference now 4, reference one decision later 4) [12]; a: command, low-pass
filtered to c, which is not observed. With `sensor_noise` x and y have Gaussian noise, and x', y'
are the difference of noisy positions over the decision; without it they are exact. Start: at rest,
p ~ U(-start, start)^2 around the reference; a decision is 1/30 s, four Runge-Kutta steps; never
terminates; there are no walls. Metric: tracking_error = |e| [m].

Source: thesis section 7.5.1 and appendix D: rate, reference, weights of r, 20 s until the reference
moves. The thesis gives nothing about the robot and the sand: the dynamics, their parameters and the
noise are our choice, a stand-in for its experiment.
"""

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.poses import rotated
from hybrid_rl.envs import sensor_noise
from hybrid_rl.envs.analytic.state import rk4
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import Discount, Natural, NotNegative, part
from hybrid_rl.types import EnvState, Spec

DT, SUBSTEPS = 1 / 30, 4  # [s] of a decision, its Runge-Kutta steps
K, D1, D2, MU, TAU = 4.0, 1.5, 3.0, 0.6, 0.1  # [m/s^2], [1/s], [1/m], [m/s^2], [s]
CREEP = 0.02  # [m/s] at which dry friction is almost complete


class Ball(NamedTuple):
    """The physical state."""

    p: Array  # [2] position [m]
    v: Array  # [2] velocity [m/s]
    c: Array  # [2] filtered command


@part
class SprkSand:
    """A ball in sand."""

    learn: Natural = 600  # decisions before the reference moves
    sensor_noise: NotNegative = 0.003  # [m] std of each coordinate
    start: NotNegative = 0.1  # [m] largest initial distance from the reference in each direction
    slip: float = 0.15  # [rad] from the command to the force
    variation: Discount = 0.2  # of k with the position, a share

    spec = Spec(obs=12, act=2, dt=DT)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        key_start, key_noise = jax.random.split(key)
        p = jax.random.uniform(key_start, (2,), jnp.float32, -self.start, self.start)
        p, rest = self.equilibrium()[0][:2] + p, jnp.zeros(2)
        state = self._state(Ball(p, rest, rest), rest, jnp.zeros((), jnp.int32))
        state = state.replace(reward=jnp.float32(0.0))
        return sensor_noise.begin(state, self._std, key_noise)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [2] in [-1, 1]."""
        a = jnp.clip(action, -1.0, 1.0)
        ball = rk4(lambda ball: self._rate(ball, a), state.data, DT / SUBSTEPS, SUBSTEPS)
        after = self._state(ball, a, state.info["clock"] + 1)
        after = sensor_noise.resume(after, self._std, state)
        if self.sensor_noise:
            v = (after.obs[:2] - state.obs[:2]) / DT
            after = after.replace(obs=after.obs.at[2:4].set(v))
        return after

    @property
    def _std(self) -> tuple[float, ...]:
        """Standard deviation of the noise that is added to the observation [12]."""
        return (self.sensor_noise,) * 2 + (0.0,) * 10

    def _state(self, ball: Ball, a: Array, clock: Array) -> EnvState:
        """The state without noise, `clock` [] decisions after the reset."""
        now, later = self._reference(clock), self._reference(clock + 1)
        x = jnp.concatenate([ball.p, ball.v])
        e = x - now
        reward = -(60 * jnp.sum(e[:2] ** 2) + 5 * jnp.sum(e[2:] ** 2) + 0.1 * jnp.sum(a**2))
        metrics = {"tracking_error": jnp.linalg.norm(e[:2])}
        obs = jnp.concatenate([x, now, later])
        return EnvState(ball, obs, reward, metrics=metrics, info={"clock": clock})

    def _reference(self, clock: Array) -> Array:
        """Position and velocity [4], `clock` [] decisions after the reset."""
        t = DT * jnp.maximum(clock - self.learn, 0)
        x, y = 0.5 * jnp.cos(t) + 1.12, 0.3 * jnp.sin(2 * t) + 0.85
        v = jnp.stack([-0.5 * jnp.sin(t), 0.6 * jnp.cos(2 * t)])
        return jnp.concatenate([jnp.stack([x, y]), jnp.where(clock < self.learn, 0.0, v)])

    def _rate(self, ball: Ball, a: Array) -> Ball:
        """Time derivatives under the command a [2]."""
        p, v, c = ball
        k = K * (1 + self.variation * jnp.prod(jnp.sin(2 * jnp.pi * p)))
        push = k * rotated(c, jnp.float32(self.slip))
        speed = jnp.sqrt(jnp.sum(v**2) + 1e-12)
        drag = D1 + D2 * speed + MU * jnp.tanh(speed / CREEP) / speed
        return Ball(v, push - drag * v, (a - c) / TAU)

    def equilibrium(self) -> tuple[Array, Array]:
        """At rest at the first point of the reference, which rests there."""
        rest = jnp.array([1.62, 0.85, 0.0, 0.0])
        return jnp.concatenate([rest, rest, rest]), jnp.zeros(2)

    def reference(self, obs: Array) -> tuple[Array, Array]:
        """The observations [12] on the reference of `obs` [12], now and one decision later."""
        later = obs[4:]
        return jnp.concatenate([obs[4:8], later]), jnp.concatenate([obs[8:], later])

    scene = mjcf.scene("sprk_sand.xml")

    def pose(self, state: EnvState) -> Array:
        """Positions of the ball and of the reference, qpos [4], for rendering."""
        return jnp.concatenate([state.data.p, self._reference(state.info["clock"])[:2]])
