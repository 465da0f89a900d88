"""Sawyer pushes a block to a target on a table.

    thesis  r = -5 |b - t| - 10 |e - b| - 0.01 |a|^2
    code    r = -1.25 |b - t| - |e - b| - 0.01 |a|^2
    success: |b - t| < 0.05 m

e, b, t: tip of the rod, block, target in the plane of the table [m]; o = scale (b - e, b - t) [4];
a: velocity of the tip along x and y, as fractions of 0.15 m/s. The command is low-pass filtered,
v <- 0.8 v + 0.2 a, and clipped at the workspace's limits; height and orientation of the rod are
held. A decision is 0.1 s, 20 physics steps. Damped least squares give the joint velocities once a
decision; the null space returns the arm to its initial posture. The block starts in a disc, with a
small rotation; the target lies in a box, at a minimum distance from the block. Terminates with
success. `extra` appends to o, each of order one:

    command  v / speed                               turn  cos 4 psi, sin 4 psi
    motion   velocity of b / speed, psi' / SPIN      tip   e in the workspace, -1 to 1

psi is the block's angle about the vertical; a square is the same after a quarter of a turn.

Source: thesis section 3.2.1 and Appendix B; state, rate, filter, workspace, success and the reward
in metres from the author's HybridLearning, experiments/sawyer_pusher.py; reward=code: weights of
his earlier code for the same robot, as we read its two distances. The initial positions of block
and target are our choice.
"""

from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.poses import rotated
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import Chain, joint_rates, stay_within
from hybrid_rl.envs.mujoco.physics import Physics, PhysicsState, Simulator
from hybrid_rl.fields import Discount, NotNegative, Positive, part
from hybrid_rl.types import EnvState, Spec

ASSET = "sawyer_push.xml"
STEPS = 20  # physics steps per decision
DT = 0.1  # [s] of a decision
HOME = (-0.2353359, -0.4019111, 0.0032168, 1.7513965, -0.0631270, 0.1595469, 1.5656103)  # [rad]
HEIGHT = -0.154  # [m] of the block's centre
TRIES = 32  # candidates from which block and target are chosen
CLEARANCE = 0.06  # [m] between the rod and the block's centre at the start
SPIN = 4.0  # [rad/s] of the block that is observed as 1: about speed over half a diagonal
Extra = Literal["command", "turn", "motion", "tip"]
EXTRA: dict[Extra, int] = {"command": 2, "turn": 2, "motion": 3, "tip": 2}  # numbers of each group
WEIGHTS = {"thesis": (5.0, 10.0), "code": (1.25, 1.0)}  # [1/m] of |b - t| and |e - b|
TIP = Chain(ASSET, "tip")


