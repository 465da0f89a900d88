"""What a controller imagines, as paths through space.

A path in a model is one of planning states. It can be drawn where the positions follow from the
observation: of a robot whose observation is (qpos without its first coordinates, qvel), the others
follow from the imagined velocities; of an analytic world, from its state. Whether an environment is
of such a kind is tried on states of it. Paths on the world itself have its states.
"""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from jax import Array

from hybrid_rl.core import lifting
from hybrid_rl.envs.mujoco.scenery import pose_of, simulated
from hybrid_rl.protocols import Controller
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import EnvState, Params, Path

MOST = 64  # paths that are drawn
AHEAD = 20  # decisions of a policy
NEAR = 1e-3  # of positions that a reading gets right

Reading = Callable[[EnvState, Any], Array]  # state, path x [T+1, ...] -> qpos [T+1, nq]


def reading(episode: Episode) -> Reading | None:
    """The first kind of reading that fits; None: its imagined states cannot be drawn."""
    env, pose = episode.env, pose_of(episode.env)

    def stepped(state: EnvState, key: Array) -> tuple[EnvState, EnvState]:
        action = jax.random.uniform(key, (env.spec.act,), minval=-1, maxval=1)
        return (env.step(state, action),) * 2

    first, key = jax.jit(env.reset)(jax.random.key(0)), jax.random.split(jax.random.key(1), 3)
    scan = jax.jit(lambda first, key: jax.lax.scan(stepped, first, key)[1])
    states = scan(first, key)
    for make in (_of_robot, _of_data, _of_local):
        read = make(episode, first)
        if read is None:
            continue
        fits = jax.vmap(lambda state, read=read: read(state, state.obs[None])[0] - pose(state))
        if jax.eval_shape(lambda s: pose(s), first).shape == fits(states).shape[1:] and bool(
            (jnp.abs(fits(states)) < NEAR).all()
        ):
            return read
    return None


def _of_robot(episode: Episode, state: EnvState) -> Reading | None:
    """Of a robot of MuJoCo whose observation is (qpos without the first h coordinates, qvel)."""
    found, spec = simulated(state), episode.spec
    if len(found) != 1:
        return None
    q, v = found[0].qpos.size, found[0].qvel.size
    hidden = q + v - spec.obs
    if not 0 <= hidden <= min(3, v) or not jnp.allclose(state.obs[q - hidden :], found[0].qvel):
        return None

    def read(state: EnvState, x: Array) -> Array:
        speed = x[:, q - hidden : q]
        moved = spec.dt * jnp.cumsum((speed[1:] + speed[:-1]) / 2, 0)
        start = simulated(state)[0].qpos[:hidden]
        along = start[None] + jnp.concatenate([jnp.zeros((1, hidden)), moved])
        return jnp.concatenate([along, x[:, : q - hidden]], 1)

    return read


def _of_data(episode: Episode, state: EnvState) -> Reading | None:
    """Of a world whose state is its observation."""
    data = state.data
    if not isinstance(data, jax.Array) or data.shape != state.obs.shape:
        return None
    return _of_state(episode.env, lambda obs: obs)


def _of_local(episode: Episode, state: EnvState) -> Reading | None:
    """Of an analytic world whose state is in local coordinates."""
    env: Any = episode.env
    if not hasattr(env, "to_local") or not isinstance(state.data, jax.Array):
        return None
    shape = jax.eval_shape(env.to_local, state.obs).shape
    return _of_state(env, env.to_local) if shape == state.data.shape else None


def _of_state(env: Any, data: Callable[[Array], Array]) -> Reading:
    pose, o = pose_of(env), env.spec.obs

    def read(state: EnvState, x: Array) -> Array:
        return jax.vmap(lambda obs: pose(state.replace(data=data(obs), obs=obs)))(x[:, :o])

    return read


def poses(read: Reading | None, env: Any, state: EnvState, paths: Path) -> Array | None:
    """Positions [K, T+1, nq] along imagined paths [K, ...] from `state`; None: not to be drawn."""
    if isinstance(paths.x, EnvState):
        return jax.vmap(jax.vmap(pose_of(env)))(paths.x)
    return None if read is None else jax.vmap(lambda x: read(state, x))(paths.x)


def of_policy(episode: Episode, controllers: dict[str, Controller], mode: str) -> Any:
    """Path [1, ...] of the policy that acts in `mode`, in the run's model, from parameters and obs.

    None where there is no policy or no model.
    """
    policy: Any = getattr(controllers[mode], "policy", None)
    models = [getattr(each, "model", None) for each in controllers.values()]
    known = [model for model in models if model is not None and not hasattr(model, "start")]
    if policy is None or not known:
        return None
    model = known[0]

    def path(params: Params, obs: Array) -> Path:
        def ahead(x: Array, _: None) -> tuple[Array, tuple[Array, Array]]:
            u = policy.mean(params.policy, x)
            after = model.step(params.model, x, u)
            return after, (after, u)

        x = lifting.lift(model, params.model, obs)
        _, (xs, us) = jax.lax.scan(ahead, x, length=AHEAD)
        return Path(jnp.concatenate([x[None], xs])[None], us[None])

    return path


def point_of(model: mujoco.MjModel) -> tuple[int, float]:
    """The body whose path is drawn, and the reach of the point: see `track`.

    It is the middle of a torso that moves freely, else the end of an arm's last body.
    """
    moving = np.flatnonzero(model.body_weldid > 0)
    if not len(moving):
        return 0, 1.0
    joint = model.body_jntadr[moving[0]]
    hinged = joint >= 0 and model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE
    return (int(moving[-1]), 2.0) if hinged else (int(moving[0]), 1.0)


def track(model: mujoco.MjModel, poses: np.ndarray, body: int, reach: float = 1.0) -> np.ndarray:
    """The positions [K, T, 3] [m] of a point of `body` at poses [K, T, nq].

    reach: from the body's origin, where its joint is, in distances to its centre of mass; 2 is the
    end of a rod.
    """
    data, points = mujoco.MjData(model), np.empty((*poses.shape[:2], 3), np.float32)
    for k, t in np.ndindex(*poses.shape[:2]):
        data.qpos[:] = poses[k, t]
        mujoco.mj_kinematics(model, data)
        points[k, t] = data.xpos[body] + reach * (data.xipos[body] - data.xpos[body])
    return points
