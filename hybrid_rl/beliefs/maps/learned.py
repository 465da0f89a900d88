"""p(y = 1 | s) = lo + (hi - lo) sigmoid(slope f(s)): a map that a robot learned, from a file.

f is the decision function of a support vector machine on a grid, bilinear in between, and -1
outside of the box: f changes more slowly than p, so that slopes stay smooth. The file is a NumPy
.npz without pickles:

    f [G, G], first index along x   low, high [2] [m] of the box   slope
"""

from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.data import archive
from hybrid_rl.fields import Inside, check_span, part

FIELDS = ("f", "low", "high", "slope")
WRITE = "`python -m hybrid_rl.figures study=contact_maps view=map` writes one"


@part
class LearnedMap:
    """The map in `file`, which must cover the box."""

    file: str
    box_low: tuple[float, ...] = (0.0, 0.0)  # [m] of the plane
    box_high: tuple[float, ...] = (1.0, 1.0)
    low: Inside = 0.04  # lo: at least twice the sensor's rate of false contacts
    high: Inside = 0.96  # hi

    def __post_init__(self) -> None:
        check_span(self)
        arrays, prefix = _load(self.file), f"map.file={self.file}:"
        box = [*self.box_low, *self.box_high]
        side = 1e-5 * float(np.min(np.subtract(self.box_high, self.box_low)))
        if not np.allclose([*arrays["low"], *arrays["high"]], box, atol=side):
            has = [float(value) for value in (*arrays["low"], *arrays["high"])]
            raise ValueError(f"{prefix} is of the box {has}, this task's is {box}")

    @property
    def middle(self) -> tuple[float, float]:
        """c: the middle of the box [m]."""
        (a, b), (c, d) = self.box_low, self.box_high
        return (a + c) / 2, (b + d) / 2

    @property
    def outline(self) -> np.ndarray:
        """Positions [M, 2] where f = 0, by linear interpolation along the grid's lines."""
        f, low, high = (_load(self.file)[name] for name in ("f", "low", "high"))
        step = (high - low) / (np.array(f.shape) - 1)
        points = []
        for axis in (0, 1):
            a = f[:-1] if axis == 0 else f[:, :-1]
            b = f[1:] if axis == 0 else f[:, 1:]
            index = np.argwhere((a < 0) != (b < 0)).astype(float)
            first, second = a[(a < 0) != (b < 0)], b[(a < 0) != (b < 0)]
            index[:, axis] += first / (first - second)
            points.append(low + index * step)
        return np.concatenate(points).astype(np.float32)

    def decision(self, s: Array) -> Array:
        """f [] at s [2]."""
        arrays = _load(self.file)
        f, low, high = (jnp.asarray(arrays[name]) for name in ("f", "low", "high"))
        cells = jnp.array(f.shape) - 1
        at = (s - low) / (high - low) * cells
        inside = jnp.all((at >= 0) & (at <= cells))
        corner = jnp.clip(jnp.floor(at).astype(jnp.int32), 0, cells - 1)
        x, y = at - corner
        i, j = corner
        value = (1 - x) * ((1 - y) * f[i, j] + y * f[i, j + 1])
        value = value + x * ((1 - y) * f[i + 1, j] + y * f[i + 1, j + 1])
        return jnp.where(inside, value, -1.0)

    def chance(self, s: Array) -> Array:
        """p(y = 1) [] at s [2]."""
        p = jax.nn.sigmoid(float(_load(self.file)["slope"]) * self.decision(s))
        return self.low + (self.high - self.low) * p


@cache
def _load(file: str) -> dict[str, np.ndarray]:
    """The arrays of a map file."""
    return archive.read(f"map.file={file}:", file, FIELDS, WRITE, header=())
