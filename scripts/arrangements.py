"""Random arrangements of objects for the contact plane, in the unit square.

    3, 4 or 5 objects: discs of radius 0.06 to 0.11 m, boxes of half sides 0.05 to 0.10 m, bars of
    half length 0.10 to 0.15 m and half width 0.03 m, with corners of radius 0.01 m, at any angle

An object is drawn again unless it lies more than 0.1 m from the walls and from all others; after
100 refusals the arrangement begins again. The rule and its numbers are our choice.
"""

import numpy as np

GAP = 0.1  # [m]
REFUSALS = 100
Shape = tuple[float, ...]  # x, y, angle, half width, half height, rounding


def draw(seed: int) -> list[Shape]:
    """The objects of arrangement `seed`, rounded to a millimetre and a milliradian."""
    rng = np.random.default_rng(seed)
    while True:
        count, objects = rng.integers(3, 6), []
        for _ in range(REFUSALS):
            shape = _shape(rng)
            if _fits(shape, objects):
                objects.append(shape)
            if len(objects) == count:
                return objects


def _shape(rng: np.random.Generator) -> Shape:
    """A disc, a box or a bar."""
    kind = rng.integers(3)
    x, y = rng.uniform(0, 1, 2)
    angle = rng.uniform(-np.pi / 2, np.pi / 2)
    if kind == 0:
        half_x = half_y = rounding = rng.uniform(0.06, 0.11)
        angle = 0.0
    elif kind == 1:
        (half_x, half_y), rounding = rng.uniform(0.05, 0.10, 2), 0.01
    else:
        half_x, half_y, rounding = rng.uniform(0.10, 0.15), 0.03, 0.01
    return tuple(round(float(each), 3) for each in (x, y, angle, half_x, half_y, rounding))


def _fits(shape: Shape, objects: list[Shape]) -> bool:
    """Whether a shape is far enough from the walls and from the other objects."""
    points, rounding = core(shape), shape[5]
    to_walls = min(points.min(), 1 - points.max())
    to_objects = [distance(points, other).min() for other in objects]
    return min([to_walls, *to_objects]) - rounding > GAP


def core(shape: Shape, count: int = 41) -> np.ndarray:
    """A grid of points [count^2, 2] of a shape without its rounding."""
    x, y, angle, half_x, half_y, rounding = shape
    sides = [np.linspace(-half, half, count) for half in (half_x - rounding, half_y - rounding)]
    local = np.stack(np.meshgrid(*sides), -1).reshape(-1, 2)
    cos, sin = np.cos(angle), np.sin(angle)
    return local @ np.array([[cos, sin], [-sin, cos]]) + [x, y]


def distance(points: np.ndarray, shape: Shape) -> np.ndarray:
    """Distance [N] of points [N, 2] to a shape, 0 or below in it."""
    x, y, angle, half_x, half_y, rounding = shape
    cos, sin = np.cos(angle), np.sin(angle)
    local = (points - [x, y]) @ np.array([[cos, -sin], [sin, cos]])
    beyond = np.maximum(np.abs(local) - [half_x - rounding, half_y - rounding], 0)
    return np.hypot(*beyond.T) - rounding
