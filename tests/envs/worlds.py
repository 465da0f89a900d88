"""The environments under test, and one compiled program of each, shared by all tests."""

from functools import cache
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from hydra.utils import get_class
from omegaconf import OmegaConf

from hybrid_rl.envs.mujoco import mjcf, scenery
from hybrid_rl.envs.panda_stack import PandaStack
from hybrid_rl.envs.sawyer_push import TIP, SawyerPush
from hybrid_rl.settings.groups import files, options
from hybrid_rl.types import Params

DECISIONS = 20
FROM_OTHERS = {"gymnasium", "playground", "robot", "online"}  # tests of their own
OWN_TEST = {"sawyer_probe"}  # test_sawyer_probe.py
TASKS: dict[str, Any] = {
    name: get_class(OmegaConf.load(files("task")[name]).env._target_)
    for name in options("task")
    if name not in FROM_OTHERS | OWN_TEST
}
ANALYTIC = tuple(name for name, kind in TASKS.items() if ".analytic." in kind.__module__)
SIMULATED = tuple(name for name in TASKS if name not in ANALYTIC)
FIELDS = {
    "ant": {"integrator": "euler"},
    "humanoid": {"integrator": "euler"},
    "quadcopter": {"task": "track", "damping": True},
    "panda_stack": {"grip": "action"},
    "sprk_sand": {"learn": 3},
    "sawyer_torque": {"learn": 3},
}
ARMS = ("sawyer_push", "panda_stack")  # controls depend on states
COMPUTED = (*ARMS, "quadcopter", "humanoid", "legs", "reach")  # controls are not the actions
TOUCHING, LIFTED, OTHER, BROKEN = (0, 0), (0, 1), (1, 0), (1, 1)  # lanes [seed, env]
IMPLEMENTATIONS = ("native", "mjx")


TOUCH = {  # geoms that touch each other; what the lifted lane raises in qpos, and how far [m]
    **dict.fromkeys(("halfcheetah", "hopper", "walker2d"), (("floor",), (1,), 10.0)),
    **dict.fromkeys(("ant", "humanoid", "legs"), (("floor",), (2,), 10.0)),
    "sawyer_push": (("rod", "cube"), (9,), 30.0),
    "panda_stack": (("left_pad", "block"), (11, 18), 30.0),
}


def make(task, /, implementation="native", **fields):
    """The environment of a task; its physics, for those that MuJoCo simulates."""
    physics = {"physics": implementation} if task in SIMULATED else {}
    return TASKS[task](**physics, **FIELDS.get(task, {}) | fields)


def task_of(env):
    return next(name for name, kind in TASKS.items() if type(env) is kind)


def actions(env):
    """[2, 2, DECISIONS, m], the same for all lanes; NaN in lane BROKEN from decision 5 on."""
    one = np.random.default_rng(0).uniform(-1, 1, (DECISIONS, env.spec.act))
    if task_of(env) in ARMS:
        forward_or_held = {"sawyer_push": 0, "panda_stack": 3}[task_of(env)]
        one[:, forward_or_held] = np.abs(one[:, forward_or_held])
    every = np.tile(one, (2, 2, 1, 1)).astype(np.float32)
    every[BROKEN][5:] = np.nan
    return jnp.asarray(every)


@cache
def _first(task):
    return jax.jit(make(task).reset)(jax.random.key(7))


def start(env):
    """EnvState [2, 2], the same state in all lanes; LIFTED is high above the floor.

    Sawyer's block is in front of the rod, Panda's between the fingers.
    """
    task = task_of(env)
    first = _first(task)
    qpos = first.data.qpos if task in SIMULATED else None
    if task == "sawyer_push":
        tip = TIP.pose(qpos)[0]
        qpos = qpos.at[7:9].set(tip[:2] + jnp.array([0.04, 0.0])).at[10:].set(jnp.eye(4)[0])
    if task == "panda_stack":
        held = jnp.concatenate([jnp.full(2, 0.025), first.obs[:3], jnp.eye(4)[0]])
        qpos = qpos.at[7:16].set(held)
    if qpos is not None:
        first = first.replace(data=first.data.replace(qpos=qpos))
    state = jax.tree.map(lambda a: jnp.tile(a, (2, 2) + (1,) * a.ndim), first)
    if task in TOUCH:
        _, heights, lift = TOUCH[task]
        lifted = state.data.qpos.at[(*LIFTED, jnp.array(heights))].add(lift)
        state = state.replace(data=state.data.replace(qpos=lifted))
    return state


@cache
def step_grid(env):
    """`step` of states [2, 2] and actions [2, 2, m], by vmap of vmap; compiled once."""
    return jax.jit(jax.vmap(jax.vmap(env.step)))


@cache
def jitted(env, method):
    """A method of `env`, compiled once for all tests."""
    return jax.jit(getattr(env, method))


