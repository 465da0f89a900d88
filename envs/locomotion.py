"""Robots that run forward: what they share, and pybullet's reward for them.

    r = alive + dx/dt - 2 mean_i |a_i w_i| - 0.1 mean_i a_i^2 - 0.1 #{i : |theta_i| > 0.99}

a: action in [-1, 1]; w: 0.1 x joint velocity; theta: joint angle scaled so that its limits are
-1 and 1; alive: +1 or -1 by the robot's own rule; x: position of the root (in pybullet the mean
over all parts).

`PlanarLegs`, hopper and walker, run in the x-z plane: qpos is x, z, pitch, joints, and

    gymnasium   r = 1[alive] + dx/dt - 0.001 |a|^2
    pybullet    r as above

o = (qpos without x, qvel); observed velocities are clipped to [-velocity_limit, velocity_limit], by
default 10 as in Gymnasium. a: torques, as fractions of full torque; start: qpos and qvel ~
U(-0.005, 0.005) around the upright pose; a decision is 4 steps of 0.002 s. Terminates when not
alive, a rule of each robot and reward.

Source: pybullet_envs, WalkerBaseBulletEnv (the thesis' reward, Appendix B); Erez, Tassa, Todorov
2011; parameters of Gymnasium.
"""

from abc import abstractmethod
from typing import ClassVar, Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.body import Body
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.fields import Positive, part
from hybrid_rl.types import EnvState, Spec


@part
class Runner(Body):
    """A robot that runs along x, from around the upright pose; its class says what is paid."""

    steps: ClassVar[int]  # physics steps per decision
    dt: ClassVar[float]  # [s] of a decision
    hidden: ClassVar[int]  # coordinates of the root that are not observed: x, or x and y
    spread: ClassVar[float] = 0.1  # [m, rad] largest distance from the upright pose at the start
    gaussian: ClassVar[bool] = False  # qvel at the start: 0.1 N(0, 1), or uniform as qpos

    @abstractmethod
    def _paid(self, data: PhysicsState, control: Array, speed: Array) -> tuple[Array, Array]:
        """The reward [] of a decision that led to `data`, and whether [] the episode ends."""

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        model = mjcf.load(self._asset)
        return Spec(obs=model.nq - self.hidden + model.nv, act=model.nu, dt=self.dt)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        key_pos, key_vel = jax.random.split(key)
        upright, size = jnp.asarray(self._body.model.qpos0, jnp.float32), (self._body.model.nv,)
        away = jax.random.uniform(key_pos, upright.shape, jnp.float32, -self.spread, self.spread)
        qvel = jax.random.uniform(key_vel, size, jnp.float32, -self.spread, self.spread)
        if self.gaussian:
            qvel = 0.1 * jax.random.normal(key_vel, size, jnp.float32)
        return self._state(self._body.reset(upright + away, qvel))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [m] in [-1, 1]."""
        control = self._control(jnp.clip(action, -1.0, 1.0))
        data = self._body.step(state.data, control, self.steps)
        speed = (self._x(data) - self._x(state.data)) / self.dt
        reward, ended = self._paid(data, control, speed)
        metrics = {"speed": speed}
        return self._state(data).replace(reward=reward, terminated=ended, metrics=metrics)

    def _state(self, data: PhysicsState) -> EnvState:
        """At the start of an episode."""
        zero = jnp.float32(0.0)
        return EnvState(data, self._obs(data), zero, metrics={"speed": zero})

    def _control(self, action: Array) -> Array:
        """Controls [m] of an action [m] in [-1, 1]."""
        return action

    def _x(self, data: PhysicsState) -> Array:
        """The position [] [m] whose speed is paid."""
        return data.qpos[0]

    def _obs(self, data: PhysicsState) -> Array:
        """The observation [o]."""
        return jnp.concatenate((data.qpos[self.hidden :], data.qvel))


def pybullet_reward(
    alive: Array,  # [] bool
    speed: Array,  # [] dx/dt [m/s]
    action: Array,  # [m] in [-1, 1]
    angle: Array,  # [m] of the actuated joints [rad]
    velocity: Array,  # [m] [rad/s]
    limits: Array,  # [m, 2] [rad]
) -> Array:
    """Reward [] of one decision."""
    middle, half = limits.mean(1), (limits[:, 1] - limits[:, 0]) / 2
    at_limit = (jnp.abs((angle - middle) / half) > 0.99).sum()
    electricity = 2.0 * jnp.abs(action * 0.1 * velocity).mean() + 0.1 * (action**2).mean()
    return jnp.where(alive, 1.0, -1.0) + speed - electricity - 0.1 * at_limit


@part
class PlanarLegs(Runner):
    """A robot by its `_asset` and `alive`; `physics` is native, mjx, warp or auto."""

    reward: Literal["gymnasium", "pybullet"] = "gymnasium"
    velocity_limit: Positive | None = 10.0  # of observed velocities [m/s, rad/s]
    steps, dt, hidden, spread = 4, 0.008, 1, 0.005

    @abstractmethod
    def alive(self, qpos: Array, qvel: Array) -> Array:
        """Whether [] an episode goes on at qpos without x [nq - 1] and qvel [nv]."""

    def _obs(self, data: PhysicsState) -> Array:
        limit = self.velocity_limit or jnp.inf
        return jnp.concatenate((data.qpos[1:], jnp.clip(data.qvel, -limit, limit)))

    def _paid(self, data: PhysicsState, control: Array, speed: Array) -> tuple[Array, Array]:
        alive = self.alive(data.qpos[1:], data.qvel)
        if self.reward == "gymnasium":
            return alive + speed - 0.001 * (control**2).sum(), ~alive
        limits = jnp.asarray(self._body.model.jnt_range[3:], jnp.float32)
        reward = pybullet_reward(alive, speed, control, data.qpos[3:], data.qvel[3:], limits)
        return reward, ~alive

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [o]."""
        joints = self._body.model.nq - 1
        return ~self.alive(obs[:joints], obs[joints:])

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Height of the torso [m], pitch [rad] and speed [m/s] at obs [o]."""
        return {"height": obs[0], "pitch": obs[1], "speed": obs[self._body.model.nq - 1]}
