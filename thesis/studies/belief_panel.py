"""A top view of a belief over a plane: shading, outlines, the path so far, the contacts.

One panel is used for all frames of a video: `show` changes what it has drawn before.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from hybrid_rl.analysis.style import COLOURS

TRUTH, OUTLINE, PATH, BOX = "#444444", COLOURS[2], COLOURS[1], "#888888"

MANY = 20  # outlines, above which each is thin
HALF = "p(contact) = 1/2"


class View(NamedTuple):
    """What a panel shows at one time."""

    values: np.ndarray | None  # [G, G] shading, first index along x; None: white
    outlines: list[np.ndarray]  # [k, 2] each: lines of the belief
    path: np.ndarray  # [t, 2]
    contacts: np.ndarray  # [n, 2]


def level(values: np.ndarray, low: Any, high: Any, at: float) -> list[np.ndarray]:
    """Lines [k, 2] on which values [G, G] in the box from low [2] to high [2] are `at`."""
    from contourpy import contour_generator

    x, y = (np.linspace(a, b, n) for a, b, n in zip(low, high, values.shape, strict=True))
    lines: Any = contour_generator(x, y, values.T).lines(at)
    return lines


class Panel:
    """The top view on `axes`, of the box from low [2] to high [2]."""

    def __init__(
        self,
        axes: Any,
        low: Sequence[float],
        high: Sequence[float],
        truth: list[np.ndarray],
        limits: tuple[float, float] = (0.0, 1.0),
        thick: float = 1.0,  # factor of line widths
    ) -> None:
        from matplotlib.collections import LineCollection

        extent = (low[0], high[0], low[1], high[1])
        nothing: Any = np.zeros((1, 1))
        low_value, high_value = limits
        self._shading = axes.imshow(
            nothing,
            origin="lower",
            extent=extent,
            cmap="Purples",
            vmin=low_value,
            vmax=high_value + 0.5 * (high_value - low_value),  # lines stay visible on it
            interpolation="bilinear",
        )
        self._outlines = LineCollection([], colors=OUTLINE)
        self._truth = LineCollection(truth, colors=TRUTH, linewidths=0.8 * thick, zorder=2.5)
        axes.add_collection(self._outlines)
        axes.add_collection(self._truth)
        self._thick = thick
        self._path = axes.plot([], [], color=PATH, linewidth=0.6 * thick)[0]
        self._contacts = axes.plot([], [], ".", color="#000000", markersize=2.0 * thick)[0]
        axes.set(xlim=extent[:2], ylim=extent[2:], xticks=[], yticks=[], aspect="equal")
        axes.grid(False)
        axes.spines[:].set(visible=True, linewidth=0.6, color=BOX)

    def show(self, view: View) -> None:
        """Draw `view` instead of what was drawn before."""
        values: Any = np.zeros((1, 1)) if view.values is None else view.values.T
        self._shading.set_data(values)
        self._outlines.set_segments(view.outlines)
        many = len(view.outlines) > MANY
        self._outlines.set_linewidth((0.5 if many else 1.0) * self._thick)
        self._outlines.set_alpha(0.5 if many else 1.0)
        self._path.set_data(*view.path.T)
        self._contacts.set_data(*view.contacts.T)

    def name(self, outlines: str) -> None:
        """Labels for a legend; those of `outlines` are the caller's."""
        self._path.set_label("path")
        if outlines:
            self._truth.set_label("true outline")
            self._outlines.set_label(outlines)
            self._contacts.set_label("measured contact")
