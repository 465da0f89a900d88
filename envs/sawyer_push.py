"""Sawyer pushes a block to a target on a table.

    r = -5 |b - t| - 10 |e - b| - 0.01 |a|^2;   ends with success: |b - t| < 0.05 m

e, b, t: rod's tip, block, target in the plane of the table [m]; o = scale (b - e, b - t) [4];
a: velocity of the tip along x and y, as fractions of 0.15 m/s. What is sent is low-passed,
v <- 0.8 v + 0.2 a, and does not leave the workspace; height and orientation of the rod are
held. A decision is 0.1 s: 20 steps. Joint velocities follow by damped least squares, once a
decision, as near as that allows to those that return to the first posture. The block starts in
a disc, turned a little; the target lies in a box, away from the block.

Source: thesis, section 3.4 and Appendix B, whose rewards are the author's own in metres
(HybridLearning, experiments/sawyer_pusher.py: state, rate, filter, workspace, success). Where
block and target start is ours.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import Chain, damped, hold, within
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, check
from hybrid_rl.types import EnvState, Spec

ASSET = "sawyer_push.xml"
SCENE = "sawyer_push_scene.xml"
STEPS = 20  # of physics per decision
DT = 0.1  # [s] of a decision
HOME = (-0.2353359, -0.4019111, 0.0032168, 1.7513965, -0.0631270, 0.1595469, 1.5656103)  # [rad]
HEIGHT = -0.154  # [m] of the block's centre
TRIES = 32  # draws until block and target keep their distances
CLEAR = 0.06  # [m] between the rod and the block's centre at the start
TIP = Chain(ASSET, "tip")


@dataclass(frozen=True)
class SawyerPush:
    """Pushes; `physics` is native, mjx, warp or auto."""

    physics: str = "auto"
    state_scale: float = 10.0  # of the observation [1/m]
    speed: float = 0.15  # [m/s] of the rod at a = 1
    smoothing: float = 0.8  # share of the last command that is kept; 0: no filter
    low: tuple[float, ...] = (0.35, -0.3)  # [m] workspace of the tip: least x, y
    high: tuple[float, ...] = (0.75, 0.3)  # [m] greatest x, y
    success_distance: float = 0.05  # [m] between block and target
    terminate: bool = True  # with success
    block: tuple[float, ...] = (0.56, 0.12)  # [m] middle of its starts
    block_spread: float = 0.08  # [m] radius of its starts
    block_turn: float = 0.2  # [rad] greatest
    target_low: tuple[float, ...] = (0.5, -0.2)  # [m]
    target_high: tuple[float, ...] = (0.7, 0.2)  # [m]
    target_clear: float = 0.12  # [m] least distance from the block at the start
    hold: float = 5.0  # [1/s] gain on height and orientation
    posture: float = 0.5  # [1/s] gain on the first posture
    damping: float = 0.02  # of the least squares [m, 1]

    def __post_init__(self) -> None:
        check(self.physics)
        for name in ("low", "high", "block", "target_low", "target_high"):
            pair = tuple(getattr(self, name))
            if len(pair) != 2:
                raise ValueError(f"{name}={list(pair)}: must be two numbers, x and y")
            object.__setattr__(self, name, pair)
        if not 0 <= self.smoothing < 1:
            raise ValueError(f"smoothing={self.smoothing}: must be in [0, 1)")

    @property
    def spec(self) -> Spec:
        """Sizes and rate."""
        return Spec(obs=4, act=2, dt=DT)

    @property
    def _body(self) -> Physics:
        return Physics(ASSET, self.physics)

    def reset(self, key: Array) -> EnvState:
        """A first state, drawn with `key`."""
        key_block, key_turn, key_target = jax.random.split(key, 3)
        home = jnp.asarray(HOME, jnp.float32)
        tip = jnp.asarray(TIP.at(HOME)[0][:2])
        block = jnp.asarray(self.block, jnp.float32)[None] + self.block_spread * _disc(key_block)
        block = _first_far(block, tip[None], CLEAR)
        turn = jax.random.uniform(key_turn, (), jnp.float32, -self.block_turn, self.block_turn)
        low, high = (jnp.asarray(b, jnp.float32) for b in (self.target_low, self.target_high))
        target = jax.random.uniform(key_target, (TRIES, 2), jnp.float32, low, high)
        target = _first_far(target, block[None], self.target_clear)
        upright = jnp.stack((jnp.cos(turn / 2), jnp.float32(0), jnp.float32(0), jnp.sin(turn / 2)))
        qpos = jnp.concatenate((home, block, jnp.float32(HEIGHT)[None], upright))
        data = self._body.reset(qpos, jnp.zeros(13, jnp.float32))
        info = {"target": target, "velocity": jnp.zeros(2, jnp.float32)}
        state = self._state(data, jnp.zeros(2, jnp.float32), info)
        return state.replace(reward=jnp.float32(0.0), terminated=jnp.zeros((), bool))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [2] in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        kept = self.smoothing
        velocity = kept * state.info["velocity"] + (1 - kept) * self.speed * action
        data = self._body.step(state.data, self.servo(state.data, velocity), STEPS)
        return self._state(data, action, {**state.info, "velocity": velocity})

    def servo(self, data: PhysicsState, velocity: Array) -> Array:
        """Joint velocities [7] [rad/s] that move the tip by `velocity` [2] [m/s]."""
        home, upright = TIP.at(HOME)
        tip, rotation, jacobian = TIP.pose(data.qpos)
        low, high = (jnp.asarray(b, jnp.float32) for b in (self.low, self.high))
        planar = within(velocity, tip[:2], low, high)
        rise = self.hold * (home[2:] - tip[2:])
        twist = jnp.concatenate((planar, rise, hold(rotation, jnp.asarray(upright), self.hold)))
        back = self.posture * (jnp.asarray(HOME, jnp.float32) - data.qpos[:7])
        return damped(jacobian, twist, self.damping, back)

    def scene(self) -> str:
        """MJCF text of the world as it is drawn."""
        return mjcf.text(SCENE)

    def pose(self, state: EnvState) -> Array:
        """Positions qpos [16] of the drawn world: of arm and block, and of the target."""
        return jnp.concatenate((state.data.qpos, state.info["target"]))

    def _state(self, data: PhysicsState, action: Array, info: dict[str, Array]) -> EnvState:
        tip, block = TIP.pose(data.qpos)[0][:2], data.qpos[7:9]
        reach, left = block - tip, block - info["target"]
        distance = jnp.sqrt((left**2).sum())
        reward = -5 * distance - 10 * jnp.sqrt((reach**2).sum()) - 0.01 * (action**2).sum()
        success = distance < self.success_distance
        obs = self.state_scale * jnp.concatenate((reach, left))
        metrics = {"success": success.astype(jnp.float32), "distance": distance}
        no = jnp.zeros((), bool)
        return EnvState(data, obs, reward, success & self.terminate, no, metrics, info)


def _disc(key: Array) -> Array:
    """[TRIES, 2] points, evenly in the unit disc."""
    angle, area = jax.random.uniform(key, (2, TRIES), jnp.float32)
    way = jnp.stack((jnp.cos(2 * jnp.pi * angle), jnp.sin(2 * jnp.pi * angle)), 1)
    return jnp.sqrt(area)[:, None] * way


def _first_far(points: Array, other: Array, distance: float) -> Array:
    """[2] the first of `points` [TRIES, 2] farther than this from `other` [1, 2]."""
    away = jnp.sqrt(((points - other) ** 2).sum(1))
    return points[jnp.minimum(away, distance).argmax()]  # the farthest, where none is
