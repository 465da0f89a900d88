"""Numbers with the digits that a JSON file needs."""

from collections.abc import Sequence
from typing import Any

import numpy as np


def rounded(value: Any, digits: int = 4) -> Any:
    """All floats of a nested value in so many significant digits; arrays become lists."""
    if isinstance(value, dict):
        return {name: rounded(each, digits) for name, each in value.items()}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [rounded(each, digits) for each in value]
    return float(f"{value:.{digits}g}") if isinstance(value, float | np.floating) else value
