"""Legs: a robot of any MJCF file walks by command, upright and smoothly.

    r = max(0, e^(-4 |v_xy - c_xy|^2) + e^(-4 (w_z - c_z)^2) / 2 + e^(-|q - q*|^2 / 4) / 2
        - v_z^2 / 2 - |w_xy|^2 / 20 - 5 |g_xy|^2 - |a - a'|^2 / 20 - P / (10 m g))
    P = sum_i |tau_i q_i'|

c: the command, forwards, to the left [m/s] and to turn [rad/s]; v, w: velocity and angular velocity
of the base, in its frame; g: the direction of gravity there; q, q*: angles of the motors' joints
now and at home; a: action, the target of each servo, (q - q*) / 0.5 rad; a': the one before; tau:
torques of the servos [N m]; m g: weight. o = (v, w, g, q - q*, q' / 10, a, c) [12 + 3m].

An episode has four commands, each for 5 s, and then the first again; each entry of one is
uniform within `command`, or with probability 1/2 zero. Start: home, in any direction, pushed at up
to 0.5 m/s and rad/s; a decision is 0.02 s. An episode terminates when the base tilts by more than
60 degrees, or sinks below half of its height at home.

Source: the reward's terms are those that MuJoCo Playground's joystick tasks share (Zakka et al.
2025); power over weight instead of torques, so that it is of one size for all robots.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.body import Body
from hybrid_rl.envs.mujoco.kinematics import from_axis_angle, inverse, quat_multiply, rotate
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.envs.mujoco.simplified import TIMESTEP, servos, simplified
from hybrid_rl.fields import NotNegative, part
from hybrid_rl.types import EnvState, Spec

STEPS = 5  # physics steps per decision
OFFSET = 0.5  # [rad] of a servo's target from home at a = 1
COMMANDS = 4  # of an episode
HOLD = 250  # decisions that each lasts
SPEED = 0.1  # of joints, in the observation
PUSH = 0.5  # [m/s, rad/s] largest of the base at the start


@part
class Legs(Body):
    """A robot with a free base and position servos; `physics` is native, mjx, warp or auto."""

    robot: str = "go1.xml"  # a file, or a name of MuJoCo Menagerie
    command: tuple[NotNegative, ...] = (1.0, 0.5, 1.0)  # largest [m/s, m/s, rad/s]

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        m = mjcf.load(self._asset).nu
        return Spec(obs=12 + 3 * m, act=m, dt=STEPS * TIMESTEP)

    @property
    def _asset(self) -> str:
        return simplified(self.robot, free=True)

    def reset(self, key: Array) -> EnvState:
        """The robot at home, turned and pushed, with a command."""
        turning, pushing, asking, keeping, starting = jax.random.split(key, 5)
        model = self._body.model
        about = jax.random.uniform(turning, (), jnp.float32, -jnp.pi, jnp.pi)
        qpos = jnp.asarray(model.key_qpos[0], jnp.float32)
        turned = quat_multiply(from_axis_angle(jnp.eye(3)[2], about), qpos[3:7])
        push = jax.random.uniform(pushing, (6,), jnp.float32, -PUSH, PUSH)
        qvel = jnp.zeros(model.nv, jnp.float32).at[:6].set(push)
        data = self._body.reset(qpos.at[3:7].set(turned), qvel)
        shape = COMMANDS, 3
        most = jnp.broadcast_to(jnp.asarray(self.command, jnp.float32), shape)
        asked = most * jax.random.uniform(asking, shape, jnp.float32, -1.0, 1.0)
        info = {"commands": asked * jax.random.bernoulli(keeping, 0.5, shape)}
        info["count"] = jax.random.randint(starting, (), 0, HOLD)
        return self._state(data, info | {"action": jnp.zeros(self.spec.act)})

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [m] in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        aim = jnp.asarray(servos(self._asset).home) + OFFSET * action
        data = self._body.step(state.data, aim, STEPS)
        count = (state.info["count"] + 1) % (HOLD * COMMANDS)
        info = state.info | {"count": count, "action": action}
        after = self._state(data, info)
        low = data.qpos[2] < 0.5 * self._body.model.key_qpos[0, 2]
        before = jnp.concatenate((state.info["action"], _command(state.info)))  # ends its obs
        reward = self.reward_of(before, action, after.obs)
        metrics = {"speed_error": jnp.linalg.norm(after.obs[:2] - before[-3:-1])}
        ended = self.ended(after.obs) | low
        return after.replace(reward=reward, terminated=ended, metrics=metrics)

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [o], as far as it is seen: by its tilt."""
        return ~(obs[8] < -0.5)

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [m] at obs x [o], which led to `after` [o]."""
        m, model = len(u), self._body.model
        command, before = x[-3:], x[-3 - m : -3]
        v, w, g, away = after[:3], after[3:6], after[6:9], after[9 : 9 + m]
        stiffness, (low, high) = model.actuator_gainprm[:, 0], model.actuator_forcerange.T
        torque = jnp.clip(stiffness.astype(jnp.float32) * (OFFSET * u - away), low, high)
        power = jnp.abs(torque * after[9 + m : 9 + 2 * m] / SPEED).sum()
        weight = float(model.body_mass.sum() * -model.opt.gravity[2])
        follows = jnp.exp(-4 * ((v[:2] - command[:2]) ** 2).sum())
        turns = jnp.exp(-4 * (w[2] - command[2]) ** 2)
        cost = v[2] ** 2 / 2 + (w[:2] ** 2).sum() / 20 + 5 * (g[:2] ** 2).sum()
        cost += ((u - before) ** 2).sum() / 20 + power / (10 * weight)
        return jnp.maximum(follows + turns / 2 + jnp.exp(-(away**2).sum() / 4) / 2 - cost, 0.0)

    def quantities(self, obs: Array) -> dict[str, Array]:
        """Velocity [m/s] and turning rate [rad/s] of the base, in its frame, at obs [o]."""
        return {"speed": obs[0], "velocity": obs[:2], "turning": obs[5]}

    @property
    def commands(self) -> dict[str, float]:
        """The entries of a command, and the largest value of each, either way."""
        return dict(zip(("forwards", "left", "turn"), self.command, strict=True))

    def commanded(self, state: EnvState, command: Array) -> EnvState:
        """`state` with one command [3] for the rest of its episode."""
        commands = jnp.broadcast_to(command, (COMMANDS, 3))
        obs = jnp.concatenate((state.obs[:-3], command))
        return state.replace(info=state.info | {"commands": commands}, obs=obs)

    def _state(self, data: PhysicsState, info: dict[str, Array]) -> EnvState:
        """At the start of an episode."""
        to_body, motors = inverse(data.qpos[3:7]), servos(self._asset)
        v, down = rotate(to_body, data.qvel[:3]), rotate(to_body, -jnp.eye(3)[2])
        joints = data.qpos[motors.qpos] - motors.home, SPEED * data.qvel[motors.qvel]
        last = info["action"], _command(info)
        obs = jnp.concatenate((v, data.qvel[3:6], down, *joints, *last))
        zero = jnp.float32(0.0)
        return EnvState(data, obs, zero, metrics={"speed_error": zero}, info=info)


def _command(info: dict[str, Array]) -> Array:
    """The command [3] at this time."""
    since = info["count"] - HOLD * jnp.arange(COMMANDS)
    return (((since >= 0) & (since < HOLD))[:, None] * info["commands"]).sum(0)
