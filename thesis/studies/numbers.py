"""Numbers as the JSON of a picture has them."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from hybrid_rl.analysis.curves import band, iqm


def rounded(value: Any) -> Any:
    """All floats of a nested value in four significant digits; arrays become lists."""
    if isinstance(value, dict):
        return {name: rounded(each) for name, each in value.items()}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [rounded(each) for each in value]
    return float(f"{value:.4g}") if isinstance(value, float | np.floating) else value


def banded(values: np.ndarray) -> list[Any]:
    """The IQM and the ends of its band, over the first axis: [n, ...] -> three of [...]."""
    return [iqm(values), *band(values)]


def band_of(values: np.ndarray) -> dict[str, Any]:
    """What `banded` returns, as the JSON of a picture has it."""
    return dict(zip(("iqm", "low", "high"), banded(values), strict=True))
