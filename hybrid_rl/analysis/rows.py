"""A row for each method: points with their bands."""

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from hybrid_rl.analysis.style import BLACK, colours, words

ROW = 34  # [characters] of a line of the name of a row
HEIGHT = 0.34  # [in] of a row


def points(
    axes: Any, spreads: Mapping[str, Any], marks: Sequence[str] = (), entries: Iterable[str] = ()
) -> None:
    """Middle, low and high [K, 3] of each label above each other; the later a point, the fuller.

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
    name(axes, entries or map(words, spreads))


def _face(colour: str, k: int, most: int) -> dict[str, Any]:
    """The k-th of `most` points: from white to its colour."""
    from matplotlib.colors import to_rgb

    share = (k + 1) / most if most != 2 else k  # of two, one is white
    return {"color": colour, "mfc": [1 - share * (1 - part) for part in to_rgb(colour)]}


def name(axes: Any, entries: Iterable[str]) -> None:
    """The names of the rows, the first one above."""
    names = [textwrap.fill(entry, ROW) for entry in entries]
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.5, -0.5)
