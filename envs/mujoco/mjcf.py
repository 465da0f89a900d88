"""MuJoCo models by name: XML text and compiled model, both cached.

    sawyer_torque.xml                                              a file
    sawyer_torque.xml?joint.j0.damping=10.0?geom.rod.mass=0.55     a file with other values
    <mujoco> ... </mujoco>                                         MJCF text is its own name

Source: the MJCF reference of MuJoCo, "XML Reference".
"""

from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

import mujoco
import numpy as np

FOLDER = Path(__file__).parents[1] / "assets"
FOR_SENSORS = ("cacc", "cfrc_int", "cfrc_ext")  # fields of MjData, for these sensors:
DYNAMIC = [
    getattr(mujoco.mjtSensor, f"mjSENS_{name}").value
    for name in ("ACCELEROMETER", "FORCE", "TORQUE", "FRAMELINACC", "FRAMEANGACC")
]


def path(asset: str) -> Path:
    """The file of `asset`: a name in `assets`, or an absolute path.

    Raises:
        ValueError: for a file that does not exist.
    """
    file = FOLDER / asset
    if not file.is_file():
        if Path(asset).is_absolute():
            raise ValueError(f"{asset}: no such file")
        known = ", ".join(sorted(p.name for p in FOLDER.glob("*.xml")))
        raise ValueError(f"no model {str(file)!r}; assets are {known}")
    return file


@cache
def text(asset: str) -> str:
    """The MJCF text of the file `asset` with its includes expanded."""
    plain = path(asset).read_text(encoding="utf-8")
    if "<include" not in plain:
        return plain
    spec = mujoco.MjSpec.from_file(str(path(asset)))
    spec.compile()
    return spec.to_xml()


def friction(pairs: Iterable[str], coefficient: float) -> dict[str, float]:
    """`values` of `changed` that give these pairs a coefficient of sliding friction."""
    return {f"pair.{pair}.friction.{i}": coefficient for pair in pairs for i in (0, 1)}


def changed(asset: str, values: Mapping[str, float]) -> str:
    """The name of `asset` with other values, for `load`.

    values: ELEMENT.NAME.FIELD of mujoco.MjSpec -> value; of a vector its first entry, or that of
        ELEMENT.NAME.FIELD.INDEX.
    """
    return "?".join([asset, *(f"{key}={float(value)!r}" for key, value in values.items())])


def spec(asset: str) -> mujoco.MjSpec:
    """A new description of `asset`, which may be modified.

    Raises:
        ValueError: that names the file, for one that is no model.
    """
    if asset.lstrip().startswith("<"):
        return mujoco.MjSpec.from_string(asset)
    file, *values = asset.split("?")
    try:
        result = mujoco.MjSpec.from_file(str(path(file)))
    except ValueError as error:
        line = str(error)
        raise ValueError(line if file in line else f"{file}: {line}") from error
    for change in values:
        key, _, value = change.partition("=")
        _set(result, key, float(value))
    return result


@cache
def load(asset: str) -> mujoco.MjModel:
    """The compiled model of `asset`, which is shared: do not modify it.

    Raises:
        ValueError: for a model with automatic resets.
    """
    model = spec(asset).compile()
    if not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_AUTORESET:
        raise ValueError(
            f'{asset}: write <option><flag autoreset="disable"/></option>, or MuJoCo would '
            "silently reset a simulation that diverged"
        )
    return model


@cache
def shape(asset: str, name: str) -> tuple[int, ...]:
    """The shape of the field `name` of MjData of `asset`.

    Raises:
        ValueError: for a field that MuJoCo computes only for sensors which `asset` lacks.
    """
    model = load(asset)
    if name in FOR_SENSORS and not np.isin(model.sensor_type, DYNAMIC).any():
        raise ValueError(f"{asset}: MuJoCo computes {name} for a <framelinacc> sensor: add one")
    return getattr(mujoco.MjData(model), name).shape


def _set(spec: mujoco.MjSpec, key: str, value: float) -> None:
    """Set ELEMENT.NAME.FIELD[.INDEX] of `spec`."""
    kind, name, field, *index = key.split(".")
    element = getattr(spec, kind)(name)
    if np.ndim(getattr(element, field)):
        getattr(element, field)[int(index[0]) if index else 0] = value
    else:
        setattr(element, field, value)


@cache
def of_acceleration(asset: str) -> np.ndarray:
    """[nsensordata] bool: sensors of accelerations, which a step leaves at their last value."""
    model = load(asset)
    stage = mujoco.mjtStage.mjSTAGE_ACC.value
    return np.repeat(model.sensor_needstage == stage, model.sensor_dim)
