"""MuJoCo's step in three implementations.

    s' = step^n(s, ctrl),   s = (qpos, qvel, act, warmstart)

    native   MuJoCo C on CPU threads, float64 internally  any CPU; few environments on a GPU
    mjx      MuJoCo XLA, pure JAX, float32                many environments on an accelerator
    warp     MuJoCo Warp through MJX, float32             many environments on an NVIDIA GPU
    auto     native on a CPU and for at most 40 environments per core of the host; else warp on an
             NVIDIA GPU if warp-lang is installed; else mjx

The limit of 40: on an H200 with 12 cores, 64 learners on the half-cheetah made 31,400 decisions/s
with MuJoCo C and 15,700 with Warp, 512 learners 58,400 and 56,700, 4,096 learners 69,900 and
96,600.

All three share one small state, so that checkpoints are small, a reset is a `where`, and a resumed
run continues bit for bit.

Source: MuJoCo's documentation, "Computation: the state" (mjSTATE_INTEGRATION).
"""

from collections.abc import Mapping
from importlib.util import find_spec
from math import prod
from types import MappingProxyType
from typing import Annotated, Any, Literal, get_args

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
from flax import struct
from jax import Array

from hybrid_rl.envs.mujoco import mjcf, native
from hybrid_rl.errors import install
from hybrid_rl.fields import Must, part

NATIVE_PER_CORE = 40  # environments per core of the host up to which auto is native
Implementation = Literal["auto", "native", "mjx", "warp"]
IMPLEMENTATIONS = get_args(Implementation)
INPUTS = ("qpos", "qvel", "act", "qacc_warmstart", "ctrl")  # of a step, as MjData calls them


def _runs(implementation: str) -> bool:
    """Whether an implementation can run on this machine."""
    return implementation != "warp" or bool(find_spec("warp") and jax.default_backend() == "gpu")


WARP = f"have an NVIDIA GPU and warp-lang ({install('warp')}); native is for a CPU, mjx for others"
Simulator = Annotated[Implementation, Must(_runs, WARP)]  # of a field


@struct.dataclass
class PhysicsState:
    """Everything that a step depends on, and the sensors after it; float32.

    After the sensors come the `reads` of Physics, with which all sensors are of this state. A field
    that the model lacks is None, not empty: Shardy of jax 0.11 ends the process when it shards an
    array without entries.
    """

    qpos: Array  # [nq] positions [m, rad]
    qvel: Array  # [nv] velocities [m/s, rad/s]
    act: Array | None  # [na] actuator activations
    warmstart: Array  # [nv] accelerations from which the solver starts [m/s^2, rad/s^2]
    ctrl: Array | None  # [nu] controls of the last step
    sensors: Array | None  # [nsensordata] of this state; of accelerations: of the last step
    asset: str = struct.field(pytree_node=False)  # the model whose state it is
    fields: dict[str, Array] = struct.field(default_factory=dict)  # of MjModel, this episode's own
    held: Array | None = None  # [] steps for which `ctrl` stays, while newer controls are to arrive


def resolve(implementation: str, worlds: int | None = None) -> str:
    """The implementation for `worlds` parallel environments on this machine: native, mjx or warp.

    On an accelerator, None counts as many.
    """
    if implementation != "auto":
        return implementation
    backend = jax.default_backend()
    few = worlds is not None and worlds <= NATIVE_PER_CORE * native.cores()
    if few or backend == "cpu":
        return "native"
    return "warp" if backend == "gpu" and find_spec("warp") else "mjx"


