"""Reach: the tip of an arm of any MJCF file comes to a pose, smoothly.

    r = 1 - tanh(5 |p* - p|) + (1 - tanh |e|) / 2 - |a - a'|^2 / 100

p, p* [m]: the tip and where it should be; e: rotation vector to the rotation that it should have;
a: action, by which the targets u of the servos move, 0.05 rad a decision at 1, within their ranges;
a': the one before. o = (q - q*, q' / 10, u - q, p* - p, e, a) [4m + 6]; q*: home, where it starts.
The pose is one of the tip with each joint within 1 rad of home; of slides read m for rad. A
decision is 0.02 s; never terminates. success: |p* - p| < 2 cm, |e| < 0.1.

The tip is a site of the file. Without one that is named, it is on the last body that the last servo
of a hinge turns (none turns: that a servo moves): its only site, else the frame of a hand that is
fixed to the link, else the far end of the link. Servos after the last one that moves the tip, of a
gripper, stay at home. So an arm whose last joint is a slide needs a site on what that joint moves.
"""

from functools import cache

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.body import Body
from hybrid_rl.envs.mujoco.kinematics import Chain, inverse, links, quat_multiply, rotation_vector
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.envs.mujoco.simplified import JOINT, TIMESTEP, located, servos, simplified
from hybrid_rl.errors import UsageError
from hybrid_rl.fields import part
from hybrid_rl.types import EnvState, Spec

STEPS = 5  # physics steps per decision
STRIDE = 0.05  # [rad] of a servo's target in a decision
SPREAD = 1.0  # [rad] largest distance of a joint from home at the pose to reach
SPEED = 0.1  # of joints, in the observation
TIP = "tip"


@cache
def motors(asset: str, site: str) -> int:
    """The number of servos up to the last one that moves the site."""
    model, chain = mjcf.load(asset), links(asset, site).address
    moving = np.isin(model.jnt_qposadr[model.actuator_trnid[:, 0]], chain)
    if not (last := np.flatnonzero(moving & (model.actuator_trntype == JOINT))).size:
        raise UsageError(f"env.site={site}: no servo moves it")
    return int(last[-1]) + 1


@cache
def tipped(robot: str, site: str) -> str:
    """MJCF text of a robot that has this site; TIP is added if its file has none of this name."""
    asset = simplified(robot, free=False)
    model, spec = mjcf.load(asset), mjcf.spec(asset)
    if site in (known := [each.name for each in spec.sites if each.name]):
        return asset
    if site != TIP:
        raise UsageError(f"env.site={site}: choose one of {', '.join([TIP, *known])}")
    kinds = model.jnt_type[model.actuator_trnid[:, 0]] * (model.actuator_trntype == JOINT)
    last = np.flatnonzero(kinds == kinds.max())[-1]  # slide < hinge in mjtJoint
    link = body = int(model.jnt_bodyid[model.actuator_trnid[last, 0]])
    for child in range(body + 1, model.nbody):
        if model.body_parentid[child] == body and not model.body_jntnum[child]:
            body = child
    ends = model.site_pos[model.site_bodyid == body]
    if len(ends) != 1:
        ends = faces(located(robot), body) if body == link else np.zeros((1, 3))
    spec.bodies[body].add_site(name=TIP, pos=max(ends, key=np.linalg.norm))
    spec.compile()
    return spec.to_xml()


def faces(asset: str, body: int) -> np.ndarray:
    """The origin of a body, and the middles of the sides of the boxes around its geoms [n, 3]."""
    model, turn, found = mjcf.load(asset), np.empty(9), [np.zeros((1, 3))]
    for geom in np.flatnonzero(model.geom_bodyid == body):
        mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
        centre, half = model.geom_aabb[geom].reshape(2, 3)
        both = centre + np.concatenate((np.diag(half), -np.diag(half)))
        found.append(model.geom_pos[geom] + both @ turn.reshape(3, 3).T)
    return np.concatenate(found)


