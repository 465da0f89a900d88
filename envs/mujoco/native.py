"""MuJoCo C on CPU threads, called from a compiled JAX program.

    x = [qpos, qvel, act, warmstart, ctrl, fields] -> n mj_steps in float64
      -> y = [qpos, qvel, act, warmstart, sensors, reads]

fields: those of MjModel that a simulation has for itself. Every call passes in and returns
everything that a step depends on, so that one pool of simulations serves all seeds and
environments, and the results are the same bit for bit with any number of threads. A state that is
not finite gives NaN. Of MuJoCo's warnings each kind is one line: a planner's candidates may be
unstable at every decision.

Source: MuJoCo's documentation, "Simulation" and `mujoco.batch`.
"""

import os
import re
import sys
from collections import defaultdict
from collections.abc import Callable
from functools import cache, partial
from math import isfinite, prod
from typing import NamedTuple

import jax
import mujoco
import numpy as np
from mujoco.batch import Batch

from hybrid_rl.envs.mujoco import mjcf, xla_callback

Names = tuple[str, ...]
NAME = "hybrid_rl.native:"  # begins the names of the foreign calls
UNSTABLE = re.compile("unstable|singular|convex")  # what MuJoCo says of states that diverge
_MOVED = mujoco.mjtStage.mjSTAGE_VEL.value  # positions, velocities and their sensors
_ALL = mujoco.mjtStage.mjSTAGE_ACC.value  # also forces
_WARNED: set[str] = set()  # the kinds of warnings that were printed


class _Pool(NamedTuple):
    """N simulations of one model, and views [N, ...] float64 of their memory."""

    batch: Batch
    inputs: np.ndarray  # qpos, qvel, act, warmstart, ctrl
    fields: list[np.ndarray]  # of the model, which follow them in x
    set: np.ndarray  # [N, k] the fields that it has; NaN before the first call
    moved: np.ndarray  # inputs without ctrl
    outputs: list[np.ndarray]  # what follows them in y: sensors, then reads; none is empty
    late: np.ndarray  # columns of y with sensors of accelerations
    stage: int  # up to which MuJoCo evaluates the new state


def cores() -> int:
    """Number of processors that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)  # not on every system
    return len(affinity(0)) if affinity else os.cpu_count() or 1


def _warn(text: str) -> None:
    """Print MuJoCo's warning `text`, unless one of its kind was; what UNSTABLE finds is one."""
    unstable = UNSTABLE.search(text)
    kind = "unstable" if unstable else text.split(".")[0]
    if kind not in _WARNED:
        _WARNED.add(kind)
        harmless = "; harmless for a planner's candidates" if unstable else ""
        line = f"hybrid_rl: MuJoCo: {text.split(' Time =')[0]} (printed once{harmless})"
        print(line, file=sys.stderr, flush=True)


# Pools that are not in use, by what they step; calls of several devices need one each.
_IDLE: defaultdict[tuple, list[_Pool]] = defaultdict(list)


def _pool(asset: str, worlds: int, threads: int, reads: Names, fields: Names) -> _Pool:
    """A new pool; with threads=0 the host's devices divide its processors among them."""
    if mujoco.get_mju_user_warning() is None:  # else MuJoCo writes each to MUJOCO_LOG.TXT, too
        mujoco.set_mju_user_warning(_warn)
    model = mjcf.load(asset)
    shared = max(cores() // jax.local_device_count(), 1)
    batch = Batch(model, worlds, min(worlds, threads or shared))
    if model.nhistory:
        raise ValueError(f"{asset}: actuators or sensors with a delay are not supported")
    first, moved = 1, model.nq + 2 * model.nv + model.na  # column 0 is the time
    inputs = batch.state[:, first : first + moved + model.nu]
    late = mjcf.of_acceleration(asset)
    outputs = ("sensordata", *reads) if model.nsensordata else reads
    outputs = [batch.bind(name).reshape(worlds, -1) for name in outputs]
    stage = _ALL if reads else 0 if late.all() else _MOVED
    own = [batch.expand(name) for name in fields]
    unset = np.full((worlds, sum(field[0].size for field in own)), np.nan, np.float32)
    late = moved + np.flatnonzero(late)
    return _Pool(batch, inputs, own, unset, inputs[:, :moved], outputs, late, stage)


def _set_fields(pool: _Pool, own: np.ndarray, finite: np.ndarray | None) -> None:
    """Give the simulations the fields `own` [N, k] of their models, and all that follows."""
    new = (own != pool.set).any(1)
    ids = np.flatnonzero(new if finite is None else new & finite)
    if not len(ids):
        return
    pool.set[ids], end = own[ids], 0
    for field in pool.fields:
        start, end = end, end + field[0].size
        field[ids] = own[ids, start:end].reshape(-1, *field.shape[1:])
    pool.batch.set_const(ids)


@np.errstate(over="ignore", invalid="ignore")  # of states that diverge
def _advance(
    asset: str, threads: int, n: int, reads: Names, fields: Names, x: np.ndarray, y: np.ndarray
) -> None:
    """Write the result of `n` physics steps from x [N, D] into y [N, D'].

    A half-cheetah steps in 5 us, so what is the same at every call is prepared in `_pool`.
    """
    idle = _IDLE[asset, len(x), threads, reads, fields]
    try:
        pool = idle.pop()
    except IndexError:
        pool = _pool(asset, len(x), threads, reads, fields)
    finite = None if isfinite(x.sum()) else np.isfinite(x.sum(1))
    ids = None if finite is None else np.flatnonzero(finite)
    end = pool.inputs.shape[1]
    pool.inputs[:] = x[:, :end]
    if pool.fields:
        _set_fields(pool, x[:, end:], finite)
    if n:
        pool.batch.step(ids, n, pool.stage)
    else:
        pool.batch.forward(ids, pool.stage)
    end = pool.moved.shape[1]
    y[:, :end] = pool.moved
    for output in pool.outputs:
        start, end = end, end + output.shape[1]
        y[:, start:end] = output
    if not (n or reads):
        y[:, pool.late] = 0.0
    if finite is not None:
        y[~finite] = np.nan
    idle.append(pool)


@cache
def stepper(
    asset: str, threads: int, n: int, reads: Names, fields: Names
) -> Callable[[jax.Array], jax.Array]:
    """The function x [D] -> y [D']: a foreign call on the CPU, a JAX callback on other devices.

    reads: fields of MjData after mj_forward at the new state. fields: names of fields of MjModel.
    n = 0 only evaluates `reads` and the sensors of positions and velocities.
    """
    model = mjcf.load(asset)
    width = model.nq + 2 * model.nv + model.na + model.nsensordata
    width += sum(prod(mjcf.shape(asset, name)) for name in reads)
    out = jax.ShapeDtypeStruct((width,), np.float32)
    advance = partial(_advance, asset, threads, n, reads, fields)
    name = f"{NAME}{asset}:{threads}:{n}:{','.join(reads)}:{','.join(fields)}"
    xla_callback.register(name, advance)

    def callback(x: jax.Array) -> np.ndarray:
        inputs = np.asarray(x)
        y = np.empty((*inputs.shape[:-1], width), np.float32)
        advance(inputs.reshape(-1, inputs.shape[-1]), y.reshape(-1, width))
        return y

    on_cpu = jax.ffi.ffi_call(name, out, vmap_method="broadcast_all")
    elsewhere = partial(jax.pure_callback, callback, out, vmap_method="broadcast_all")
    return lambda x: jax.lax.platform_dependent(x, cpu=on_cpu, default=elsewhere)
