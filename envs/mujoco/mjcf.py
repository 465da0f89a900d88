"""MuJoCo models by name: XML text and compiled model, both cached.

    sawyer_torque.xml                                              a file
    sawyer_torque.xml?joint.j0.damping=10.0?geom.rod.mass=0.55     a file with other values
    hopper.xml?mass=1.5?motor.2=0.3                                a file with another body
    <mujoco> ... </mujoco>?mass=1.5                                MJCF text is its own name

Source: the MJCF reference of MuJoCo, "XML Reference".
"""

from collections.abc import Callable, Iterable, Mapping
from functools import cache
from operator import attrgetter
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import mujoco
import numpy as np
from jax import Array

FOLDER = Path(__file__).parents[1] / "assets"
FIELDS = (  # of MjModel that an episode may have for itself; MJX takes others as constants
    *("body_mass", "body_inertia", "body_ipos", "geom_friction", "pair_friction", "dof_damping"),
    *("dof_armature", "jnt_stiffness", "actuator_gainprm", "actuator_biasprm", "actuator_gear"),
    *("dof_frictionloss", "actuator_forcerange", "opt.gravity"),
)
FOR_SENSORS = ("cacc", "cfrc_int", "cfrc_ext")  # fields of MjData, for these sensors:
DYNAMIC = [
    getattr(mujoco.mjtSensor, f"mjSENS_{name}").value
    for name in ("ACCELEROMETER", "FORCE", "TORQUE", "FRAMELINACC", "FRAMEANGACC")
]


def path(asset: str) -> Path:
    """The file of `asset`: a name in `assets`, or an absolute path."""
    file = FOLDER / asset
    if not file.is_file():
        raise ValueError(f"{file}: no such file")
    return file


@cache
def text(asset: str) -> str:
    """The MJCF text of `asset` with its includes expanded."""
    plain = asset if _is_text(asset) else path(asset).read_text(encoding="utf-8")
    if "<include" not in plain:
        return plain
    spec = mujoco.MjSpec.from_file(str(path(asset)))
    spec.compile()
    return spec.to_xml()


def scene(asset: str) -> Callable[[Any], str]:
    """The method `scene` of a world that is drawn by the file `asset`."""

    def scene(self: Any) -> str:
        """MJCF text of the scene for rendering."""
        return text(asset)

    return scene


def friction(pairs: Iterable[str], coefficient: float) -> dict[str, float]:
    """`values` of `changed` that give these pairs a coefficient of sliding friction."""
    return {f"pair.{pair}.friction.{i}": coefficient for pair in pairs for i in (0, 1)}


def changed(asset: str, values: Mapping[str, float]) -> str:
    """The name of `asset` with other values, for `load`.

    values: ELEMENT.NAME.FIELD of mujoco.MjSpec -> value; of a vector its first entry, or that of
        ELEMENT.NAME.FIELD.INDEX. Of the whole model, once compiled: the factors mass, friction
        and motor.INDEX, and payload [kg]; `body` has their equations.
    """
    return "?".join([asset, *(f"{key}={float(value)!r}" for key, value in values.items())])


def spec(asset: str) -> mujoco.MjSpec:
    """A new description of `asset`, which may be modified; without changes of the whole model."""
    file, values = _split(asset)
    try:
        if _is_text(file):
            result = mujoco.MjSpec.from_string(file)
        else:
            result = mujoco.MjSpec.from_file(str(path(file)))
    except ValueError as error:
        line = str(error)
        raise ValueError(line if file in line else f"{file}: {line}") from error
    for key, value in values.items():
        if not _whole(key):
            _set(result, key, value)
    return result


def _is_text(asset: str) -> bool:
    return asset.lstrip().startswith("<")


def _split(asset: str) -> tuple[str, dict[str, float]]:
    """The file that `asset` names, and its other values."""
    text, end, rest = asset.rpartition("</mujoco>")  # MJCF text may have question marks
    file, *values = rest.split("?")
    file = text + end + file
    pairs = (each.partition("=") for each in values)
    return file, {key: float(value) for key, _, value in pairs}


def _whole(key: str) -> bool:
    """Whether a key of `changed` is of the whole model, not of an element."""
    return key.count(".") < 2


@cache
def load(asset: str) -> mujoco.MjModel:
    """The compiled model of `asset`, which is shared: do not modify it.

    A simulation that diverges is never reset silently, whatever the file says.
    """
    given = spec(asset)
    try:
        model = given.compile()
    except ValueError as error:
        raise ValueError(f"{asset}: {error}") from error
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    if whole := {key: value for key, value in _split(asset)[1].items() if _whole(key)}:
        _change(model, whole)
    return model


@cache
def shape(asset: str, name: str) -> tuple[int, ...]:
    """The shape of the field `name` of MjData of `asset`."""
    model = load(asset)
    if name in FOR_SENSORS and not np.isin(model.sensor_type, DYNAMIC).any():
        raise ValueError(f"{asset}: MuJoCo computes {name} for a <framelinacc> sensor: add one")
    return getattr(mujoco.MjData(model), name).shape


def fields(asset: str, values: Mapping[str, Array]) -> dict[str, Array]:
    """`values` of fields of MjModel of `asset`, by name, in float32."""
    given = {name: jnp.asarray(x, jnp.float32) for name, x in values.items()}
    for name, x in given.items():
        if name not in FIELDS:
            raise ValueError(f"fields: {name} is none of {', '.join(FIELDS)}")
        now = attrgetter(name)(load(asset)).shape
        if x.shape != now:
            raise ValueError(f"fields: {name} is {list(x.shape)}; the model's is {list(now)}")
    return given


def _set(spec: mujoco.MjSpec, key: str, value: float) -> None:
    """Set ELEMENT.NAME.FIELD[.INDEX] of `spec`."""
    kind, name, field, *index = key.split(".")
    element = getattr(spec, kind)(name)
    if np.ndim(getattr(element, field)):
        getattr(element, field)[int(index[0]) if index else 0] = value
    else:
        setattr(element, field, value)


def _change(model: mujoco.MjModel, values: Mapping[str, float]) -> None:
    """Change the whole of a compiled model: mass, friction, motor.INDEX, payload, in this order."""
    mass = values.get("mass", 1.0)
    model.body_mass[:] *= mass
    model.body_inertia[:] *= mass
    model.body_mass[1] += values.get("payload", 0.0)  # of the root
    friction = values.get("friction", 1.0)
    model.geom_friction[:, 0] *= friction
    model.pair_friction[:, :2] *= friction
    for key, factor in values.items():
        name, _, index = key.partition(".")
        if name == "motor":
            model.actuator_gainprm[int(index)] *= factor
            model.actuator_biasprm[int(index)] *= factor
            model.actuator_forcerange[int(index)] *= factor
    mujoco.mj_setConst(model, mujoco.MjData(model))  # what follows from masses and gains
    model.stat.meaninertia = model.dof_M0.mean()  # except for this, a scale of the solver


@cache
def of_acceleration(asset: str) -> np.ndarray:
    """[nsensordata] bool: sensors of accelerations, which a step leaves at their last value."""
    model = load(asset)
    stage = mujoco.mjtStage.mjSTAGE_ACC.value
    return np.repeat(model.sensor_needstage == stage, model.sensor_dim)
