"""Panda stacks one block on another.

    r = stage - 1e-6 (|F| + |a|)
    thesis   stage = -1.25 |e - s| if the block is grasped, else -|e - b|
    joined   stage = -1.25 |e - s| if the block is grasped, else -|e - b| - 1.25 |b - s|

With reward=thesis the reward drops by 1.25 |e - s| at the moment of the grasp, so that a planner
with a short horizon hovers over the block; with reward=joined it does not drop.

e: point between the fingertips, b: block, s: target position of the block, one side above the base;
F: wrench at the wrist [6]. o = (e, b, c, F) [13], c = 1 while the hand is commanded to close. a:
velocity of e along x, y, z, as fractions of 0.15 m/s, low-pass filtered with a time constant of
0.2 s and clipped at the workspace's limits. With grip=near the hand closes automatically within
1 cm of the block and opens within 1 cm of s, or if it loses the block; with grip=action it closes
while a fourth action is positive. Its orientation is held. A decision is 0.1 s, 20 physics steps.
Damped least squares give the joint velocities once a decision; the null space returns the arm to
its initial posture. Terminates with success.

    observation=stage   o = (d, c, height of b) [5],   d = s - b if c = 1, else b - e

Then the hand closes by the true positions, in spite of `episode.sensor_noise`.

grasped: commanded to close, both fingers touch the block's sides, and e is inside the block.
success: block over base within 0.02 m, height within 0.01 m, released, slower than 0.05 m/s.

Source: thesis section 3.2.2 and Appendix B (state, action, reward; its action is a velocity only);
initial pose from Franka; rate and workspace from the author's franka_interface. Filter, speed,
blocks, their initial positions, automatic closing and success are our choice.
"""

from math import exp, pi
from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array
from jax.numpy.linalg import norm

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import Chain, joint_rates, stay_within
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, Simulator
from hybrid_rl.fields import NotNegative, Positive, part
from hybrid_rl.types import EnvState, Spec

ASSET = "panda_stack.xml"
STEPS = 20  # physics steps per decision
DT = 0.1  # [s] of a decision
READY = (0.0, -pi / 4, 0.0, -3 * pi / 4, 0.0, pi / 2, pi / 4)  # [rad]
OPEN = 0.04  # [m] of each finger
SIDE = 0.05  # [m] of a cube
TOUCH = 0.002  # [m] largest gap between a finger and a grasped block
LEVEL = 0.01  # [m] largest height error of a stacked block
QUIET = 0.05  # [m/s] largest speed of a stacked block
PADS = ("left_pad", "right_pad")
PAIRS = (*(f"{pad}_{cube}" for pad in PADS for cube in ("block", "base")), "block_base")
PAIRS = (*PAIRS, "block_table", "base_table")  # all contacts
TOOL = Chain(ASSET, "tool")
BLOCK, BASE = slice(9, 12), slice(16, 19)  # positions in qpos
BLOCK_SPEED = slice(9, 12)  # in qvel


