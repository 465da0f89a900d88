"""A push with the mouse, as a change of velocity: dv = dt M^-1 J^T F.

F is that of a spring between the point that was grabbed and the mouse, at most one body weight.
Environments take no outside force, and all physics have velocities. The observation follows one
decision later.
"""

import time
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np

from hybrid_rl import Physics, PhysicsState, scenery
from hybrid_rl.types import EnvState

STIFFNESS = 40.0  # [N/m] of the spring, for each kg of the robot
GRAVITY = 9.81  # [m/s^2]
STALE = 0.3  # [s] after which a push ends: the browser may not report its end


@dataclass(frozen=True)
class Pull:
    """What the mouse does."""

    body: str  # the name of the body
    at: np.ndarray  # [3] [m] the grabbed point in the world
    to: np.ndarray  # [3] [m] the mouse
    when: float  # [s] of time.monotonic

    @property
    def fresh(self) -> bool:
        """Whether it lasts."""
        return time.monotonic() - self.when < STALE


def possible(state: EnvState) -> bool:
    """Whether the world is one model of MuJoCo."""
    return len(scenery.simulated(state)) == 1


def force(model: mujoco.MjModel, at: np.ndarray, to: np.ndarray) -> np.ndarray:
    """The force [3] [N] of the spring from `at` [3] to `to` [3]."""
    mass = float(model.body_mass.sum())
    pull = STIFFNESS * mass * (np.asarray(to, float) - np.asarray(at, float))
    most = mass * GRAVITY
    return pull * min(1.0, most / max(float(np.linalg.norm(pull)), 1e-9))


def change(physics: PhysicsState, pull: Pull, dt: float) -> np.ndarray:
    """dv [nv] of the generalised velocities, by a pull of `dt` [s]; 0 for an unknown body."""
    model = Physics(physics.asset).model
    data, qfrc = mujoco.MjData(model), np.zeros(model.nv)
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, pull.body)
    if body < 0:
        return qfrc
    data.qpos[:] = np.asarray(physics.qpos)
    mujoco.mj_fwdPosition(model, data)
    at = np.asarray(pull.at, float)
    mujoco.mj_applyFT(model, data, force(model, at, pull.to), np.zeros(3), at, body, qfrc)
    dv = np.zeros((1, model.nv))
    mujoco.mj_solveM(model, data, dv, qfrc[None])
    return dt * dv[0]


def pushed(state: EnvState, pull: Pull, dt: float) -> EnvState:
    """`state` after the pull; its observation is as before."""

    def moved(leaf: Any) -> Any:
        if not isinstance(leaf, PhysicsState):
            return leaf
        dv = jnp.asarray(change(leaf, pull, dt), leaf.qvel.dtype)
        return leaf.replace(qvel=leaf.qvel + dv)

    data = jax.tree.map(moved, state.data, is_leaf=lambda leaf: isinstance(leaf, PhysicsState))
    return state.replace(data=data)
