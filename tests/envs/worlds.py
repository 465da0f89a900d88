"""The environments under test, and one compiled program of each, shared by all tests."""

from functools import cache
from typing import NamedTuple

import jax
import jax.numpy as jnp
import mujoco
import numpy as np

from hybrid_rl.envs.analytic.cart_double_pendulum import CartDoublePendulum
from hybrid_rl.envs.analytic.cart_pendulum import CartPendulum
from hybrid_rl.envs.analytic.cart_swing_up import CartSwingUp
from hybrid_rl.envs.analytic.contact_plane import ContactPlane
from hybrid_rl.envs.analytic.lander import Lander
from hybrid_rl.envs.analytic.no_dynamics import NoDynamics
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.analytic.point_mass import PointMass
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.envs.analytic.sprk_sand import SprkSand
from hybrid_rl.envs.analytic.two_link import TwoLink
from hybrid_rl.envs.analytic.van_der_pol import VanDerPol
from hybrid_rl.envs.ant import Ant
from hybrid_rl.envs.cartpole import Cartpole
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.hopper import Hopper
from hybrid_rl.envs.humanoid import Humanoid
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.panda_stack import PandaStack
from hybrid_rl.envs.quadcopter import Quadcopter
from hybrid_rl.envs.sawyer_push import TIP, SawyerPush
from hybrid_rl.envs.sawyer_torque import SawyerTorque
from hybrid_rl.envs.sprk import Sprk
from hybrid_rl.envs.walker2d import Walker2d

DECISIONS = 20
STATE = {"two_link": 4, "sprk_sand": 4, "sawyer_torque": 14}  # entries before a reference
EULER = ("lander",)  # an action moves velocities now, and positions one decision later
ANALYTIC = {
    "no_dynamics": NoDynamics,
    "pendulum": Pendulum,
    "point_mass": PointMass,
    "cart_double_pendulum": CartDoublePendulum,
    "quadcopter_se3": QuadcopterSE3,
    "van_der_pol": VanDerPol,
    "cart_pendulum": CartPendulum,
    "cart_swing_up": CartSwingUp,
    "two_link": TwoLink,
    "sprk_sand": SprkSand,
    "contact_plane": ContactPlane,
    "lander": Lander,
}
TASKS = {
    "halfcheetah": HalfCheetah,
    "hopper": Hopper,
    "walker2d": Walker2d,
    "cartpole": Cartpole,
    "ant": Ant,
    "humanoid": Humanoid,
    "quadcopter": Quadcopter,
    "sawyer_push": SawyerPush,
    "panda_stack": PandaStack,
    "sawyer_torque": SawyerTorque,
    "sprk": Sprk,
    **ANALYTIC,
}
FIELDS = {
    "ant": {"integrator": "euler"},
    "humanoid": {"integrator": "euler"},
    "quadcopter": {"task": "track", "damping": True},
    "panda_stack": {"grip": "action"},
}
SIMULATED = tuple(task for task in TASKS if task not in ANALYTIC)
ARMS = ("sawyer_push", "panda_stack")  # controls depend on states
COMPUTED = (*ARMS, "quadcopter", "humanoid")  # controls are not the actions
TOUCHING, LIFTED, OTHER, BROKEN = (0, 0), (0, 1), (1, 0), (1, 1)  # lanes [seed, env]
IMPLEMENTATIONS = ("native", "mjx")


class Reference(NamedTuple):
    """How MuJoCo C simulates a task."""

    asset: str
    steps: int  # per decision
    heights: tuple[int, ...] = ()  # indices in qpos that the lifted lane raises
    lift: float = 10.0  # [m]; more for longer decisions


REFERENCE = {
    "halfcheetah": Reference("halfcheetah.xml", 5, (1,)),
    "hopper": Reference("hopper.xml", 4, (1,)),
    "walker2d": Reference("walker2d.xml", 4, (1,)),
    "cartpole": Reference("cartpole.xml", 1),
    "ant": Reference("ant_euler.xml", 5, (2,)),
    "humanoid": Reference("humanoid_euler.xml", 5, (2,)),
    "quadcopter": Reference("quadcopter.xml", 1),
    "sawyer_push": Reference("sawyer_push.xml", 20, (9,), 30.0),
    "panda_stack": Reference("panda_stack.xml", 20, (11, 18), 30.0),
    "sawyer_torque": Reference("sawyer_torque.xml", 5),
    "sprk": Reference(Sprk().asset, 30),
}


def make(task, implementation="analytic"):
    """The environment of a task; its physics, for those that MuJoCo simulates."""
    physics = {} if task in ANALYTIC else {"physics": implementation}
    return TASKS[task](**physics, **FIELDS.get(task, {}))


def task_of(env):
    return next(name for name, kind in TASKS.items() if isinstance(env, kind))


