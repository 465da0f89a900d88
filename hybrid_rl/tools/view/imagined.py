"""What a controller imagines, as paths through space.

A path in a model is one of planning states. It can be drawn where the positions follow from the
observation: by the method `points` of an environment; of a robot of which each coordinate is
observed, itself or as sine and cosine, or at least its velocity; of an analytic world, from its
state. Whether an environment is of one of the latter kinds is tried on states of it. Paths on the
world itself have its states.
"""

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from jax import Array

from hybrid_rl import Episode, lifting, scenery
from hybrid_rl.protocols import Controller
from hybrid_rl.types import EnvState, Params, Path

MOST = 64  # paths that are drawn
AHEAD = 20  # decisions of a policy
PLANAR = 3  # degrees of freedom of a torso at least
NEAR = 1e-4  # of positions that a reading gets right
TRIED = 20  # decisions of random actions on which it is tried

# state, path x [T+1, ...] -> qpos [T+1, nq] that is drawn, or [T+1, n, 3] of n points [m]
Reading = Callable[[EnvState, Any], Array]


def reading(episode: Episode) -> Reading | None:
    """The first kind of reading that fits; None: its imagined states cannot be drawn."""
    env, pose = episode.env, scenery.pose_of(episode.env)
    if hasattr(env, "points"):
        points: Any = env
        return lambda state, x: points.points(state, x[:, : env.spec.obs])

    def stepped(state: EnvState, key: Array) -> tuple[EnvState, EnvState]:
        action = jax.random.uniform(key, (env.spec.act,), minval=-1, maxval=1)
        return (env.step(state, action),) * 2

    first, key = jax.jit(env.reset)(jax.random.key(0)), jax.random.split(jax.random.key(1), TRIED)
    scan = jax.jit(lambda first, key: jax.lax.scan(stepped, first, key)[1])
    states = scan(first, key)
    for make in (_of_robot, _of_data, _of_local):
        read = make(episode, states)
        if read is None:
            continue
        found = jax.vmap(lambda state, read=read: read(state, state.obs[None])[0])(states)
        drawn = jax.vmap(pose)(states)
        if found.shape == drawn.shape and bool((jnp.abs(_turn(found - drawn)) < NEAR).all()):
            return read
    return None


def _of_robot(episode: Episode, states: EnvState) -> Reading | None:
    """The reading of a robot of MuJoCo.

    Each of its positions is observed, or moves as an observed speed. What is drawn beside it, such
    as a target, stays.
    """
    found, pose = scenery.simulated(states), scenery.pose_of(episode.env)
    if len(found) != 1:
        return None
    q, v = (np.asarray(each) for each in (found[0].qpos, found[0].qvel))
    obs, dt = np.asarray(states.obs), episode.spec.dt
    each = [_source(obs, q[:, i], v[:, min(i, v.shape[1] - 1)], dt) for i in range(q.shape[1])]
    known = [source for source in each if source is not None]
    nq = len(jax.eval_shape(pose, jax.tree.map(lambda leaf: leaf[0], states)))
    if len(known) < len(each) or nq < len(known):
        return None

    def read(state: EnvState, x: Array) -> Array:
        start = scenery.simulated(state)[0].qpos
        beside = jnp.broadcast_to(pose(state)[len(known) :], (len(x), nq - len(known)))
        return jnp.hstack([jnp.stack([of(x, start[i]) for i, of in enumerate(known)], 1), beside])

    return read


def _source(
    obs: np.ndarray, q: np.ndarray, v: np.ndarray, dt: float
) -> Callable[[Array, Array], Array] | None:
    """A position along a path x [T+1, n] from its start, as it is in states of obs [N, o].

    q, v: [N] the position in these states, and the speed of the same number.
    """
    sine, cosine = np.nonzero(_same(np.arctan2(obs[:, :, None], obs[:, None]), q[:, None, None]))
    itself, speed = (np.flatnonzero(_same(obs, each[:, None])) for each in (q, v))
    if len(itself):
        return lambda x, start: x[:, itself[0]]
    if len(sine):
        return lambda x, start: start + _turn(jnp.arctan2(x[:, sine[0]], x[:, cosine[0]]) - start)
    if len(speed):
        return lambda x, start: start + dt * _integral(x[:, speed[0]])
    return None


def _same(found: np.ndarray, sought: np.ndarray) -> np.ndarray:
    """Whether numbers [N, ...] are those that are sought, or as angles, in all N states."""
    return (np.abs(_turn(found - sought)) < NEAR).all(0)


def _turn(angle: Any) -> Any:
    """The same angle within [-pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _integral(speed: Array) -> Array:
    """The integral [T+1] of a speed [T+1] over decisions by trapezoids, 0 at first."""
    return jnp.concatenate([jnp.zeros(1), jnp.cumsum((speed[1:] + speed[:-1]) / 2)])


def _of_data(episode: Episode, states: EnvState) -> Reading | None:
    """The reading of a world whose state is its observation."""
    data = states.data
    if not isinstance(data, jax.Array) or data.shape != states.obs.shape:
        return None
    return _of_state(episode.env, lambda obs: obs)


def _of_local(episode: Episode, states: EnvState) -> Reading | None:
    """The reading of an analytic world whose state is in local coordinates."""
    env: Any = episode.env
    if not hasattr(env, "to_local") or not isinstance(states.data, jax.Array):
        return None
    shape = jax.eval_shape(jax.vmap(env.to_local), states.obs).shape
    return _of_state(env, env.to_local) if shape == states.data.shape else None


def _of_state(env: Any, data: Callable[[Array], Array]) -> Reading:
    pose, o = scenery.pose_of(env), env.spec.obs

    def read(state: EnvState, x: Array) -> Array:
        return jax.vmap(lambda obs: pose(state.replace(data=data(obs), obs=obs)))(x[:, :o])

    return read


def seen(read: Reading | None, env: Any, state: EnvState, paths: Path) -> Array | None:
    """What is drawn of imagined paths [K, ...] from `state`: a Reading of each; None: nothing."""
    if isinstance(paths.x, EnvState):
        return jax.vmap(jax.vmap(scenery.pose_of(env)))(paths.x)
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

        x = lifting.start(model, params, obs)
        _, (xs, us) = jax.lax.scan(ahead, x, length=AHEAD)
        return Path(jnp.concatenate([x[None], xs])[None], us[None])

    return path


def point_of(model: mujoco.MjModel) -> tuple[int, float]:
    """The body whose path is drawn, and the reach of the point: see `track`.

    It is the middle of a torso that moves freely, else the end of the last body of an arm or pole.
    """
    moving = np.flatnonzero(model.body_weldid > 0)
    if not len(moving):
        return 0, 1.0
    if model.body_dofnum[moving[0]] >= PLANAR:
        return int(moving[0]), 1.0
    same = model.body_treeid[moving] == model.body_treeid[moving[0]]  # not a block beside an arm
    return int(moving[same][-1]), 2.0


def lines(model: mujoco.MjModel, drawn: np.ndarray) -> np.ndarray:
    """Lines [K, n, T, 3] [m] of K paths.

    drawn: [K, T, nq], of which it is that of `point_of`, or [K, T, n, 3] of n points.
    """
    if drawn.ndim == 4:
        return drawn.swapaxes(1, 2)
    return track(model, drawn, *point_of(model))[:, None]


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
