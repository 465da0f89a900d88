"""Solid rounded boxes on a plane as MJCF: two boxes and a disc in each corner.

MJX has no contact with cylinders, so that a disc is an upright capsule, longer than the boxes are
high: a robot at half height meets its straight part.
"""

import math

Shape = tuple[float, ...]  # x, y, angle, half width, half height, rounding [m, rad]
LEAST = 1e-4  # [m] least half width of a box


def mjcf(objects: tuple[Shape, ...], robot: str, height: float) -> tuple[str, str]:
    """Geoms of objects that are 2 `height` [m] high around z = 0, and contacts with geom `robot`.

    Their names are object_0_0, object_0_1, ... of the first, object_1_0, ... of the second.
    """
    geoms, pairs = [], []
    for i, shape in enumerate(objects):
        for j, (x, y, words) in enumerate(_parts(shape, height)):
            name = f"object_{i}_{j}"
            geoms.append(f'<geom name="{name}" pos="{x:.9g} {y:.9g} 0" {words}/>')
            pairs.append(f'<pair geom1="{robot}" geom2="{name}"/>')
    return "".join(geoms), f"<contact>{''.join(pairs)}</contact>"


def _parts(shape: Shape, height: float) -> list[tuple[float, float, str]]:
    """Position [m], type and size of each part."""
    x, y, angle, half_x, half_y, rounding = shape
    inner_x, inner_y = half_x - rounding, half_y - rounding
    parts = [
        (x, y, f'type="box" size="{a:.9g} {b:.9g} {height:g}" euler="0 0 {angle:.9g}"')
        for a, b in ((half_x, inner_y), (inner_x, half_y))
        if min(a, b) > LEAST
    ]
    cos, sin = math.cos(angle), math.sin(angle)
    disc = f'type="capsule" size="{rounding:.9g} {height:g}"'
    corners = {(i * inner_x, j * inner_y) for i in (-1, 1) for j in (-1, 1)}
    for a, b in sorted(corners):
        parts.append((x + cos * a - sin * b, y + sin * a + cos * b, disc))
    return parts