def observe(task, data, state):
    """The observation that the task's source defines, from MuJoCo's `data`."""
    qpos, qvel = data.qpos, data.qvel
    match task:
        case "cartpole":
            return np.array([qpos[0], qvel[0], np.cos(qpos[1]), np.sin(qpos[1]), qvel[1]])
        case "ant" | "humanoid":
            return np.concatenate([qpos[2:], qvel])
        case "quadcopter":
            rotation = data.body("quadcopter").xmat.reshape(3, 3)  # updated in `reference`
            away = np.asarray(state.info["target"]) - qpos[:3]
            parts = rotation.T @ [0, 0, -9.81], qvel[3:], rotation.T @ qvel[:3], rotation.T @ away
            return np.concatenate(parts)
        case "sawyer_push":
            tip, target = data.site("tip").xpos[:2], np.asarray(state.info["target"])
            return 10 * np.concatenate([qpos[7:9] - tip, qpos[7:9] - target])
        case "panda_stack":
            closed = data.ctrl[7:] < 0.02
            return np.concatenate([data.site("tool").xpos, qpos[9:12], closed, data.sensordata])
        case "sawyer_torque":
            neutral = np.array([0, -1.18, 0, 2.18, 0, 0.57, 3.3161, *np.zeros(7)])
            return np.concatenate([qpos, qvel, neutral, neutral])
        case "sprk":
            return np.concatenate([qpos, qvel])
    clipped = task in ("hopper", "walker2d")
    return np.concatenate([qpos[1:], np.clip(qvel, -10, 10) if clipped else qvel])


def actions(env):
    """[2, 2, DECISIONS, m], the same for all lanes; NaN in lane BROKEN from decision 5 on."""
    one = np.random.default_rng(0).uniform(-1, 1, (DECISIONS, env.spec.act))
    if isinstance(env, SawyerPush):
        one[:, 0] = np.abs(one[:, 0])  # the rod moves forward, to the block
    if isinstance(env, PandaStack):
        one[:, 3] = np.abs(one[:, 3])  # the hand holds the block
    every = np.tile(one, (2, 2, 1, 1)).astype(np.float32)
    every[BROKEN][5:] = np.nan
    return jnp.asarray(every)


@cache
def _first(task):
    return jax.jit(make(task, "native").reset)(jax.random.key(7))


def start(env):
    """EnvState [2, 2], the same state in all lanes; LIFTED is high above the floor.

    Sawyer's block is in front of the rod, Panda's between the fingers.
    """
    first = _first(task_of(env))
    qpos = first.data.qpos if task_of(env) in SIMULATED else None
    if isinstance(env, SawyerPush):
        tip = TIP.pose(qpos)[0]
        qpos = qpos.at[7:9].set(tip[:2] + jnp.array([0.04, 0.0])).at[10:].set(jnp.eye(4)[0])
    if isinstance(env, PandaStack):
        held = jnp.concatenate([jnp.full(2, 0.025), first.obs[:3], jnp.eye(4)[0]])
        qpos = qpos.at[7:16].set(held)
    if qpos is not None:
        first = first.replace(data=first.data.replace(qpos=qpos))
    state = jax.tree.map(lambda a: jnp.tile(a, (2, 2) + (1,) * a.ndim), first)
    if qpos is not None:
        _, _, heights, lift = REFERENCE[task_of(env)]
        lifted = state.data.qpos.at[(*LIFTED, jnp.array(heights, int))].add(lift)
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
def rollout(env):
    """EnvState [2, 2, DECISIONS] from `start` with `actions`."""
    state, path = start(env), []
    for t in range(DECISIONS):
        state = step_grid(env)(state, actions(env)[:, :, t])
        path.append(state)
    return jax.tree.map(lambda *leaves: np.stack(leaves, 2), *path)


def follow(env, x, actions) -> np.ndarray:
    """States [T+1, o] of the dynamics from x [o] under actions [T, m], in float64."""
    with jax.enable_x64(True):
        run = jax.jit(
            lambda x, u: jax.lax.scan(lambda x, u: (env.dynamics(x, u),) * 2, x, u)[1],
        )
        x = jnp.asarray(x, jnp.float64)
        return np.concatenate([x[None], run(x, jnp.asarray(actions))])


def reference(task, implementation, lane):
    """Observations [DECISIONS, o] of MuJoCo C in float64, stepped by mj_step alone.

    Controls are the actions, or those that the environment computed from them.
    """
    env = make(task, implementation)
    asset, steps, *_ = REFERENCE[task]
    model, state, path = mjcf.load(asset), start(env), rollout(env)
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = state.data.qpos[lane], state.data.qvel[lane]
    controls = path.data.ctrl if task in COMPUTED else actions(env)
    observed = []
    for t, ctrl in enumerate(np.asarray(controls)[lane]):
        data.ctrl[:] = ctrl
        mujoco.mj_step(model, data, steps)
        mujoco.mj_kinematics(model, data)
        observed.append(observe(task, data, jax.tree.map(lambda a, t=t: a[(*lane, t)], path)))
    return np.array(observed)