@part
class SawyerPush:
    """Sawyer pushes a block; `physics` is native, mjx, warp or auto."""

    physics: Simulator = "auto"
    reward: Literal["thesis", "code"] = "thesis"
    extra: tuple[Extra, ...] = ()  # of EXTRA, observed too
    state_scale: Positive = 10.0  # of the observation [1/m]
    speed: NotNegative = 0.15  # [m/s] of the tip at a = 1
    smoothing: Discount = 0.8  # weight of the previous command in the filter; 0: no filter
    low: tuple[float, float] = (0.35, -0.3)  # [m] lower limit of the workspace: x, y
    high: tuple[float, float] = (0.75, 0.3)  # [m] upper limit
    success_distance: Positive = 0.05  # [m] between block and target
    terminate: bool = True  # at success
    block: tuple[float, float] = (0.56, 0.12)  # [m] centre of its initial positions
    block_spread: NotNegative = 0.08  # [m] radius of its initial positions
    block_turn: NotNegative = 0.2  # [rad] largest initial rotation
    target_low: tuple[float, float] = (0.5, -0.2)  # [m]
    target_high: tuple[float, float] = (0.7, 0.2)  # [m]
    target_clear: NotNegative = 0.12  # [m] smallest initial distance from the block
    block_mass: Positive = 0.1  # [kg]
    block_friction: Positive = 0.4  # on the table and with the rod
    hold: NotNegative = 5.0  # [1/s] gain on height and orientation
    posture: NotNegative = 0.5  # [1/s] gain on the initial posture, in the null space
    damping: NotNegative = 0.02  # of the least squares, for [m] and [rad]

    def __post_init__(self) -> None:
        object.__setattr__(self, "extra", tuple(name for name in EXTRA if name in self.extra))

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        return Spec(obs=4 + sum(EXTRA[name] for name in self.extra), act=2, dt=DT)

    @property
    def _body(self) -> Physics:
        values = mjcf.friction(("rod_cube", "cube_table"), self.block_friction)
        values = {"geom.cube.mass": self.block_mass} | values
        return Physics(mjcf.changed(ASSET, values), self.physics)

    def reset(self, key: Array) -> EnvState:
        """A random initial state."""
        key_block, key_turn, key_target = jax.random.split(key, 3)
        home = jnp.asarray(HOME, jnp.float32)
        tip = jnp.asarray(TIP.constant_pose(HOME)[0][:2])
        block = jnp.asarray(self.block, jnp.float32)[None] + self.block_spread * _disc(key_block)
        block = _first_far(block, tip[None], CLEARANCE)
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
        """The state after one decision. action: [2] in [-1, 1]."""
        action = jnp.clip(action, -1.0, 1.0)
        previous, keep = state.info["velocity"], self.smoothing
        velocity = keep * previous + (1 - keep) * self.speed * action
        data = self._body.step(state.data, self.servo(state.data, velocity), STEPS)
        return self._state(data, action, {**state.info, "velocity": velocity})

    def servo(self, data: PhysicsState, velocity: Array) -> Array:
        """Joint velocities [7] [rad/s] that move the tip by `velocity` [2] [m/s]."""
        home, upright = TIP.constant_pose(HOME)
        pose, away = TIP.pose(data.qpos), jnp.asarray(HOME, jnp.float32) - data.qpos[:7]
        planar = stay_within(velocity, pose[0][:2], self.low, self.high)
        linear = jnp.concatenate((planar, self.hold * (home[2:] - pose[0][2:])))
        return joint_rates(pose, linear, jnp.asarray(upright), away, self)

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [2] that led to the observation `after` [o]; x is not used."""
        away, distance = jnp.linalg.norm(after[:4].reshape(2, 2), axis=1) / self.state_scale
        home, near = WEIGHTS[self.reward]
        return -home * distance - near * away - 0.01 * (u**2).sum()

    def ended(self, obs: Array) -> Array:
        """Whether [] an episode terminates at obs [o]."""
        near = jnp.linalg.norm(obs[2:4]) < self.success_distance * self.state_scale
        return near & self.terminate

    def heading(self, obs: Array) -> Array:
        """The direction [] [rad] of the block's side that faces the rod, at obs [o] with turn."""
        side, at = jnp.pi / 2, self._at("turn")
        turn = jnp.arctan2(obs[at + 1], obs[at]) / 4
        rod = jnp.arctan2(-obs[1], -obs[0])
        return turn + side * jnp.round((rod - turn) / side)

    def turned(self, obs: Array, angle: Array) -> Array:
        """The observation [o] of a scene turned by `angle` [rad], with `turn` as it was.

        Exact for multiples of 90 degrees: MuJoCo's pyramids of friction have the table's axes, so
        that a push also depends on the turn of the block in the world.
        """
        groups = [self._at(name) for name in ("command", "motion") if name in self.extra]
        for at in (0, 2, *groups):
            obs = obs.at[at : at + 2].set(rotated(obs[at : at + 2], angle))
        return obs

    def turned_action(self, action: Array, angle: Array) -> Array:
        """The action [2] turned by `angle` [rad]."""
        return rotated(action, angle)

    def _at(self, name: str) -> int:
        """Where the group `name` begins in the observation."""
        before = self.extra[: self.extra.index(name)]
        return 4 + sum(EXTRA[other] for other in before)

    def _extra(self, data: PhysicsState, tip: Array, velocity: Array) -> list[Array]:
        """The groups of `extra`, for the tip [2] [m] and the filtered command [2] [m/s]."""
        w, x, y, z = data.qpos[10:14]
        turn = 4 * jnp.arctan2(2 * (w * z + x * y), 1 - 2 * (y**2 + z**2))
        low, high = (jnp.asarray(b, jnp.float32) for b in (self.low, self.high))
        groups = {
            "command": velocity / self.speed,
            "turn": jnp.stack((jnp.cos(turn), jnp.sin(turn))),
            "motion": jnp.concatenate((data.qvel[7:9] / self.speed, data.qvel[12:13] / SPIN)),
            "tip": (2 * tip - low - high) / (high - low),
        }
        return [groups[name] for name in self.extra]

    def quantities(self, obs: Array) -> dict[str, Array]:
        """The block's position seen from the target, and from the rod [m] at obs [o]."""
        return {"block": obs[2:4] / self.state_scale, "reach": obs[:2] / self.state_scale}

    scene = mjcf.scene("sawyer_push_scene.xml")

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [16] for rendering: arm and block, then the target's x and y."""
        return jnp.concatenate((state.data.qpos, state.info["target"]))

    def points(self, state: EnvState, obs: Array) -> Array:
        """Positions [T+1, 2, 3] [m] of tip and block along observations [T+1, o], for drawing."""
        from_tip, from_target = jnp.moveaxis(obs[:, :4].reshape(-1, 2, 2), 1, 0) / self.state_scale
        block = state.info["target"][None] + from_target
        plane = jnp.stack((block - from_tip, block), 1)
        height = jnp.stack((TIP.pose(state.data.qpos)[0][2], state.data.qpos[9]))
        return jnp.concatenate((plane, jnp.broadcast_to(height[:, None], (len(obs), 2, 1))), 2)

    def _state(self, data: PhysicsState, action: Array, info: dict[str, Array]) -> EnvState:
        tip, block = TIP.pose(data.qpos)[0][:2], data.qpos[7:9]
        reach, left = block - tip, block - info["target"]
        distance = jnp.sqrt((left**2).sum())
        home, near = WEIGHTS[self.reward]
        away = jnp.sqrt((reach**2).sum())
        reward = -home * distance - near * away - 0.01 * (action**2).sum()
        success = distance < self.success_distance
        parts = (self.state_scale * reach, self.state_scale * left)
        obs = jnp.concatenate((*parts, *self._extra(data, tip, info["velocity"])))
        metrics = {"success": success.astype(jnp.float32), "distance": distance}
        ended = success & self.terminate
        return EnvState(data, obs, reward, ended, metrics=metrics, info=info)


def _disc(key: Array) -> Array:
    """[TRIES, 2] uniform points in the unit disc."""
    angle, area = jax.random.uniform(key, (2, TRIES), jnp.float32)
    direction = jnp.stack((jnp.cos(2 * jnp.pi * angle), jnp.sin(2 * jnp.pi * angle)), 1)
    return jnp.sqrt(area)[:, None] * direction


def _first_far(points: Array, other: Array, distance: float) -> Array:
    """The first point [2] of [TRIES, 2] farther than `distance` from `other` [1, 2].

    The farthest point if none is.
    """
    away = jnp.sqrt(((points - other) ** 2).sum(1))
    return points[jnp.minimum(away, distance).argmax()]
