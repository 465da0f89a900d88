"""A curve in characters, for a console."""

import math

import numpy as np
from numpy.typing import ArrayLike

WIDTH, HEIGHT = 60, 9  # characters


def drawn(x: ArrayLike, y: ArrayLike, title: str, below: str) -> str:
    """The line through the points x [N], increasing, and y [N], with the limits of both.

    title: above the curve; below: the unit of x.
    """
    x, y = np.asarray(x), np.asarray(y)
    low, high = y.min(), y.max()
    at = np.interp(np.linspace(x[0], x[-1], WIDTH), x, y)
    share = (at - low) / (high - low) if high > low else np.zeros(WIDTH)
    rows = np.rint(share * (HEIGHT - 1)).astype(int)
    span = high - low
    digits = max(0, 1 - math.floor(math.log10(span))) if 0 < span < math.inf else 0
    labels = {HEIGHT - 1: f"{high:,.{digits}f}", 0: f"{low:,.{digits}f}"}
    margin = max(map(len, labels.values()))
    lines = [title]
    for row in reversed(range(HEIGHT)):
        text = "".join("*" if here == row else " " for here in rows)
        lines.append(f"{labels.get(row, ''):>{margin}} |{text}".rstrip())
    first, last = f"{x[0]:,.0f}", f"{x[-1]:,.0f} {below}"
    lines.append(" " * margin + " +" + "-" * WIDTH)
    lines.append(" " * (margin + 2) + first + last.rjust(WIDTH - len(first)))
    return "\n".join(lines)
