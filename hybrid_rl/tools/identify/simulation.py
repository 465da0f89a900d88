"""Motions of models side by side (MuJoCo C, float64).

    y(t) = h(x(t)),   x' = f(x, u(t - delay), theta)

A command holds until the next one. A step of the physics gets the mean of the commands that act in
it, so that y is a smooth function of the delay.

A short difference quotient is wrong where an actuator saturates or a joint sticks: y jumps by one
step. So the derivatives are secants.
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from mujoco import rollout

from hybrid_rl.tools.identify.system import System

SECANT, FINE = 0.05, 0.005  # of a coordinate: to find a minimum, and to judge


@dataclass(frozen=True)
class Motion:
    """Commands, and where they begin."""

    t: np.ndarray  # [K] times of the commands [s]
    ctrl: np.ndarray  # [K, nu]
    first: np.ndarray  # [nstate] the state at the first step
    begin: float  # [s] time of that step
    steps: int


def state(model: mujoco.MjModel, qpos: np.ndarray, qvel: np.ndarray | None = None) -> np.ndarray:
    """The full state [nstate] at these positions."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    if qvel is not None:
        data.qvel[:] = qvel
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    result = np.zeros(mujoco.mj_stateSize(model, full))
    mujoco.mj_getState(model, data, result, full)
    return result


def start(system: System) -> tuple[np.ndarray, np.ndarray]:
    """The state [nstate] and the command [nu] of the first keyframe, at rest.

    Without one: the positions of the model, and the middle of the actuators' ranges.
    """
    model, data = system.base, mujoco.MjData(system.base)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
        ctrl = data.ctrl.copy()
    else:
        ctrl = np.where(model.actuator_ctrllimited, model.actuator_ctrlrange.mean(1), 0.0)
    first = state(model, data.qpos)
    rest = Motion(np.zeros(1), ctrl[None], first, 0.0, round(1.0 / model.opt.timestep))
    model = system.model(system.nominal)
    x = simulate([model], [0.0], [rest])[0][0, -1]
    return state(model, x[1 : 1 + model.nq]), ctrl


def simulate(
    models: Sequence[mujoco.MjModel],
    delays: Sequence[float],
    motions: Sequence[Motion],
    firsts: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """States [B W, S + 1, nstate] and sensors [B W, S, ns] of B models in W motions of S steps.

    firsts [B, W, nstate]: instead of the states with which the motions begin.
    """
    h = models[0].opt.timestep
    steps = max(motion.steps for motion in motions)
    knots = {(d, w): commands(m, d, h, steps) for d in {*delays} for w, m in enumerate(motions)}
    ctrl = np.stack([knots[d, w] for d in delays for w in range(len(motions))])
    if firsts is None:
        firsts = np.stack([[motion.first for motion in motions]] * len(models))
    firsts = firsts.reshape(-1, firsts.shape[-1])
    each = [model for model in models for _ in motions]
    made = rollout.rollout(each, _data(models[0]), firsts, ctrl, persistent_pool=True)
    x, sensors = (np.asarray(part) for part in made)
    return np.concatenate((firsts[:, None], x), axis=1), sensors


def _data(model: mujoco.MjModel) -> list[mujoco.MjData]:
    """Scratch of each thread, one for a processor."""
    affinity = getattr(os, "sched_getaffinity", None)  # not on every system
    threads = len(affinity(0)) if affinity else os.cpu_count() or 1
    return [mujoco.MjData(model) for _ in range(threads)]


def commands(motion: Motion, delay: float, h: float, steps: int) -> np.ndarray:
    """[S, nu] the mean of the commands that act in each step of h seconds."""
    edges = motion.begin - delay + h * np.arange(steps + 1)
    t = np.append(motion.t, max(motion.t[-1], edges[-1]) + 1.0)
    t = np.concatenate(([min(t[0], edges[0]) - 1.0], t))  # the first one acted before
    held = np.concatenate((motion.ctrl[:1], motion.ctrl))
    area = np.concatenate((np.zeros_like(held[:1]), np.cumsum(held * np.diff(t)[:, None], 0)))
    at = np.stack([np.interp(edges, t, column) for column in area.T], axis=1)
    return np.diff(at, axis=0) / h


def measured(
    system: System, x: np.ndarray, sensors: np.ndarray, begin: float, t: np.ndarray
) -> np.ndarray:
    """[..., T, n] positions, and the sensors of the system, of a motion at the times t [T]."""
    model = system.base
    s = (t - begin) / model.opt.timestep
    y = [_between(x[..., 1 : 1 + model.nq], s)]
    if system.sensors:
        rows = [model.sensor(name) for name in system.sensors]
        at = np.concatenate([row.adr[0] + np.arange(row.dim[0]) for row in rows])
        y.append(_between(sensors[..., at], s))  # those of the state before the step
    return np.concatenate(y, axis=-1)


def _between(x: np.ndarray, s: np.ndarray) -> np.ndarray:
    """x [..., S, n] at fractional steps s [T]."""
    i = np.clip(s.astype(int), 0, x.shape[-2] - 2)
    share = np.clip(s - i, 0.0, 1.0)[:, None]
    return (1 - share) * x[..., i, :] + share * x[..., i + 1, :]
