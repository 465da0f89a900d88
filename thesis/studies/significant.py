"""Numbers with the digits that a JSON file needs."""

from collections.abc import Sequence
from typing import Any

import numpy as np


def rounded(value: Any) -> Any:
    """All floats of a nested value in four significant digits; arrays become lists."""
    if isinstance(value, dict):
        return {name: rounded(each) for name, each in value.items()}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [rounded(each) for each in value]
    return float(f"{value:.4g}") if isinstance(value, float | np.floating) else value
