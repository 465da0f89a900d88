"""Figure 7-2 c: a quadcopter's attitude along the first trial of each run, as a strip."""

from typing import Any

import jax
import numpy as np

from hybrid_rl.analysis.style import blank, thousands, words
from hybrid_rl.envs.analytic.quadcopter_se3 import DT, QuadcopterSE3
from hybrid_rl.envs.analytic.state import fully_observed
from hybrid_rl.thesis.studies.falls import Fall, falls

TILES = (0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0)  # [s]
HEIGHT, WIDTH, CROP = 480, 640, 150  # [pixels] of a tile before it is cut to a square around it


def frames(pattern: str) -> tuple[Any, dict[str, Any]]:
    """A strip for each run; the numbers are the heights [m] at the times of the pictures."""
    each = falls(pattern)
    figure = blank(9, 1.5 * len(each))
    parts: Any = np.ravel(np.asarray(figure.subfigures(len(each), 1)))
    heights = {fall.label: _strip(part, fall) for part, fall in zip(parts, each, strict=True)}
    return figure, {"time": list(TILES), "height": heights}


def _strip(part: Any, fall: Fall) -> list[float]:
    """Draw a strip, each attitude at the origin; returns the heights [m]."""
    from hybrid_rl.analysis.drawing import frames

    world = QuadcopterSE3()
    at = [min(round(t / DT), fall.obs.shape[1] - 1) for t in TILES]
    seen = fall.obs[0, at]
    still = np.concatenate([0 * seen[:, :3], seen[:, 3:]], axis=1)
    pose = jax.vmap(lambda x: world.pose(fully_observed(x, x[0])))
    pictures = frames(world.scene(), np.asarray(pose(still)), WIDTH, HEIGHT)
    cut = tuple(slice(c - CROP // 2, c + CROP // 2) for c in (HEIGHT // 2, WIDTH // 2))
    part.suptitle(words(fall.label), fontsize=9, x=0.01, ha="left")
    panels = part.subplots(1, len(TILES))
    for axes, picture, t, x in zip(panels, pictures, TILES, seen, strict=True):
        axes.imshow(picture[cut])
        axes.set(title=f"{t:g} s, {thousands(round(float(x[2]), 1))} m", xticks=[], yticks=[])
        axes.title.set_fontsize(8)
        axes.grid(False)
    return seen[:, 2].tolist()


def lines(numbers: dict[str, Any]) -> list[str]:
    """The height of each run at the end of its strip."""
    end = numbers["time"][-1]
    return [
        f"{label}: {each[-1]:.2f} m after {end:g} s" for label, each in numbers["height"].items()
    ]
