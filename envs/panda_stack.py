"""Panda stacks one block on another.

    r = stage - 1e-6 (|F| + |a|);   ends with success
    stage = -1.25 |e - s| where the block is grasped, else -|e - b|

Taking the block costs: the reward falls by 1.25 |e - s|, and a planner whose horizon is short
hovers over the block. With reward=joined it does not fall: stage = -|e - b| - 1.25 |b - s| before.

e: point between the fingertips, b: block, s: where the block is to stand, one side above the
base; F: wrench at the wrist [6]. o = (e, b, c, F) [13], c = 1 where the hand was told to close;
with a base that starts anywhere (base_spread > 0) o has also s [16].
a: velocity of e along x, y, z, as fractions of 0.15 m/s, low-passed with a lag of 0.2 s and kept
in the workspace. The hand closes by itself within 1 cm of the block, and opens where the block is
within 1 cm of s, or lost; with grip=action it closes where a fourth action is positive. Its
orientation is held. A decision is 0.1 s: 20 steps. Joint velocities follow by damped least squares,
once a decision, as near as that allows to those that return to the first posture.

grasped: told to close, the fingers stand on the block's sides, and e is within the block.
success: block over base within 0.02 m, at its height within 0.01 m, let go, slower than
0.05 m/s.

Source: thesis, section 3.4 and Appendix B (state, action, reward: its action is a velocity alone,
and by its reward a hand that may choose would hover over the block); the pose of the start is
Franka's, the rate and workspace are those of the author's franka_interface. Lag, speed, blocks,
their starts, when the hand closes and the measure of success are ours.
"""

from dataclasses import dataclass
from math import exp, pi

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import Chain, damped, hold, within
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, check
from hybrid_rl.envs.options import one_of
from hybrid_rl.types import EnvState, Spec

ASSET = "panda_stack.xml"
STEPS = 20  # of physics per decision
DT = 0.1  # [s] of a decision
READY = (0.0, -pi / 4, 0.0, -3 * pi / 4, 0.0, pi / 2, pi / 4)  # [rad]
OPEN = 0.04  # [m] of each finger
SIDE = 0.05  # [m] of a cube
TOUCH = 0.002  # [m] between finger and the block's side, where it is grasped
LEVEL = 0.01  # [m] between the block's height and that of a stacked one
QUIET = 0.05  # [m/s] of a block that stands
TOOL = Chain(ASSET, "tool")
BLOCK, BASE = slice(9, 12), slice(16, 19)  # positions in qpos
BLOCK_SPEED = slice(9, 12)  # in qvel


