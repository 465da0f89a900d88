"""MuJoCo C on the threads of the CPU, called from inside a compiled JAX program.

    x = [qpos, qvel, act, warmstart, ctrl] -> n mj_steps in float64
      -> y = [qpos, qvel, act, warmstart, sensors]

Stateless: whatever a step depends on goes in and comes out with the call, so that
one pool of simulations serves all seeds and worlds, at any thread count, with the
same bits. A world that is not finite comes out as NaN.

Source: MuJoCo's documentation, "Simulation" and `mujoco.batch`.
"""

import os
from collections.abc import Callable
from functools import cache, partial
from typing import NamedTuple

import jax
import mujoco
import numpy as np
from mujoco.batch import Batch

from hybrid_rl.envs.mujoco import mjcf, xla_callback

_MOVED = mujoco.mjtStage.mjSTAGE_VEL.value  # positions, velocities and their sensors


class _Pool(NamedTuple):
    """N simulations of one model, and live views into them."""

    batch: Batch
    inputs: np.ndarray  # [N, D] float64: qpos, qvel, act, warmstart, ctrl
    sensors: np.ndarray  # [N, nsensordata] float64
    late: np.ndarray  # [nsensordata] bool: needs accelerations


def cores() -> int:
    """Processors that this process may run on, which a cluster's scheduler may have made fewer."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@cache
def _idle(asset: str, worlds: int, threads: int) -> list[_Pool]:
    """Pools that nobody uses now: several devices may call at once, each takes its own."""
    return []


def _pool(asset: str, worlds: int, threads: int) -> _Pool:
    """A new pool; by default the devices of the host share its processors."""
    model = mjcf.load(asset)
    shared = max(cores() // jax.local_device_count(), 1)
    batch = Batch(model, worlds, min(worlds, threads or shared))
    sizes = (model.nq, model.nv, model.na, model.nv, model.nu)
    first = 1  # column 0 is the time
    inputs = batch.state[:, first : first + sum(sizes)]
    if model.nhistory:
        raise ValueError(f"{asset}: actuators or sensors with delay have no place in the state")
    sensors = batch.bind("sensordata")
    return _Pool(batch, inputs, sensors, mjcf.late(asset))


def _advance(asset: str, threads: int, n: int, x: np.ndarray, y: np.ndarray) -> None:
    """Fill y [N, D'] with what becomes of x [N, D] after `n` steps of physics."""
    idle = _idle(asset, len(x), threads)
    try:
        pool = idle.pop()
    except IndexError:
        pool = _pool(asset, len(x), threads)
    moved = y.shape[1] - pool.sensors.shape[1]
    stage = 0 if pool.late.all() else _MOVED
    finite = np.isfinite(x.sum(1))
    ids = None if finite.all() else np.flatnonzero(finite)
    pool.inputs[:] = x
    if n:
        pool.batch.step(ids, n, stage)
    else:
        pool.batch.forward(ids, stage)
    y[:, :moved] = pool.inputs[:, :moved]
    y[:, moved:] = pool.sensors
    late = pool.late
    idle.append(pool)
    if not n:
        y[:, moved:][:, late] = 0.0
    if ids is not None:
        y[~finite] = np.nan


@cache
def _call(asset: str, threads: int, n: int) -> Callable[[jax.Array], jax.Array]:
    """Step x [D] to y [D'], on the CPU by a foreign call, elsewhere by a JAX callback."""
    model = mjcf.load(asset)
    width = model.nq + 2 * model.nv + model.na + model.nsensordata
    out = jax.ShapeDtypeStruct((width,), np.float32)
    advance = partial(_advance, asset, threads, n)
    name = f"hybrid_rl.native:{asset}:{threads}:{n}"
    xla_callback.register(name, advance)

    def callback(x: jax.Array) -> np.ndarray:
        rows = np.asarray(x)
        y = np.empty((*rows.shape[:-1], width), np.float32)
        advance(rows.reshape(-1, rows.shape[-1]), y.reshape(-1, width))
        return y

    def elsewhere(x: jax.Array) -> jax.Array:
        return jax.pure_callback(callback, out, x, vmap_method="broadcast_all")

    def here(x: jax.Array) -> jax.Array:
        return jax.ffi.ffi_call(name, out, vmap_method="broadcast_all")(x)

    return lambda x: jax.lax.platform_dependent(x, cpu=here, default=elsewhere)


def step(asset: str, threads: int, n: int, x: jax.Array) -> jax.Array:
    """What x = [qpos, qvel, act, warmstart, ctrl] becomes in `n` steps, with the sensors.

    n = 0 moves nothing and reads the sensors of positions and velocities.
    """
    return _call(asset, threads, n)(x)
