"""MuJoCo XLA (MJX): the same step as pure JAX, or as Warp kernels on an NVIDIA GPU.

The state is passed in and out as for MuJoCo C; every step recomputes the other fields of
`mjx.Data`, so they come from one template. Constraints are solved in float32. Pure JAX treats
every candidate pair as a contact; Warp keeps lists of active contacts, allocated for the largest
number that the model can have.

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
from hybrid_rl.errors import UsageError, one_line

Fields = dict[str, jax.Array]  # of mjx.Data, by name
OUTPUTS = ("qpos", "qvel", "act", "qacc_warmstart", "sensordata")  # of a step


def step(
    asset: str, impl: str, n: int, fields: Fields, reads: tuple[str, ...] = (), own: Any = None
) -> Fields:
    """`OUTPUTS` after `n` steps from `fields` (qpos, qvel, act, qacc_warmstart, ctrl).

    `impl` is jax or warp. `own`, of jax alone: fields of the model, in place of its own. To
    sensordata are appended `reads`: fields of MjData after mj_forward at the new state. All outputs
    are NaN for a state that is not finite and, with Warp, when contacts or constraints exceed the
    allocated lists.
    """
    if impl == "jax":
        model, data = template(asset, impl)
        return _step(asset, impl, n, reads, model.tree_replace(own or {}), data, fields)
    one = _batched_step(asset, n, reads)(jax.tree.map(lambda x: x[None], fields))
    return jax.tree.map(lambda x: x[0], one)


@cache
def capacities(asset: str) -> tuple[int, int]:
    """The largest numbers of contacts and of constraint rows of one simulation of `asset`.

    Counted from the candidate contacts of pure JAX, which has four for a pair of boxes where Warp
    finds up to eight.
    """
    model, data = mjcf.load(asset), template(asset, "jax")[1]._impl
    boxes = (model.geom_type[np.asarray(data.contact.geom)] == mujoco.mjtGeom.mjGEOM_BOX).all(1)
    extra = np.asarray(data.contact.dim)[boxes]
    rows = np.where(extra == 1, 1, 2 * (extra - 1))  # 1 without friction, else the pyramid's edges
    return len(boxes) + len(extra), data.efc_J.shape[0] + int(rows.sum())


@cache
def _model(asset: str, impl: str) -> tuple[mujoco.MjModel, Any]:
    """The MuJoCo and the MJX model of `asset`, created outside of any trace."""
    model = mjcf.load(asset)
    if impl == "warp":  # never resets, and rejects the flag for it
        model = copy.copy(model)
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    with jax.ensure_compile_time_eval():
        try:
            put = mjx.put_model(model, impl=impl)
        except NotImplementedError as error:
            name = "mjx" if impl == "jax" else impl
            line = f"physics={name}: not for this model: {one_line(error)}; physics=native has all"
            raise UsageError(line) from error
    if impl == "warp":  # warn of overflows only, not of solver iterations
        put = put.tree_replace({"opt._impl.warn_overflow": _overflow_bits()})
    return model, put


def _overflow_bits() -> int:
    """The bits of Warp's OverflowType for contacts or constraints that were dropped."""
    from mujoco.mjx.third_party.mujoco_warp import OverflowType as Bit

    return int(Bit.NEFC | Bit.NJMAX_NNZ | Bit.BROADPHASE | Bit.NARROWPHASE | Bit.CCD)


@cache
def template(asset: str, impl: str, worlds: int = 1) -> tuple[Any, Any]:
    """The mjx.Model and one mjx.Data of `asset`; Warp's lists have the size for `worlds`."""
    plain, model = _model(asset, impl)
    sizes: dict[str, Any] = {}
    if impl == "warp":
        contacts, rows = capacities(asset)
        sizes = {"naconmax": max(1, contacts) * worlds, "njmax": max(1, rows)}
    with jax.ensure_compile_time_eval():
        return model, mjx.make_data(plain, impl=impl, **sizes)


def _step(
    asset: str, impl: str, n: int, reads: tuple[str, ...], model: Any, data: Any, fields: Fields
) -> Fields:
    """`OUTPUTS` of one simulation."""
    with jax.numpy_rank_promotion("allow"):
        data = data.replace(**fields)
        data = jax.lax.fori_loop(0, n, lambda _, d: mjx.step(model, d), data)
        outputs = {name: getattr(data, name) for name in OUTPUTS}
        late = mjcf.of_acceleration(asset)
        if reads:
            now = mjx.forward(model, data)
            read = [now.sensordata, *(_read(now, name).ravel() for name in reads)]
            outputs["sensordata"] = jnp.concatenate(read)
        elif not late.all():  # sensors of the new positions and velocities
            now = mjx.forward(model, data) if impl == "warp" else _sense(model, data)
            outputs["sensordata"] = jnp.where(late, data.sensordata, now.sensordata)
    if impl == "jax":
        return outputs
    invalid = (data._impl.overflow.reshape(()) & _overflow_bits()) != 0
    for x in fields.values():  # Warp clips controls, NaN included
        invalid |= ~jnp.isfinite(x).all()
    return jax.tree.map(lambda x: jnp.where(invalid, jnp.nan, x), outputs)


def _read(data: mjx.Data, name: str) -> jax.Array:
    """The field `name` of MjData, of which some belong to the implementation."""
    own = getattr(data._impl, name, None)
    return getattr(data, name) if own is None else own


def _sense(model: mjx.Model, data: mjx.Data) -> mjx.Data:
    """`data` with the sensors of its present positions and velocities, in pure JAX."""
    data = mjx.sensor_pos(model, mjx.fwd_position(model, data))
    return mjx.sensor_vel(model, mjx.fwd_velocity(model, data))


@cache
def _batched_step(asset: str, n: int, reads: tuple[str, ...]) -> Any:
    """A step of W simulations as one Warp batch, whose lists have the size for all of them."""

    @jax.custom_batching.custom_vmap
    def advance(fields: Fields) -> Fields:
        model, data = template(asset, "warp", len(fields["qpos"]))
        return jax.vmap(partial(_step, asset, "warp", n, reads, model, data))(fields)

    @advance.def_vmap
    def _(size: int, batched: list[dict[str, bool]], fields: Fields) -> tuple[Fields, Any]:
        def merge(x: jax.Array, batched: bool) -> jax.Array:  # [size, W, ...] -> [size * W, ...]
            x = x if batched else jnp.broadcast_to(x, (size, *x.shape))
            return x.reshape(size * x.shape[1], *x.shape[2:])

        out = advance(jax.tree.map(merge, fields, batched[0]))
        out = jax.tree.map(lambda x: x.reshape(size, len(x) // size, *x.shape[1:]), out)
        return out, jax.tree.map(lambda _: True, out)

    return advance
