"""MuJoCo XLA (MJX): the same step as pure JAX, or as Warp kernels on an NVIDIA GPU.

The state goes in and comes out as for MuJoCo C; what else `mjx.Data` holds is
computed anew in every step, so it is taken from one template.

Source: MuJoCo's documentation, "MuJoCo XLA (MJX)"; constraints are solved in
float32, contacts are all candidate pairs.
"""

from functools import cache
from typing import Any

import jax
from mujoco import mjx

from hybrid_rl.envs import mjcf


@cache
def _template(asset: str, impl: str) -> tuple[Any, Any]:
    """The mjx.Model and one mjx.Data of `asset`, made outside of any trace."""
    model = mjcf.load(asset)
    with jax.ensure_compile_time_eval():
        return mjx.put_model(model, impl=impl), mjx.make_data(model, impl=impl)


def _sense(model: mjx.Model, data: mjx.Data) -> mjx.Data:
    """`data` with the sensors of its own positions and velocities."""
    data = mjx.sensor_pos(model, mjx.fwd_position(model, data))
    return mjx.sensor_vel(model, mjx.fwd_velocity(model, data))


def step(asset: str, impl: str, n: int, fields: dict[str, jax.Array]) -> mjx.Data:
    """mjx.Data after `n` steps from `fields` (qpos, qvel, act, qacc_warmstart, ctrl)."""
    model, data = _template(asset, impl)
    with jax.numpy_rank_promotion("allow"):
        data = data.replace(**fields)
        data = jax.lax.fori_loop(0, n, lambda _, d: mjx.step(model, d), data)
        return data if mjcf.late(asset).all() else _sense(model, data)
