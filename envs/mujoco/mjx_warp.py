"""MuJoCo XLA (MJX): the same step as pure JAX, or as Warp kernels on an NVIDIA GPU.

The state goes in and comes out as for MuJoCo C; what else `mjx.Data` holds is
computed anew in every step, so it is taken from one template. Constraints are
solved in float32. Pure JAX counts every candidate pair as a contact; Warp keeps
lists of those that touch, and the lists have room for all that can.

Source: MuJoCo's documentation, "MuJoCo XLA (MJX)" and "MuJoCo Warp".
"""

import copy
from functools import cache, partial
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from mujoco import mjx

from hybrid_rl.envs.mujoco import mjcf

Fields = dict[str, jax.Array]  # of mjx.Data, by name
LEFT = ("qpos", "qvel", "act", "qacc_warmstart", "sensordata")  # what a step leaves


def step(asset: str, impl: str, n: int, fields: Fields) -> Fields:
    """`LEFT` after `n` steps from `fields` (qpos, qvel, act, qacc_warmstart, ctrl).

    `impl` is jax or warp. A world that was not finite is NaN, and under Warp also one whose
    contacts or constraints found no room.
    """
    if impl == "jax":
        return _step(asset, impl, n, template(asset, impl), fields)
    one = _together(asset, n)(jax.tree.map(lambda x: x[None], fields))
    return jax.tree.map(lambda x: x[0], one)


@cache
def capacities(asset: str) -> tuple[int, int]:
    """The most contacts and the most constraint rows that one world of `asset` can have.

    Candidate contacts as pure JAX lists them: for two boxes four, where Warp finds up to eight.
    """
    model, data = mjcf.load(asset), template(asset, "jax")[1]._impl
    boxes = (model.geom_type[np.asarray(data.contact.geom)] == mujoco.mjtGeom.mjGEOM_BOX).all(1)
    more = np.asarray(data.contact.dim)[boxes]  # 1 row without friction, else a pyramid's edges
    rows = np.where(more == 1, 1, 2 * (more - 1))
    return len(boxes) + len(more), data.efc_J.shape[0] + int(rows.sum())


@cache
def _model(asset: str, impl: str) -> tuple[mujoco.MjModel, Any]:
    """The model of `asset`, in MuJoCo's and in MJX's form, made outside of any trace."""
    model = mjcf.load(asset)
    if impl == "warp":  # never resets a world, and refuses the flag that says so
        model = copy.copy(model)
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    with jax.ensure_compile_time_eval():
        put = mjx.put_model(model, impl=impl)
    if impl == "warp":  # prints what room would do; an early end of its solver is no fault
        put = put.tree_replace({"opt._impl.warn_overflow": _room()})
    return model, put


def _room() -> int:
    """The bits of Warp's OverflowType that say: contacts or constraints were left out."""
    from mujoco.mjx.third_party.mujoco_warp import OverflowType as Full

    return int(Full.NEFC | Full.NJMAX_NNZ | Full.BROADPHASE | Full.NARROWPHASE | Full.CCD)


@cache
def template(asset: str, impl: str, worlds: int = 1) -> tuple[Any, Any]:
    """The mjx.Model and one mjx.Data of `asset`, with Warp's room for `worlds` together."""
    plain, model = _model(asset, impl)
    room: dict[str, Any] = {}
    if impl == "warp":
        contacts, rows = capacities(asset)
        room = {"naconmax": max(1, contacts) * worlds, "njmax": max(1, rows)}
    with jax.ensure_compile_time_eval():
        return model, mjx.make_data(plain, impl=impl, **room)


def _step(asset: str, impl: str, n: int, made: tuple[Any, Any], fields: Fields) -> Fields:
    """One world's `LEFT`."""
    model, data = made
    with jax.numpy_rank_promotion("allow"):
        data = data.replace(**fields)
        data = jax.lax.fori_loop(0, n, lambda _, d: mjx.step(model, d), data)
        left = {name: getattr(data, name) for name in LEFT}
        late = mjcf.late(asset)
        if not late.all():  # sensors of the new positions and velocities
            now = mjx.forward(model, data) if impl == "warp" else _sense(model, data)
            left["sensordata"] = jnp.where(late, data.sensordata, now.sensordata)
    if impl == "jax":
        return left
    lost = (data._impl.overflow.reshape(()) & _room()) != 0
    for x in fields.values():  # Warp would clip a control that is not a number
        lost |= ~jnp.isfinite(x).all()
    return jax.tree.map(lambda x: jnp.where(lost, jnp.nan, x), left)


def _sense(model: mjx.Model, data: mjx.Data) -> mjx.Data:
    """`data` with the sensors of its own positions and velocities, in pure JAX."""
    data = mjx.sensor_pos(model, mjx.fwd_position(model, data))
    return mjx.sensor_vel(model, mjx.fwd_velocity(model, data))


@cache
def _together(asset: str, n: int) -> Any:
    """Steps W worlds as one batch of Warp: its lists are shared, and are made for their number."""

    @jax.custom_batching.custom_vmap
    def advance(fields: Fields) -> Fields:
        made = template(asset, "warp", len(fields["qpos"]))
        return jax.vmap(partial(_step, asset, "warp", n, made))(fields)

    @advance.def_vmap
    def _(size: int, batched: list[dict[str, bool]], fields: Fields) -> tuple[Fields, Any]:
        def flat(x: jax.Array, has: bool) -> jax.Array:  # [size, W, ...] to [size * W, ...]
            x = x if has else jnp.broadcast_to(x, (size, *x.shape))
            return x.reshape(size * x.shape[1], *x.shape[2:])

        left = advance(jax.tree.map(flat, fields, batched[0]))
        left = jax.tree.map(lambda x: x.reshape(size, len(x) // size, *x.shape[1:]), left)
        return left, jax.tree.map(lambda _: True, left)

    return advance