@part
class PandaStack:
    """Panda stacks a block; `physics` is native, mjx, warp or auto."""

    physics: Simulator = "auto"
    speed: NotNegative = 0.15  # [m/s] in each direction at a = 1
    lag: NotNegative = 0.2  # [s] time constant of the filter; 0: no filter
    grip: Literal["near", "action"] = "near"  # closes automatically; action: by a fourth action
    reach: NotNegative = 0.01  # [m] at which it closes and opens automatically
    low: tuple[float, float, float] = (0.3, -0.3, 0.02)  # [m] lower limit of the workspace
    high: tuple[float, float, float] = (0.55, 0.3, 0.5)  # [m] upper limit
    block: tuple[float, float] = (0.45, -0.12)  # [m] centre of its initial positions
    block_spread: NotNegative = 0.05  # [m] largest offset along x and y
    block_turn: NotNegative = 0.1  # [rad] largest initial rotation
    base: tuple[float, float] = (0.45, 0.12)  # [m] its initial position
    block_mass: Positive = 0.1  # [kg] of block and base
    block_friction: Positive = 1.0  # of all contacts
    observation: Literal["thesis", "stage"] = "thesis"
    reward: Literal["thesis", "joined"] = "thesis"
    penalty: NotNegative = 1e-6  # weight of wrench and action
    success_distance: Positive = 0.02  # [m] horizontal, block to base
    terminate: bool = True  # at success
    hold: NotNegative = 5.0  # [1/s] gain on orientation
    posture: NotNegative = 0.5  # [1/s] gain on the initial posture, in the null space
    damping: NotNegative = 0.02  # of the least squares, for [m] and [rad]

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        obs = 13 if self.observation == "thesis" else 5
        return Spec(obs=obs, act=4 if self.grip == "action" else 3, dt=DT)

    @property
    def _body(self) -> Physics:
        values = {f"geom.{cube}.mass": self.block_mass for cube in ("block", "base")}
        values |= mjcf.friction(PAIRS, self.block_friction)
        return Physics(mjcf.changed(ASSET, values), self.physics)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        key_block, key_turn = jax.random.split(key)
        turn = jax.random.uniform(key_turn, (), jnp.float32, -self.block_turn, self.block_turn)
        arm = jnp.asarray((*READY, OPEN, OPEN), jnp.float32)
        spread = self.block_spread
        away = jax.random.uniform(key_block, (2,), jnp.float32, -spread, spread)
        block = _cube(away + jnp.asarray(self.block, jnp.float32), turn)
        base = _cube(jnp.asarray(self.base, jnp.float32), jnp.float32(0.0))
        data = self._body.reset(jnp.concatenate((arm, block, base)), jnp.zeros(21, jnp.float32))
        info = {"velocity": jnp.zeros(3, jnp.float32), "closed": jnp.float32(0.0)}
        state = self._state(data, jnp.zeros(self.spec.act, jnp.float32), info)
        return state.replace(reward=jnp.float32(0.0), terminated=jnp.zeros((), bool))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [3], or [4] with grip=action, in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        keep = exp(-DT / self.lag) if self.lag else 0.0
        velocity = keep * state.info["velocity"] + (1 - keep) * self.speed * action[:3]
        closed = self._closes(state, action).astype(jnp.float32) + 0 * action[-1]
        fingers = OPEN * (1 - closed)
        ctrl = jnp.concatenate((self.servo(state.data, velocity), fingers[None]))
        data = self._body.step(state.data, ctrl, STEPS)
        return self._state(data, action, {**state.info, "velocity": velocity, "closed": closed})

    def _closes(self, state: EnvState, action: Array) -> Array:
        """Whether [] the hand is commanded to close."""
        if self.grip == "action":
            return action[3] > 0
        tool, block = state.obs[:3], state.obs[3:6]
        if self.observation != "thesis":
            tool, block = TOOL.pose(state.data.qpos)[0], state.data.qpos[BLOCK]
        away, left = norm(block - tool), norm(self._goal(state.data) - block)
        stays = (away < SIDE / 2) & (left > self.reach)
        closes = (away < self.reach) & (left > SIDE / 2)
        return jnp.where(state.info["closed"] > 0, stays, closes)

    def _goal(self, data: PhysicsState) -> Array:
        """Target position [3] of the block."""
        return data.qpos[BASE] + jnp.asarray((0.0, 0.0, SIDE), jnp.float32)

    def servo(self, data: PhysicsState, velocity: Array) -> Array:
        """Joint velocities [7] [rad/s] that move the hand by `velocity` [3] [m/s]."""
        upright = jnp.asarray(TOOL.constant_pose(READY)[1])
        pose, away = TOOL.pose(data.qpos), jnp.asarray(READY, jnp.float32) - data.qpos[:7]
        linear = stay_within(velocity, pose[0], self.low, self.high)
        return joint_rates(pose, linear, upright, away, self)

    def points(self, state: EnvState, obs: Array) -> Array:
        """Positions [T+1, n, 3] [m] along observations [T+1, o] from `state`, for drawing.

        Of the hand and the block; with observation=stage of the hand alone, as if the block stood
        still while the hand is open, and were in it while it is closed.
        """
        goal, block = self._goal(state.data)[None], state.data.qpos[BLOCK][None]
        if self.observation == "thesis":
            return obs[:, :6].reshape(-1, 2, 3)
        return (jnp.where(obs[:, 3:4] > 0.5, goal, block) - obs[:, :3])[:, None]

    def _state(self, data: PhysicsState, action: Array, info: dict[str, Array]) -> EnvState:
        tool, block, goal = TOOL.pose(data.qpos)[0], data.qpos[BLOCK], self._goal(data)
        wrench = jnp.concatenate([self._body.sensor(data, s) for s in ("force", "torque")])
        closed, fingers = info["closed"], data.qpos[7:9]
        touching = jnp.abs(fingers - SIDE / 2) < TOUCH
        inside = jnp.abs(block - tool) < SIDE / 2
        grasped = (closed > 0) & touching.all() & inside.all()
        remaining = 1.25 * norm(block - goal) if self.reward == "joined" else 0.0
        stage = jnp.where(grasped, -1.25 * norm(tool - goal), -norm(tool - block) - remaining)
        error = jnp.abs(block - goal)
        placed = (norm(error[:2]) < self.success_distance) & (error[2] < LEVEL)
        success = placed & (closed == 0) & (norm(data.qvel[BLOCK_SPEED]) < QUIET)
        if self.observation == "stage":
            parts = jnp.where(closed > 0, goal - block, block - tool), closed[None], block[2:]
        else:
            parts = tool, block, closed[None], wrench
        metrics = {"success": success, "grasped": grasped, "distance": norm(block - goal)}
        metrics = {name: value.astype(jnp.float32) for name, value in metrics.items()}
        reward = stage - self.penalty * (norm(wrench) + norm(action))
        ended = success & self.terminate
        return EnvState(data, jnp.concatenate(parts), reward, ended, metrics=metrics, info=info)


def _cube(at: Array, turn: Array) -> Array:
    """Position and quaternion [7] of a cube on the table at x and y [2]."""
    height, zero = jnp.float32(SIDE / 2), jnp.float32(0.0)
    quat = jnp.stack((jnp.cos(turn / 2), zero, zero, jnp.sin(turn / 2)))
    return jnp.concatenate((at, height[None], quat))
