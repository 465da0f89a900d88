"""Numbers that a caller's loop gives."""

from typing import Any

import numpy as np

from hybrid_rl.errors import UsageError, one_line


def numbers(name: str, given: Any, *shape: int, most: float = np.inf) -> np.ndarray:
    """The numbers as float32 [*shape]; most: the largest size of an entry, but for rounding.

    Raises:
        UsageError: for other things, another shape, or numbers that are too large or not finite.
    """
    try:
        with np.errstate(over="ignore"):
            values = np.array(given, np.float32)
    except (TypeError, ValueError) as error:
        raise UsageError(f"{name}: must be numbers {list(shape)} ({one_line(error)})") from error
    if values.shape != shape:
        must = f"[{shape[0]}]" if shape else "one number"
        raise UsageError(f"{name} is {list(values.shape)}; it must be {must}")
    check_finite(name, values)
    if values.size and np.abs(values).max() > most + 1e-5:
        raise UsageError(f"{name}: has an entry of {np.abs(values).max():g}; give at most {most:g}")
    return values


def check_finite(name: str, values: np.ndarray) -> None:
    """Raise UsageError that names the entry, by its last axis, if a number is not finite."""
    if not np.isfinite(values).all():
        entry = f": entry {np.argwhere(~np.isfinite(values))[0, -1]}" if values.ndim else ""
        raise UsageError(f"{name}{entry} is not finite")
