"""What docs/results/chapter6.md cites, by figure and table."""

from typing import Any

import numpy as np

from pages.values import Curve, ahead, curve, number, read

CARTPOLE, CHEETAH = "fig_6_8_cartpole", "fig_6_8_halfcheetah"
TRAINING, ALONE = "train/return", "eval/policy_return"
SPEED = {
    "cart": "thesis/fig_6_4",
    "quadcopter": "thesis/table_6_1",
    "cartpole": "thesis/fig_6_8_cartpole",
    "half-cheetah": "thesis/fig_6_8_halfcheetah",
}


def divergence(label: str, column: str) -> list[float]:
    """Figure 6-1: median, lowest, highest over starts."""
    names = {"KL": "kle3", "Fo": "fourier_ergodic", "Je": "kle3_jensen"}
    one = read("fig_6_1")[names[label[:2]]]
    each = np.array(one["divergence"])[:, one["t"].index(number(column))]
    return [np.median(each), each.min(), each.max()]


def cost(method: str, dimension: int) -> float:
    """[ms] of a plan."""
    one = read("kle3_cost")[method]
    return 1e3 * one["seconds"][one["dimension"].index(dimension)]


def measurements(trial: dict[str, Any]) -> float:
    """Median measurements until 0.95, over the trials that reach it."""
    return float(np.median([n for n in trial["measurements_to_95_percent"] if n is not None]))


def search(one: dict[str, Any], column: str) -> list[float]:
    """A cell of a table of searches."""
    if column.startswith("best after") or column == "after 40":
        return [one["median_best_after"][f"{number(column):.0f}"]]
    if column.startswith("greatest V"):
        peaks = one["V_peak"]
        return [np.median(peaks), min(peaks), max(peaks)]
    if column.startswith("measurements"):
        return [measurements(one)]
    if column == "V after 10 s":
        return [float(np.median(one["V_mean_after_10_s"]))]
    late = one["measurements_to_95_percent"]
    return [len(late) - late.count(None), one["trials"]]


def searched(label: str, column: str) -> list[float]:
    """Figure 6-4."""
    name = label.removeprefix("no dynamics (").removesuffix(")")
    return search(read("fig_6_4")[name], column)


def regulators(label: str, column: str) -> list[float]:
    """Figure 6-5: "5, as above, kle3_bayesopt, gain 0.03 as above"."""
    weight, method = label.split(",")[0], label.split(", ", 1)[1].removeprefix("as above, ")
    name = f"weight {weight}, {method.removesuffix(' as above')}"
    return search(read("fig_6_5_regulators")[name], column)


def guarded(label: str, column: str) -> list[float]:
    """Figure 6-5 with the guard."""
    if label == "lqr_bayesopt":
        return regulators("5, lqr_bayesopt", column)
    if label == "none":
        return regulators("5, kle3_bayesopt, gain 0.015", column)
    levels = read("fig_6_5_guard") | read("fig_6_5_regulators")
    return search(levels[f"explorer.level={label}"], column)


def flight(label: str, column: str) -> list[float]:
    """Table 6.1."""
    names = {name: name for name in read("table_6_1")} | {
        name.removesuffix(" 11"): name for name in read("table_6_1")
    }
    one = read("table_6_1")[names[label]]
    return {
        "power loss [N]": one["power_loss"],
        "norm of u": one["norm_of_u"],
        "kept the hover": [one["kept_hover"] * one["trials"], one["trials"]],
        "furthest from it [m]": one["furthest"],
    }[column]


def learned(label: str, column: str) -> list[float]:
    """Figure 6-6."""
    every = read("fig_6_6")
    label = label.split(",")[0]
    one = every.get(label) or every[f"{label} 11"]
    if column == "error" and label == "exact model":
        return [0.0]  # by what it is
    if column.startswith("did not turn over"):
        return [(1 - one["turned_over_tracking"]) * one["trials"], one["trials"]]
    key = {
        "power loss [N]": "power_loss",
        "error": "error",
        "distance after 4 s [m]": "distance_after_4_s",
        "mean distance [m]": "tracking",
    }[column]
    return one[key][:1] if key == "power_loss" else one[key]


def skill(file: str):
    """Figure 6-8: IQM and band of "ddpg, training" at a column's decision."""

    def values(label: str, column: str) -> list[float]:
        method, what = label.split(", ")
        metric = TRAINING if what == "training" else ALONE
        return curve(file, method, metric).at(number(column))

    return values


def disjoint(file: str, metric: str) -> tuple[Curve, np.ndarray, np.ndarray]:
    """DDPG's line, and where it is above and below KL-E3's with disjoint bands."""
    noise, ours = curve(file, "ddpg", metric), curve(file, "kle3_ddpg", metric)
    return noise, noise.low > ours.high, noise.high < ours.low


def plan_ms(label: str, column: str) -> list[float]:
    """[ms] of one plan of all robots."""
    robots = number(column)
    for table in read("speed_h200")["tables"]:
        if table["part"] == "act" and table["what"].startswith(
            f"{SPEED[label.split(' ')[0].rstrip(',')]},"
        ):
            (row,) = (r for r in table["rows"] if number(r["name"]) == robots)
            return [1e3 * robots / row["rate"]]
    raise KeyError(label)


def fig_6_6(name: str, key: str) -> list[float]:
    """A method's numbers in figure 6-6."""
    return read("fig_6_6")[name][key]


SEARCHES, TV = read("fig_6_4"), read("fig_6_2")["total_variation_to_target"]
LQR, KLE3 = measurements(SEARCHES["lqr_bayesopt"]), measurements(SEARCHES["kle3_bayesopt"])
WEIGHTS = read("fig_6_5_regulators")
HEAVY = {
    name: WEIGHTS[f"weight 500, {name}"] for name in ("lqr_bayesopt", "kle3_bayesopt, gain 0.1")
}
QUICK = [measurements(one) for one in HEAVY.values()]
GREATEST = [np.median(one["V_peak"]) for one in HEAVY.values()]
HALF = np.median(WEIGHTS["weight 5, kle3_bayesopt, gain 0.015"]["V_peak"]) / np.median(
    WEIGHTS["weight 5, lqr_bayesopt"]["V_peak"]
)
POWER = {name: one["power_loss"][0] for name, one in read("table_6_1").items()}
SIXTY = "fig_6_8_halfcheetah_sixty_episodes"
POLE, POLE_ABOVE, POLE_BELOW = disjoint(CARTPOLE, TRAINING)
DDPG, ABOVE, BELOW = disjoint(CHEETAH, ALONE)
TRAINED, _, KLE3_FIRST = disjoint(CHEETAH, TRAINING)
METHODS = ("ddpg", "kle3_ddpg")
LAST_TEN = [x for name in METHODS for x in curve(CHEETAH, name, ALONE).each[:, -10:].mean(1)]


def by_area(file: str, metric: str) -> list[float]:
    """[%] of pairs in which DDPG is ahead, and the band."""
    return ahead(*(curve(file, name, metric).area() for name in METHODS))