@part
class Physics:
    """Steps the model `asset`. Hashable and compared by value; `mjcf` caches the models."""

    asset: str  # file in assets/, an absolute path, or MJCF text
    implementation: Simulator = "auto"
    threads: int = 0  # of native; 0: one per core
    reads: tuple[str, ...] = ()  # fields of MjData, such as cinert; costs one mj_forward a decision

    @property
    def model(self) -> mujoco.MjModel:
        """The compiled model, which is shared: do not modify it."""
        return mjcf.load(self.asset)

    def reset(
        self, qpos: Array, qvel: Array, fields: Mapping[str, Array] = MappingProxyType({})
    ) -> PhysicsState:
        """The state at qpos [nq], qvel [nv]; all else is zero.

        fields: of MjModel (`mjcf.FIELDS`), such as body_mass [nbody], which hold in place of the
            model's until the next reset. MuJoCo C computes what follows from them; under MJX the
            softness of contacts and limits stays that of the model's masses: a ball of four times
            the mass then sinks 2.3 times as deep into a floor.

        Raises:
            ValueError: for another number of them, or other fields.
        """
        model = self.model
        own = mjcf.fields(self.asset, fields)
        for name, q, size in (("qpos", qpos, model.nq), ("qvel", qvel, model.nv)):
            if jnp.shape(q) != (size,):
                raise ValueError(f"{name} has the shape {jnp.shape(q)}; the model's has ({size},)")
        sizes = (model.na, model.nv, model.nu, model.nsensordata)
        zeros = [_or_none(jnp.zeros(size, jnp.float32)) for size in sizes]
        moved = (jnp.asarray(q, jnp.float32) for q in (qpos, qvel))
        state = PhysicsState(*moved, *zeros, asset=self.asset, fields=own)
        complete = mjcf.of_acceleration(self.asset).all() and not self.reads
        return state if complete else self._advance(state, 0)

    def step(self, state: PhysicsState, ctrl: Array, n: int) -> PhysicsState:
        """The state after `n` physics steps with constant ctrl [nu], once none is held any more."""
        new = _or_none(jnp.asarray(ctrl, jnp.float32))
        if state.held is None or new is None:
            return self._advance(state.replace(ctrl=new), n)

        def one(_: int, state: PhysicsState) -> PhysicsState:
            assert state.held is not None
            assert state.ctrl is not None
            u, left = jnp.where(state.held > 0, state.ctrl, new), jnp.maximum(state.held - 1, 0)
            return self._advance(state.replace(ctrl=u, held=left), 1)

        return jax.lax.fori_loop(0, n, one, state)

    def sensor(self, state: PhysicsState, name: str) -> Array:
        """The reading [dim] of sensor `name` at `state`."""
        sensor = self.model.sensor(name)
        assert state.sensors is not None
        return state.sensors[sensor.adr[0] : sensor.adr[0] + sensor.dim[0]]

    def read(self, state: PhysicsState, name: str) -> Array:
        """The field `name` of MjData, one of `reads`, at `state`."""
        shapes = [mjcf.shape(self.asset, each) for each in self.reads]
        ends = self.model.nsensordata + np.cumsum([prod(shape) for shape in shapes])
        index = self.reads.index(name)
        assert state.sensors is not None
        return state.sensors[: ends[index]][-prod(shapes[index]) :].reshape(shapes[index])

    def _advance(self, state: PhysicsState, n: int) -> PhysicsState:
        given = (state.qpos, state.qvel, state.act, state.warmstart, state.ctrl)
        inputs = {name: x for name, x in zip(INPUTS, given, strict=True) if x is not None}
        step = self._native if resolve(self.implementation) == "native" else self._accelerated
        qpos, qvel, act, warmstart, sensors = step(inputs, state.fields, n)
        return state.replace(
            qpos=qpos, qvel=qvel, act=_or_none(act), warmstart=warmstart, sensors=_or_none(sensors)
        )

    def _native(self, inputs: dict[str, Array], own: dict[str, Array], n: int) -> list[Array]:
        model, names = self.model, tuple(sorted(own))
        x = jnp.concatenate([*inputs.values(), *(own[name].ravel() for name in names)])
        out = native.stepper(self.asset, self.threads, n, self.reads, names)(x)
        return jnp.split(out, np.cumsum((model.nq, model.nv, model.na, model.nv)))

    def _accelerated(self, inputs: dict[str, Array], own: dict[str, Array], n: int) -> list[Array]:
        from hybrid_rl.envs.mujoco import mjx_warp

        impl = "jax" if resolve(self.implementation) == "mjx" else "warp"
        if own and impl == "warp":
            line = "of the model, which an episode has for itself, are not for MuJoCo Warp"
            raise ValueError(f"fields {line}: use physics=mjx")
        out = mjx_warp.step(self.asset, impl, n, inputs, self.reads, own)
        return [out[name] for name in mjx_warp.OUTPUTS]


def _or_none(x: Array) -> Any:
    """`x`, or None if it has no entries."""
    return x if x.size else None
