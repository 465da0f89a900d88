"""MuJoCo models by file name: XML text and compiled model, both cached.

Source: the MJCF reference of MuJoCo, "XML Reference".
"""

from functools import cache
from pathlib import Path

import mujoco
import numpy as np

FOLDER = Path(__file__).parents[1] / "assets"


def path(asset: str) -> Path:
    """The file of `asset`: a name in `assets`, or an absolute path.

    Raises:
        ValueError: for a file that does not exist.
    """
    file = FOLDER / asset
    if not file.is_file():
        known = ", ".join(sorted(p.name for p in FOLDER.glob("*.xml")))
        raise ValueError(f"no model {str(file)!r}; assets are {known}")
    return file


@cache
def text(asset: str) -> str:
    """The MJCF text of `asset` with its includes expanded."""
    plain = path(asset).read_text(encoding="utf-8")
    if "<include" not in plain:
        return plain
    spec = mujoco.MjSpec.from_file(str(path(asset)))
    spec.compile()
    return spec.to_xml()


@cache
def load(asset: str) -> mujoco.MjModel:
    """The compiled model of `asset`, which is shared: do not modify it.

    Raises:
        ValueError: for a model with automatic resets.
    """
    model = mujoco.MjModel.from_xml_path(str(path(asset)))
    if not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_AUTORESET:
        raise ValueError(
            f'{asset}: write <option><flag autoreset="disable"/></option>, or MuJoCo would '
            "silently reset a simulation that diverged"
        )
    return model


@cache
def of_acceleration(asset: str) -> np.ndarray:
    """[nsensordata] bool: sensors of accelerations, which a step leaves at their last value."""
    model = load(asset)
    stage = mujoco.mjtStage.mjSTAGE_ACC.value
    return np.repeat(model.sensor_needstage == stage, model.sensor_dim)
