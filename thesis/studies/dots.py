"""A row for each method, with a dot for each of its trials, or points with their bands."""

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from hybrid_rl.analysis.style import BLACK, colours, words

ROW_WIDTH = 34  # [characters] of a line of the name of a row of points
ROW_HEIGHT = 0.34  # [in]
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


def row_points(
    axes: Any, spreads: Mapping[str, Any], marks: Sequence[str] = (), entries: Iterable[str] = ()
) -> None:
    """A row for each label, of K points with their bands, [K, 3]; the later a point, the fuller.

    marks: what the K points are, for a legend that the caller draws.
    entries: names of the rows instead of the labels.
    """
    own, most = colours(spreads), max(map(len, spreads.values()))
    for row, (label, each) in enumerate(spreads.items()):
        colour = own[label]
        for k, (middle, low, high) in enumerate(each):
            y = row + 0.7 * ((k + 0.5) / most - 0.5)
            axes.plot([low, high], [y, y], color=colour, lw=1.2, zorder=2)
            axes.plot(middle, y, "o", ms=4.5, **_face(colour, k, most))
    for k, mark in enumerate(marks):
        axes.plot([], [], "o", ms=4.5, label=mark, **_face(BLACK, k, len(marks)))
    name_rows(axes, entries or map(words, spreads))


def _face(colour: str, k: int, most: int) -> dict[str, Any]:
    """The k-th of `most` points: from white to its colour."""
    from matplotlib.colors import to_rgb

    share = (k + 1) / most if most != 2 else k  # of two, one is white
    return {"color": colour, "mfc": [1 - share * (1 - part) for part in to_rgb(colour)]}


def name_rows(axes: Any, entries: Iterable[str]) -> None:
    """The names of the rows, the first one above."""
    names = [textwrap.fill(entry, ROW_WIDTH) for entry in entries]
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.5, -0.5)