@part
class Reach(Body):
    """An arm with position servos; `physics` is native, mjx, warp or auto."""

    robot: str = "panda.xml"  # a file, or a name of MuJoCo Menagerie
    site: str = TIP  # the tip, if the file has a site for it

    @property
    def spec(self) -> Spec:
        """Observation size, action size and decision interval."""
        m = motors(self._asset, self.site)
        return Spec(obs=4 * m + 6, act=m, dt=STEPS * TIMESTEP)

    @property
    def _asset(self) -> str:
        return tipped(self.robot, self.site)

    def reset(self, key: Array) -> EnvState:
        """The arm at home, and a pose to reach."""
        model, m = self._body.model, self.spec.act
        home = servos(self._asset, m)
        angles = home.home + jax.random.uniform(key, (m,), jnp.float32, -SPREAD, SPREAD)
        qpos = jnp.asarray(model.key_qpos[0], jnp.float32)
        there = qpos.at[home.qpos].set(jnp.clip(angles, home.low, home.high))
        target = jnp.concatenate(self._tip(there))
        info = {"target": target, "servos": jnp.asarray(home.home), "action": jnp.zeros(m)}
        data = self._body.reset(qpos, jnp.zeros(model.nv, jnp.float32))
        return self._state(data, info).replace(reward=jnp.float32(0.0))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision. action: [m] in [-1, 1]."""
        action, arm = jnp.clip(action, -1.0, 1.0), servos(self._asset, self.spec.act)
        u = jnp.clip(state.info["servos"] + STRIDE * action, arm.low, arm.high)
        gripper = self._body.model.key_ctrl[0, len(u) :].astype(np.float32)
        data = self._body.step(state.data, jnp.concatenate((u, gripper)), STEPS)
        after = self._state(data, state.info | {"servos": u, "action": action})
        change = ((action - state.info["action"]) ** 2).sum()
        return after.replace(reward=after.reward - change / 100)

    def scene(self) -> str:
        """MJCF text of the scene for rendering, with the pose to reach."""
        spec = mjcf.spec(self._asset)
        solid = {"mass": 1, "inertia": [1, 1, 1], "explicitinertial": True}
        body = spec.worldbody.add_body(name="target", **solid)
        body.add_freejoint()
        box, colour = mujoco.mjtGeom.mjGEOM_BOX, [0.95, 0.6, 0.15, 0.6]
        body.add_geom(type=box, size=[0.02, 0.03, 0.04], rgba=colour, contype=0, conaffinity=0)
        spec.delete(spec.keys[0])  # home, which has fewer joints
        spec.compile()
        return spec.to_xml()

    def pose(self, state: EnvState) -> Array:
        """Joint positions for rendering: the arm's, then the pose to reach [7]."""
        return jnp.concatenate((state.data.qpos, state.info["target"]))

    def _tip(self, qpos: Array) -> tuple[Array, Array]:
        """Position [3] and rotation [4] of the tip."""
        return Chain(self._asset, self.site).pose(qpos)[:2]

    def _state(self, data: PhysicsState, info: dict[str, Array]) -> EnvState:
        """State with observation and metrics; its reward lacks what a change of actions costs."""
        home, (p, r) = servos(self._asset, self.spec.act), self._tip(data.qpos)
        away = info["target"][:3] - p
        turn = rotation_vector(quat_multiply(info["target"][3:], inverse(r)))
        q, speed = data.qpos[home.qpos], SPEED * data.qvel[home.qvel]
        parts = (q - home.home, speed, info["servos"] - q, away, turn, info["action"])
        far, turned = jnp.linalg.norm(away), jnp.linalg.norm(turn)
        success = ((far < 0.02) & (turned < 0.1)).astype(jnp.float32)
        reward = 1 - jnp.tanh(5 * far) + (1 - jnp.tanh(turned)) / 2
        metrics = {"success": success, "distance": far}
        return EnvState(data, jnp.concatenate(parts), reward, metrics=metrics, info=info)
