"""A row for each method, with a dot for each of its trials."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from hybrid_rl.analysis.style import BLACK, colours, name_rows, words

NEVER = 1.1, 1.25, 1.4  # over the end of an axis: where it is grey, the dots there, its right edge


def dots(axes: Any, each: Mapping[str, Any], end: float) -> None:
    """A dot for each trial's value [S] up to `end`, and their median; without one, in the grey."""
    own = colours(each)
    for row, (label, values) in enumerate(each.items()):
        shown = np.minimum(np.nan_to_num(np.asarray(values, float), nan=np.inf), NEVER[1] * end)
        spread = row + np.linspace(-0.25, 0.25, len(shown))
        axes.plot(np.sort(shown), spread, "o", ms=3, alpha=0.6, color=own[label])
        middle = np.quantile(shown, 0.5, method="inverted_cdf")
        axes.plot([middle, middle], [row - 0.35, row + 0.35], color=BLACK, lw=1.5)
    axes.axvspan(NEVER[0] * end, NEVER[2] * end, color="#EEEEEE", lw=0)
    axes.set_xlim(None, NEVER[2] * end)
    name_rows(axes, map(words, each))
