"""The worlds under test, and one compiled rollout of each, shared by all tests."""

from functools import cache
from typing import NamedTuple

import jax
import jax.numpy as jnp
import mujoco
import numpy as np

from hybrid_rl.envs import mjcf
from hybrid_rl.envs.cart_double_pendulum import CartDoublePendulum
from hybrid_rl.envs.cartpole import Cartpole
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.hopper import Hopper
from hybrid_rl.envs.pendulum import Pendulum
from hybrid_rl.envs.point_mass import PointMass
from hybrid_rl.envs.quadcopter_se3 import QuadcopterSE3

DECISIONS = 20
FORMULAS = {
    "pendulum": Pendulum,
    "point_mass": PointMass,
    "cart_double_pendulum": CartDoublePendulum,
    "quadcopter_se3": QuadcopterSE3,
}
TASKS = {"halfcheetah": HalfCheetah, "hopper": Hopper, "cartpole": Cartpole, **FORMULAS}
SIMULATED = ("halfcheetah", "hopper", "cartpole")
TOUCHING, LIFTED, OTHER, BROKEN = (0, 0), (0, 1), (1, 0), (1, 1)  # lanes [seed, world]
IMPLEMENTATIONS = ("native", "mjx")


class Reference(NamedTuple):
    """What MuJoCo C needs to know of a task."""

    asset: str
    steps: int  # per decision


REFERENCE = {
    "halfcheetah": Reference("halfcheetah.xml", 5),
    "hopper": Reference("hopper.xml", 4),
    "cartpole": Reference("cartpole.xml", 1),
}


def make(task, implementation):
    return TASKS[task](physics=implementation)


def observe(task, qpos, qvel):
    """The observation that the task's source defines."""
    if task == "cartpole":
        return np.array([qpos[0], qvel[0], np.cos(qpos[1]), np.sin(qpos[1]), qvel[1]])
    return np.concatenate([qpos[1:], np.clip(qvel, -10, 10) if task == "hopper" else qvel])


def actions(env):
    """[2, 2, DECISIONS, m], the same for each lane; NaN in lane BROKEN from decision 5 on."""
    one = np.random.default_rng(0).uniform(-1, 1, (DECISIONS, env.spec.act))
    every = np.tile(one, (2, 2, 1, 1)).astype(np.float32)
    every[BROKEN][5:] = np.nan
    return jnp.asarray(every)


def start(env):
    """EnvState [2, 2]: 2 seeds x 2 worlds. Lanes start alike, LIFTED 10 m higher."""
    first = env.reset(jax.random.key(7))
    state = jax.tree.map(lambda a: jnp.tile(a, (2, 2) + (1,) * a.ndim), first)
    if isinstance(env, HalfCheetah | Hopper):
        qpos = state.data.qpos.at[(*LIFTED, 1)].add(10.0)
        state = state.replace(data=state.data.replace(qpos=qpos))
    return state


@cache
def rollout(env):
    """EnvState [2, 2, DECISIONS]: scan inside vmap inside vmap inside jit, compiled once."""

    def run(state, plan):
        def one(state, action):
            state = env.step(state, action)
            return state, state

        return jax.lax.scan(one, state, plan)[1]

    return jax.jit(jax.vmap(jax.vmap(run)))(start(env), actions(env))


@cache
def reference(task, lane):
    """Observations [DECISIONS, o] of MuJoCo C in float64, stepped by mj_step alone."""
    env = make(task, "native")
    asset, steps = REFERENCE[task]
    model, state = mjcf.load(asset), start(env)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = state.data.qpos[lane], state.data.qvel[lane]
    path = []
    for action in np.asarray(actions(env))[lane]:
        data.ctrl[:] = action
        mujoco.mj_step(model, data, steps)
        path.append(observe(task, data.qpos, data.qvel))
    return np.array(path)
