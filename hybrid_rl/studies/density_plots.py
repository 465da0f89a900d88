"""Densities on the unit square as pictures, all on one scale of colours."""

from typing import Any

import numpy as np

from hybrid_rl.studies.style import STYLE

BRIGHTEST = 8.0  # density, of mean one, at the end of the colours


def subplots(down: int, across: int) -> tuple[Any, Any]:
    """A figure, and its panels [down, across]."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(3.4 * across, 3.1 * down), layout="constrained")
        return figure, figure.subplots(down, across, squeeze=False)


def show(panel: Any, picture: np.ndarray, title: str) -> None:
    """A picture of the unit square, on one scale of colours."""
    square: Any = {"origin": "lower", "extent": (0, 1, 0, 1), "cmap": "viridis"}
    panel.imshow(picture, vmin=0, vmax=BRIGHTEST, **square)
    panel.set(title=title, xlim=(0, 1), ylim=(0, 1), xticks=[0, 1], yticks=[0, 1])
    panel.grid(False)


def colour_bar(figure: Any, panels: np.ndarray) -> None:
    """The one scale of colours of `panels`, named."""
    image = panels.flat[0].images[0]
    bar = figure.colorbar(image, ax=list(panels.flat), extend="max", shrink=0.6, aspect=30)
    bar.set_label("Density (mean 1), one scale for all")
