"""What others published."""

from pages.values import Curve, number

PUBLISHED = {  # DHMBPO's means with one update per decision, and with two
    "half-cheetah, 20,000": (5_381, 7_532),
    "half-cheetah, 30,000": (5_231, 8_059),
    "half-cheetah, 50,000": (7_356, 9_149),
    "half-cheetah, 100,000": (9_878, 11_177),
    "ant, 50,000": (4_690, 5_225),
    "walker2d, 50,000": (4_264, 6_150),
    "walker2d, 100,000": (6_457, 7_445),
    "hopper, 20,000": (2_101, 1_798),
    "hopper, 30,000": (3_171, 3_259),
    "hopper, 50,000": (3_470, 3_364),
}


def beside(of: Curve, label: str, column: str) -> list[float]:
    """A cell of a table beside DHMBPO's numbers."""
    each = of.seeds(number(label))
    kind = {"mean": each.mean, "lowest seed": each.min, "highest seed": each.max}
    return [float(kind[column]())] if column in kind else [PUBLISHED[label]["two" in column]]
