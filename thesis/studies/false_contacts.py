"""False contacts: readings of a contact where there was none, and what became of them.

wrong      share of the readings that differ from the true contact
count      false contacts of a trial
rejected   share of their positions with p < 1/2 at the end
returned   time within 5 cm of their positions, once the robot had left, divided by the time that
           it would have spent there at the density of all free positions
elsewhere  the same of as many positions without a contact in the reading

Source: thesis section 5.4, where false contacts are averaged out by returning to them.
"""

from typing import Any

import numpy as np
from scipy import ndimage

from hybrid_rl.thesis.studies.contacts import CLOSE, Trials, distances, grid
from hybrid_rl.thesis.studies.numbers import band_of

TOUCH = "world/touch"


def measures(run: Trials, f: np.ndarray) -> dict[str, Any]:
    """Measures of all trials, from the last maps f [S, GRID, GRID]; {} without false contacts."""
    touch = run.rows.get(TOUCH)
    if touch is None or np.isnan(touch).any() or not _false(run.y, touch).any():
        return {}
    free = distances(run.world, grid(run.world)) > run.world.radius
    each: dict[str, list[float]] = {"wrong": [], "count": [], "rejected": [], "returned": []}
    each["elsewhere"] = []
    for i, (s, y) in enumerate(zip(run.s, run.y, strict=True)):
        false = np.flatnonzero(_false(y, touch[i]))
        each["wrong"].append(float((y != touch[i]).mean()))
        each["count"].append(len(false))
        if not len(false):
            continue
        each["rejected"].append(float((_at(run.world, f[i], s[false]) < 0).mean()))
        quiet = np.flatnonzero(y < 0.5)
        others = quiet[np.linspace(0, len(quiet) - 1, len(false)).astype(int)]
        for name, when in (("returned", false), ("elsewhere", others)):
            ratio = returned(run.world, free, s, when)
            each[name] += [ratio] if np.isfinite(ratio) else []
    known = {name: np.array(values, float) for name, values in each.items() if values}
    return {name: {**band_of(values), "each": values} for name, values in known.items()}


def returned(world: Any, free: np.ndarray, s: np.ndarray, when: np.ndarray) -> float:
    """Time that a path s [T, 2] spent near s[when] after it left, relative to the expected time.

    free: [GRID, GRID] whether a position of the grid is free. NaN if the path left none of them.
    """
    points, spent, expected = grid(world)[free], 0.0, 0.0
    for t in when:
        near = np.linalg.norm(s[t:] - s[t], axis=-1) < CLOSE
        left = int(np.argmin(near))  # the first decision outside; 0: it never left
        if not near[left]:
            area = (np.linalg.norm(points - s[t], axis=-1) < CLOSE).mean()
            spent += near[left:].sum()
            expected += area * len(near[left:])
    return spent / expected if expected else np.nan


def _false(y: np.ndarray, touch: np.ndarray) -> np.ndarray:
    return (y > 0.5) & (touch < 0.5)


def _at(world: Any, f: np.ndarray, s: np.ndarray) -> np.ndarray:
    """f at positions s [K, 2], bilinear; the nearest value outside of the box."""
    low, high = np.array(world.low), np.array(world.high)
    index = (s - low) / (high - low) * (len(f) - 1)
    return ndimage.map_coordinates(f, index.T, order=1, mode="nearest")
