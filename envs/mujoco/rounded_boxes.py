"""Solid rounded boxes on a plane as MJCF: two boxes and a disc in each corner.

MJX has no contact with cylinders, so that a disc is an upright capsule, longer than the boxes are
high: a robot at half height meets its straight part.
"""

import math

Shape = tuple[float, ...]  # x, y, angle, half width, half height, rounding [m, rad]
LEAST = 1e-4  # [m] least half width of a box, and difference of heights


def solid(objects: tuple[Shape, ...], robot: str, height: float) -> tuple[str, str]:
    """Geoms of objects that are 2 `height` [m] high around z = 0, and contacts with geom `robot`.

    Their names are object_0_0, object_0_1, ... of the first, object_1_0, ... of the second.
    """
    geoms, pairs = [], []
    for i, shape in enumerate(objects):
        for j, part in enumerate(_parts(shape, height, "capsule")):
            geoms.append(f'<geom name="object_{i}_{j}" {part} group="3"/>')
            pairs.append(f'<pair geom1="{robot}" geom2="object_{i}_{j}"/>')
    return "".join(geoms), f"<contact>{''.join(pairs)}</contact>"


def drawn(objects: tuple[Shape, ...], height: float) -> str:
    """Geoms of the same objects without contacts, of material "object"."""
    parts = [part for shape in objects for part in _parts(shape, height, "cylinder")]
    return "".join(f'<geom {part} mass="0" material="object"/>' for part in parts)


def _parts(shape: Shape, height: float, disc: str) -> list[str]:
    """Type, size and pose of each part."""
    x, y, angle, half_x, half_y, rounding = shape
    inner_x, inner_y = half_x - rounding, half_y - rounding
    sizes = [(half_x, inner_y), (inner_x, half_y)]
    parts = [
        f'type="box" size="{a:.9g} {b:.9g} {height - i * LEAST:g}" pos="{x:.9g} {y:.9g} 0" '
        f'euler="0 0 {angle:.9g}" contype="0" conaffinity="0"'
        for i, (a, b) in enumerate(sizes)
        if min(a, b) > LEAST  # one lower than the other, or their tops would flicker
    ]
    cos, sin = math.cos(angle), math.sin(angle)
    for a, b in sorted({(i * inner_x, j * inner_y) for i in (-1, 1) for j in (-1, 1)}):
        at = f"{x + cos * a - sin * b:.9g} {y + sin * a + cos * b:.9g} 0"
        size = f"{rounding:.9g} {height:g}"
        parts.append(f'type="{disc}" size="{size}" pos="{at}" contype="0" conaffinity="0"')
    return parts