@cache
def many(env, method):
    """A method of `env` for a batch, compiled once for all tests."""
    return jax.jit(jax.vmap(getattr(env, method)))


@cache
def _scanned(env):
    return jax.jit(lambda state, u: jax.lax.scan(lambda s, u: (env.step(s, u),) * 2, state, u)[1])


def along(env, state, actions):
    """The states [T] after each of actions [T, m], from `state`."""
    return _scanned(env)(state, jnp.asarray(actions, jnp.float32))


def flown(env, key, actions):
    """EnvState [T + 1] from a reset with `key`, under actions [T, m]."""
    first = jitted(env, "reset")(key)
    path = along(env, first, actions)
    return jax.tree.map(lambda a, b: np.concatenate([a[None], b]), first, path)


@cache
def rollout(env):
    """EnvState [2, 2, DECISIONS] from `start` with `actions`."""
    state, path = start(env), []
    for t in range(DECISIONS):
        state = step_grid(env)(state, actions(env)[:, :, t])
        path.append(state)
    return jax.tree.map(lambda *leaves: np.stack(leaves, 2), *path)


@cache
def _followed(env):
    return jax.jit(lambda x, u: jax.lax.scan(lambda x, u: (env.dynamics(x, u),) * 2, x, u)[1])


def follow(env, x, actions) -> np.ndarray:
    """States [T+1, o] of the dynamics from x [o] under actions [T, m], in float64."""
    with jax.enable_x64(True):
        x = jnp.asarray(x, jnp.float64)
        return np.concatenate([x[None], _followed(env)(x, jnp.asarray(actions, jnp.float64))])


def placed(asset, qpos, qvel=0.0):
    """MuJoCo's own model and data at qpos [nq] and qvel [nv]; qpos may be its first entries."""
    model = mjcf.load(asset)
    data = mujoco.MjData(model)
    data.qpos[: len(qpos)], data.qvel[:] = qpos, qvel
    mujoco.mj_forward(model, data)
    return model, data


def simulated(asset, qpos, qvel, forces, steps) -> tuple[np.ndarray, np.ndarray]:
    """Joint positions and velocities [T, nv] of MuJoCo C under generalised forces [T, nv]."""
    (model, data), path = placed(asset, qpos, qvel), []
    for data.qfrc_applied[:] in forces:
        mujoco.mj_step(model, data, steps)
        path.append((data.qpos.copy(), data.qvel.copy()))
    positions, velocities = zip(*path, strict=True)
    return np.array(positions), np.array(velocities)


def shown(env, state):
    """MuJoCo's data of the scene in which a state is drawn."""
    return placed(scenery.scene_of(env), scenery.pose_of(env)(state))[1]


def reference(env, lane):
    """qpos and qvel [DECISIONS, nq + nv] of MuJoCo C in float64, stepped by mj_step alone.

    Controls are the actions, or those that the environment computed from them.
    """
    state, path = start(env), rollout(env)
    model = mjcf.load(state.data.asset)
    data, moved = mujoco.MjData(model), []
    data.qpos[:], data.qvel[:] = state.data.qpos[lane], state.data.qvel[lane]
    controls = path.data.ctrl if task_of(env) in COMPUTED else actions(env)
    for data.ctrl[:] in np.asarray(controls)[lane]:
        mujoco.mj_step(model, data, round(env.spec.dt / model.opt.timestep))
        moved.append(np.concatenate([data.qpos, data.qvel]))
    return np.array(moved)


def apart(env, lane):
    """The largest difference [m, rad, m/s, rad/s] from `reference` along the rollout.

    Under MJX without the velocities of blocks: a pushed one spins by 0.4 rad/s more or less.
    """
    data, expected = rollout(env).data, reference(env, lane)
    own = np.concatenate([data.qpos[lane], data.qvel[lane]], -1)
    spins = env.physics == "mjx" and isinstance(env, SawyerPush | PandaStack)
    return np.abs(own - expected)[:, : data.qpos.shape[-1] if spins else None].max()


@cache
def play(env, expert, decisions):
    """Actions [4, decisions, m] and states [4, decisions] of `expert` in four episodes.

    Stepped by the program that the other tests of `env` compiled.
    """
    keys = jax.random.split(jax.random.key(1), 4).reshape(2, 2)
    state = jax.vmap(jax.vmap(jitted(env, "reset")))(keys)
    memory = jax.tree.map(lambda a: jnp.tile(a, (2, 2, 1)), expert.init(env.spec))

    @jax.jit
    @jax.vmap
    @jax.vmap
    def act(memory, obs):
        return expert.act(Params(), memory, obs, jax.random.key(0))[:2]

    path = []
    for _ in range(decisions):
        action, memory = act(memory, state.obs)
        state = step_grid(env)(state, action)
        path.append((action, state))
    stacked = jax.tree.map(lambda *leaves: np.stack(leaves, 2), *path)
    return jax.tree.map(lambda a: a.reshape(4, *a.shape[2:]), stacked)