@dataclass(frozen=True)
class PandaStack:
    """Stacks; `physics` is native, mjx, warp or auto."""

    physics: str = "auto"
    speed: float = 0.15  # [m/s] in each direction at a = 1
    lag: float = 0.2  # [s] of the filter; 0: none
    grip: str = "near"  # the hand closes by itself; or action
    reach: float = 0.01  # [m] within which it does
    low: tuple[float, ...] = (0.3, -0.3, 0.02)  # [m] workspace of the hand: least x, y, z
    high: tuple[float, ...] = (0.55, 0.3, 0.5)  # [m] greatest
    block: tuple[float, ...] = (0.45, -0.12)  # [m] middle of its starts
    block_spread: float = 0.05  # [m] greatest, along x and y
    block_turn: float = 0.1  # [rad] greatest
    base: tuple[float, ...] = (0.45, 0.12)  # [m]
    base_spread: float = 0.0  # [m] greatest, along x and y
    reward: str = "thesis"  # or joined
    penalty: float = 1e-6  # of wrench and action
    success_distance: float = 0.02  # [m] block over base
    terminate: bool = True  # with success
    hold: float = 5.0  # [1/s] gain on orientation
    posture: float = 0.5  # [1/s] gain on the first posture
    damping: float = 0.02  # of the least squares [m, 1]

    def __post_init__(self) -> None:
        check(self.physics)
        one_of("grip", self.grip, ("near", "action"))
        one_of("reward", self.reward, ("thesis", "joined"))
        for name, size in (("low", 3), ("high", 3), ("block", 2), ("base", 2)):
            numbers = tuple(getattr(self, name))
            if len(numbers) != size:
                raise ValueError(f"{name}={list(numbers)}: must be {size} numbers")
            object.__setattr__(self, name, numbers)
        if self.lag < 0:
            raise ValueError(f"lag={self.lag}: must be 0 or more")

    @property
    def spec(self) -> Spec:
        """Sizes and rate."""
        return Spec(
            obs=16 if self.base_spread else 13, act=4 if self.grip == "action" else 3, dt=DT
        )

    @property
    def _body(self) -> Physics:
        return Physics(ASSET, self.physics)

    def reset(self, key: Array) -> EnvState:
        """A first state, drawn with `key`."""
        key_block, key_turn, key_base = jax.random.split(key, 3)
        turn = jax.random.uniform(key_turn, (), jnp.float32, -self.block_turn, self.block_turn)
        arm = jnp.asarray((*READY, OPEN, OPEN), jnp.float32)
        block = _cube(self.block, self.block_spread, turn, key_block)
        base = _cube(self.base, self.base_spread, jnp.float32(0.0), key_base)
        data = self._body.reset(jnp.concatenate((arm, block, base)), jnp.zeros(21, jnp.float32))
        info = {"velocity": jnp.zeros(3, jnp.float32), "closed": jnp.float32(0.0)}
        state = self._state(data, jnp.zeros(self.spec.act, jnp.float32), info)
        return state.replace(reward=jnp.float32(0.0), terminated=jnp.zeros((), bool))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [3], or [4] with grip=action, in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        kept = exp(-DT / self.lag) if self.lag else 0.0
        velocity = kept * state.info["velocity"] + (1 - kept) * self.speed * action[:3]
        closed = self._closes(state, action).astype(jnp.float32) + 0 * action[-1]
        fingers = OPEN * (1 - closed)
        ctrl = jnp.concatenate((self.servo(state.data, velocity), fingers[None]))
        data = self._body.step(state.data, ctrl, STEPS)
        return self._state(data, action, {**state.info, "velocity": velocity, "closed": closed})

    def _closes(self, state: EnvState, action: Array) -> Array:
        """Whether [] the hand is told to close now."""
        if self.grip == "action":
            return action[3] > 0
        tool, block = state.obs[:3], state.obs[3:6]
        away, left = _norm(block - tool), _norm(self._goal(state.data) - block)
        kept = (away < SIDE / 2) & (left > self.reach)
        taken = (away < self.reach) & (left > SIDE / 2)
        return jnp.where(state.info["closed"] > 0, kept, taken)

    def _goal(self, data: PhysicsState) -> Array:
        """Where [3] the block is to stand."""
        return data.qpos[BASE] + jnp.asarray((0.0, 0.0, SIDE), jnp.float32)

    def servo(self, data: PhysicsState, velocity: Array) -> Array:
        """Joint velocities [7] [rad/s] that move the hand by `velocity` [3] [m/s]."""
        upright = jnp.asarray(TOOL.at(READY)[1])
        tool, rotation, jacobian = TOOL.pose(data.qpos)
        low, high = (jnp.asarray(b, jnp.float32) for b in (self.low, self.high))
        straight = within(velocity, tool, low, high)
        twist = jnp.concatenate((straight, hold(rotation, upright, self.hold)))
        back = self.posture * (jnp.asarray(READY, jnp.float32) - data.qpos[:7])
        return damped(jacobian, twist, self.damping, back)

    def scene(self) -> str:
        """MJCF text of the world as it is drawn."""
        return mjcf.text(ASSET)

    def pose(self, state: EnvState) -> Array:
        """Positions qpos [23] of the drawn world."""
        return state.data.qpos

    def _state(self, data: PhysicsState, action: Array, info: dict[str, Array]) -> EnvState:
        tool, block, goal = TOOL.pose(data.qpos)[0], data.qpos[BLOCK], self._goal(data)
        wrench = jnp.concatenate([self._body.sensor(data, s) for s in ("force", "torque")])
        closed, fingers = info["closed"], data.qpos[7:9]
        touching = jnp.abs(fingers - SIDE / 2) < TOUCH
        inside = jnp.abs(block - tool) < SIDE / 2
        grasped = (closed > 0) & touching.all() & inside.all()
        ahead = 1.25 * _norm(block - goal) if self.reward == "joined" else 0.0
        stage = jnp.where(grasped, -1.25 * _norm(tool - goal), -_norm(tool - block) - ahead)
        away = jnp.abs(block - goal)
        there = (_norm(away[:2]) < self.success_distance) & (away[2] < LEVEL)
        success = there & (closed == 0) & (_norm(data.qvel[BLOCK_SPEED]) < QUIET)
        obs = jnp.concatenate((tool, block, closed[None], wrench))
        if self.base_spread:
            obs = jnp.concatenate((obs, goal))
        metrics = {"success": success, "grasped": grasped, "distance": _norm(block - goal)}
        metrics = {name: value.astype(jnp.float32) for name, value in metrics.items()}
        reward = stage - self.penalty * (_norm(wrench) + _norm(action))
        no = jnp.zeros((), bool)
        return EnvState(data, obs, reward, success & self.terminate, no, metrics, info)


def _norm(x: Array) -> Array:
    return jnp.sqrt((x**2).sum())


def _cube(middle: tuple[float, ...], spread: float, turn: Array, key: Array) -> Array:
    """Position and quaternion [7] of a cube on the table, within `spread` of `middle`."""
    place = jax.random.uniform(key, (2,), jnp.float32, -spread, spread)
    height, zero = jnp.float32(SIDE / 2), jnp.float32(0.0)
    quat = jnp.stack((jnp.cos(turn / 2), zero, zero, jnp.sin(turn / 2)))
    return jnp.concatenate((place + jnp.asarray(middle, jnp.float32), height[None], quat))
