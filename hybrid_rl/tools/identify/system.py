"""A MuJoCo model with unknown parameters, and how its parts take their values.

    joint.elbow.damping: [0.1, 0.9]       ELEMENT.NAME.FIELD[.INDEX] of mujoco.MjSpec: its range
    body.lower.mass: {nominal: 0.8, range: [0.4, 1.6]}    with its inertia; else the model's value
    actuator.elbow.gain: [0.5, 2]         factor on gain, bias and limits of force
    delay: [0, 0.03]                      [s] from a command, or from its effect to the sensor
    noise: 0.001                          of a measured position (standard deviation)
    limits: {elbow: {velocity: 6}}        and position: [low, high]; else the range of the joint
    sensors: [torque]                     of the model that the log has, too

Coordinates z [P] are log theta where a range lies above 0, else theta over the width of its range.
Masses, damping, friction, armature, stiffness and gains carry the unit of a force: multiplied by
one number together, with all others of the model, they move the robot as before.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import yaml

from hybrid_rl import UsageError

DELAY = "delay"
FORCES = (*("mass", "gain", "damping", "frictionloss", "armature", "stiffness"),)
NOISE = 1e-3  # [rad, m] of a position, where nothing says another


@dataclass(frozen=True)
class System:
    """A model and its unknown parameters theta [P], in the order of `names`."""

    file: Path
    names: tuple[str, ...]
    nominal: np.ndarray  # [P]
    low: np.ndarray  # [P] least value
    high: np.ndarray  # [P]
    noise: float
    sensors: tuple[str, ...]
    bounds: np.ndarray  # [3, nv] of `limits`
    spec: Any
    base: mujoco.MjModel  # as the file has it

    @property
    def logs(self) -> np.ndarray:
        """[P] whether a coordinate is a logarithm."""
        return self.low > 0

    @property
    def forces(self) -> np.ndarray:
        """[P] whether a parameter has the unit of a force."""
        return np.array([name.split(".")[-1] in FORCES for name in self.names])

    def z(self, theta: np.ndarray) -> np.ndarray:
        """Coordinates [..., P] of values."""
        logs = np.log(np.where(self.logs, theta, 1.0))
        return np.where(self.logs, logs, theta / (self.high - self.low))

    def theta(self, z: np.ndarray) -> np.ndarray:
        """Values [..., P] at coordinates."""
        return np.where(self.logs, np.exp(np.where(self.logs, z, 0)), z * (self.high - self.low))

    def scale(self, theta: np.ndarray) -> np.ndarray:
        """[P] the direction in z in which all parameters of a force go up by one factor."""
        return self.forces * np.where(self.logs, 1.0, theta / (self.high - self.low))

    def draw(self, count: int, seed: int = 0) -> np.ndarray:
        """[count, P] values, uniform in the coordinates of their ranges."""
        random = np.random.default_rng(seed)
        return self.theta(random.uniform(self.z(self.low), self.z(self.high), (count, self.size)))

    @property
    def size(self) -> int:
        """P."""
        return len(self.names)

    def delay(self, theta: np.ndarray) -> float:
        """[s] the delay among values [P]; 0 where it is none of them."""
        return float(theta[self.names.index(DELAY)]) if DELAY in self.names else 0.0

    def described(self, theta: np.ndarray) -> Any:
        """The MjSpec with these values [P]; it is shared, until the next call."""
        for name, value in zip(self.names, theta, strict=True):
            if name != DELAY:
                _set(self.spec, self.base, name, float(value))
        return self.spec

    def model(self, theta: np.ndarray) -> mujoco.MjModel:
        """The compiled model with these values [P]."""
        return self.described(theta).compile()


def read(model: str | Path, parameters: str | Path | Mapping[str, Any]) -> System:
    """A model (MJCF) with the parameters of a file or of a mapping.

    Raises:
        UsageError: for a name that the model lacks, or a range from high to low.
    """
    try:
        spec = mujoco.MjSpec.from_file(str(model))
        base = spec.compile()
    except ValueError as error:
        raise UsageError(f"model={model}: {error}") from error
    given: Any = parameters
    if not isinstance(given, Mapping):
        try:
            given = yaml.safe_load(Path(given).read_text(encoding="utf-8"))
        except (OSError, yaml.YAMLError) as error:
            raise UsageError(f"parameters={parameters}: cannot be read ({error})") from error
    given = dict(given)
    noise, sensors = float(given.pop("noise", NOISE)), tuple(given.pop("sensors", ()))
    bounds = _bounds(base, given.pop("limits", {}))
    for name in given:
        if name.startswith("body."):
            _explicit(spec, base, name.split(".")[1])
    rows = [_row(spec, base, name, value) for name, value in given.items()]
    nominal, low, high = np.array(rows, float).reshape(-1, 3).T
    names = tuple(given)
    return System(Path(model), names, nominal, low, high, noise, sensors, bounds, spec, base)


def _row(spec: Any, base: mujoco.MjModel, name: str, value: Any) -> tuple[float, float, float]:
    """Nominal value, low and high of a parameter."""
    value = value if isinstance(value, Mapping) else {"range": value}
    try:
        own = value["range"][0] if name == DELAY else _get(spec, base, name)
        nominal = value.get("nominal", own)
        low, high = value.get("range") or (nominal / 2, nominal * 2)
        right = bool(low < high and low <= nominal <= high)
    except (AttributeError, IndexError, TypeError, ValueError, KeyError) as error:
        line = "must be ELEMENT.NAME.FIELD of the model, with a range [low, high]"
        raise UsageError(f"parameters: {name}: {line} ({error})") from error
    if not right:
        line = f"the nominal value {nominal:g} must lie in its range, [{low:g}, {high:g}]"
        raise UsageError(f"parameters: {name}: {line}")
    return float(nominal), float(low), float(high)


def _get(spec: Any, base: mujoco.MjModel, name: str) -> float:
    """The value of a parameter in the model."""
    kind, element, attribute, *index = name.split(".")
    if (kind, attribute) == ("actuator", "gain"):
        return float(base.actuator(element).id >= 0)  # 1, or a KeyError
    found = getattr(getattr(spec, kind)(element), attribute)
    return float(found[int(index[0]) if index else 0] if np.ndim(found) else found)


def _set(spec: Any, base: mujoco.MjModel, name: str, value: float) -> None:
    """Give a parameter of `spec` a value; base: the model that has the factors 1."""
    kind, element, attribute, *index = name.split(".")
    part = getattr(spec, kind)(element)
    if (kind, attribute) == ("actuator", "gain"):
        for field in ("gainprm", "biasprm", "forcerange"):
            getattr(part, field)[:] = value * getattr(base.actuator(element), field)
    elif (kind, attribute) == ("body", "mass"):
        part.mass = value
        part.inertia[:] = value / base.body(element).mass * base.body(element).inertia
    elif np.ndim(getattr(part, attribute)):
        getattr(part, attribute)[int(index[0]) if index else 0] = value
    else:
        setattr(part, attribute, value)


def _explicit(spec: Any, base: mujoco.MjModel, name: str) -> None:
    """Write mass and inertia of a body down, which may follow from its geoms."""
    part = spec.body(name)
    if part is None:
        raise UsageError(f"parameters: body.{name}: the model has no such body")
    known = base.body(name)
    part.explicitinertial, part.mass, part.fullinertia[0] = True, float(known.mass[0]), np.nan
    part.inertia[:], part.ipos[:], part.iquat[:] = known.inertia, known.ipos, known.iquat


def _bounds(model: mujoco.MjModel, limits: Mapping[str, Any]) -> np.ndarray:
    """[3, nv] least and greatest position, and greatest speed, of each degree of freedom."""
    result = np.full((3, model.nv), np.inf)
    result[0] = -np.inf
    for i in range(model.njnt):
        joint = model.joint(i)
        own = limits.get(joint.name, {})
        at = slice(int(joint.dofadr[0]), int(joint.dofadr[0]) + (1 if joint.type[0] > 1 else 0))
        position = own.get("position", joint.range if model.jnt_limited[i] else None)
        if position is not None:
            result[0, at], result[1, at] = position
        result[2, at] = own.get("velocity", np.inf)
    if unknown := {*limits} - {model.joint(i).name for i in range(model.njnt)}:
        raise UsageError(f"parameters: limits: the model has no joint {sorted(unknown)[0]}")
    return result
