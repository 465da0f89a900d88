"""Another body in each episode, of an environment in MuJoCo (domain randomisation).

    m_i, I_i  <-  mass m_i, mass I_i          every body
    m_1       <-  m_1 + payload               at the root's centre of mass, after the factor `mass`
    mu        <-  friction mu                 sliding friction of every geom and contact pair
    d         <-  damping d                   of every joint
    tau_j     <-  motors_j tau_j              at the same action; each motor has its own factor
    elements: by ELEMENT.NAME.FIELD, the value itself; actuator.NAME.gain is a factor as motors_j,
              also on the limits of force. A mapping, or the YAML file that `identify` writes.

Each number is uniform in its range, drawn at the reset, on top of what `Body` has changed.

Source: Peng et al. 2018, "Sim-to-real transfer of robotic control with dynamics randomization".
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import yaml
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.errors import UsageError
from hybrid_rl.fields import FieldError, NotNegative, Positive, part

FACTORS = ("mass", "friction", "damping", "motors", "payload")
ELEMENTS = {  # ELEMENT.FIELD -> fields of MjModel that get the value, or are multiplied
    **{f"joint.{name}": (f"dof_{name}",) for name in ("damping", "frictionloss", "armature")},
    "joint.stiffness": ("jnt_stiffness",),
    "body.mass": ("body_mass", "body_inertia"),
    "actuator.gain": ("actuator_gainprm", "actuator_biasprm", "actuator_forcerange"),
}


@part
class Ranges:
    """[low, high] of each number; None: as it is in the model."""

    mass: tuple[Positive, Positive] | None = None
    friction: tuple[Positive, Positive] | None = None
    damping: tuple[NotNegative, NotNegative] | None = None
    motors: tuple[Positive, Positive] | None = None
    payload: tuple[NotNegative, NotNegative] | None = None  # [kg]
    elements: Mapping[str, Any] | str | None = None  # by name, or a YAML file of them

    def __post_init__(self) -> None:
        object.__setattr__(self, "elements", _listed(self) or None)

    def draw(self, state: PhysicsState, motors: int, key: Array) -> PhysicsState:
        """`state` with another body, whose first actuators are the `motors`. Consumes the key."""
        model, own = mjcf.load(state.asset), dict(state.fields)
        keys = jax.random.split(key, len(FACTORS))

        def now(name: str) -> Array:
            return own.get(name, jnp.asarray(getattr(model, name), jnp.float32))

        def draw(i: int, pair: tuple[float, ...], shape: tuple[int, ...] = ()) -> Array:
            return jax.random.uniform(keys[i], shape, jnp.float32, *sorted(pair))

        if self.mass is not None:
            factor = draw(0, self.mass)
            own |= {name: factor * now(name) for name in ("body_mass", "body_inertia")}
        if self.friction is not None:
            factor = draw(1, self.friction)
            own["geom_friction"] = now("geom_friction").at[:, 0].multiply(factor)
            if model.npair:
                own["pair_friction"] = now("pair_friction").at[:, :2].multiply(factor)
        if self.damping is not None:
            own["dof_damping"] = draw(2, self.damping) * now("dof_damping")
        if self.motors is not None:
            factor = draw(3, self.motors, (min(motors, model.nu), 1))
            for name in ("actuator_gainprm", "actuator_biasprm"):
                own[name] = now(name).at[: len(factor)].multiply(factor)
        if self.payload is not None:
            own["body_mass"] = now("body_mass").at[1].add(draw(4, self.payload))
        for i, (name, pair) in enumerate(_listed(self), len(FACTORS)):
            names, at, nominal = _found(state.asset, name)
            value = jax.random.uniform(jax.random.fold_in(key, i), (), jnp.float32, *pair)
            for field in names:
                one = now(field).at[at]
                own[field] = one.multiply(value / nominal) if nominal else one.set(value)
        return state.replace(fields=own)


def _listed(ranges: Ranges) -> tuple[tuple[str, tuple[float, float]], ...]:
    """The elements as (name, (low, high)) each, which can be hashed; those of a file are read."""
    given = ranges.elements
    try:
        if isinstance(given, str):
            given = yaml.safe_load(Path(given).read_text(encoding="utf-8"))
        named = dict(given or {}).items()
        return tuple(sorted((name, (float(a), float(b))) for name, (a, b) in named))
    except (OSError, yaml.YAMLError, TypeError, ValueError) as error:
        line = f"must be {{ELEMENT.NAME.FIELD: [low, high]}}, or a YAML file of that ({error})"
        raise FieldError(ranges, "elements", line) from error


def _found(asset: str, name: str) -> tuple[tuple[str, ...], int, float]:
    """The fields of an element, its index there, and what to divide its value by; 0: it is set."""
    model = mjcf.load(asset)
    try:
        kind, element, attribute = name.split(".")
        names = ELEMENTS[f"{kind}.{attribute}"]
        found = getattr(model, kind)(element)
    except (KeyError, ValueError) as error:
        known = ", ".join(ELEMENTS)
        line = f"must name an element of the model, with one of {known}"
        raise UsageError(f"episode.randomise.elements: {name}: {line}") from error
    at = int(found.dofadr[0]) if names[0].startswith("dof_") else found.id
    return names, at, float(found.mass[0]) if kind == "body" else float(kind == "actuator")
