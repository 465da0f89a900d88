"""Logs of a robot: commands, and the positions of its joints, with their times."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hybrid_rl import UsageError
from hybrid_rl.tools.identify.system import System


@dataclass(frozen=True)
class Log:
    """Row k: at time t_k the positions were q_k, and the command ctrl_k was sent until t_{k+1}."""

    t: np.ndarray  # [T] [s]
    ctrl: np.ndarray  # [T, nu]
    q: np.ndarray  # [T, nq] [rad, m]
    sensors: np.ndarray | None = None  # [T, ns] of the system's `sensors`

    @property
    def y(self) -> np.ndarray:
        """[T, n] everything that was measured."""
        return self.q if self.sensors is None else np.concatenate((self.q, self.sensors), axis=1)

    def write(self, out: str | Path) -> None:
        """Write it to a file, out.npz."""
        arrays = {"t": self.t, "ctrl": self.ctrl, "q": self.q, "sensors": self.sensors}
        np.savez(out, **{name: each for name, each in arrays.items() if each is not None})


def load(file: str | Path, system: System) -> Log:
    """The log in a file, NAME.npz with t [T], ctrl [T, nu] and q [T, nq].

    Raises:
        UsageError: if the file is no such log, or of another robot.
    """
    try:
        with np.load(file, allow_pickle=False) as held:
            arrays = {name: np.asarray(held[name], float) for name in held}
    except (OSError, ValueError) as error:
        raise UsageError(f"log={file}: cannot be read ({error})") from error
    model, T = system.base, len(arrays.get("t", ()))
    shapes = {"t": (T,), "ctrl": (T, model.nu), "q": (T, model.nq)}
    if system.sensors:
        shapes["sensors"] = (T, sum(int(model.sensor(name).dim[0]) for name in system.sensors))
    for name, shape in shapes.items():
        if name not in arrays or arrays[name].shape != shape or not np.isfinite(arrays[name]).all():
            found = list(arrays[name].shape) if name in arrays else "missing"
            line = f"{name} is {found}; this model needs finite numbers, {list(shape)}"
            raise UsageError(f"log={file}: {line}")
    if T < 20 or (np.diff(arrays["t"]) <= 0).any():
        raise UsageError(f"log={file}: t must rise, over 20 rows or more")
    return Log(arrays["t"], arrays["ctrl"], arrays["q"], arrays.get("sensors"))
