"""docs/results/chapter6.md."""

from typing import Any

import numpy as np

from pages.cited import Curve, Table, Text, ahead, curve, number, read

PAGE = "docs/results/chapter6.md"
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


def when(trial: dict[str, Any]) -> float:
    """Median measurements until 0.95, over the trials that get there."""
    return float(np.median([n for n in trial["measurements_to_95_percent"] if n is not None]))


def search(one: dict[str, Any], column: str) -> list[float]:
    """A cell of a table of searches."""
    if column.startswith("best after") or column == "after 40":
        return [one["median_best_after"][f"{number(column):.0f}"]]
    if column.startswith("greatest V"):
        peaks = one["V_peak"]
        return [np.median(peaks), min(peaks), max(peaks)]
    if column.startswith("measurements"):
        return [when(one)]
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


def of(name: str, key: str) -> list[float]:
    """A method's numbers in figure 6-6."""
    return read("fig_6_6")[name][key]


SEARCHES, TV = read("fig_6_4"), read("fig_6_2")["total_variation_to_target"]
LQR, KLE3 = when(SEARCHES["lqr_bayesopt"]), when(SEARCHES["kle3_bayesopt"])
WEIGHTS = read("fig_6_5_regulators")
HEAVY = {
    name: WEIGHTS[f"weight 500, {name}"] for name in ("lqr_bayesopt", "kle3_bayesopt, gain 0.1")
}
QUICK = [when(one) for one in HEAVY.values()]
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


CITED = [
    Table("after | 5 s | 10 s | 20 s | 40 s", divergence),
    Text(
        "sum of Gaussians #, Fourier with 20 cosines a side # (#% of its mass negative), "
        "cells visited #",
        [
            TV["sum of Gaussians (6.1)"],
            TV["Fourier, 20 cosines a side"],
            100 * read("fig_6_2")["negative_mass"]["Fourier, 20 cosines a side"],
            TV["raw: cells visited"],
        ],
    ),
    Text(
        "KL-ergodic # ms in 2 dimensions and # ms in 12; "
        "Fourier # ms in 2, # in 4, # in 5 and # in 6",
        [
            *(cost("kle3", n) for n in (2, 12)),
            *(cost("fourier_ergodic", n) for n in (2, 4, 5, 6)),
        ],
    ),
    Table(
        " | best after 20, median | after 40 | measurements until 0.95, median"
        " | trials that get there | greatest V, median",
        searched,
    ),
    Text("optimisation without dynamics, # times as quick", [LQR / KLE3]),
    Table(
        "the regulator's weight of the position | | greatest V | V after 10 s"
        " | measurements until 0.95, median | trials that get there",
        regulators,
    ),
    Text("greatest V to # times LQR's", [HALF]),
    Text("KL-E3 needs # measurements and LQR-Bayesian optimisation #,", QUICK[::-1]),
    Text("a factor of # where the slow regulator gives #**", [QUICK[0] / QUICK[1], LQR / KLE3]),
    Text("as in the thesis, by a factor of # and", [GREATEST[0] / GREATEST[1]]),
    Table(
        "level | greatest V, median (range) | measurements until 0.95, median"
        " | trials that get there | best after 20",
        guarded,
    ),
    Table(
        " | power loss [N] | thesis | norm of u | thesis | kept the hover | furthest from it [m]",
        flight,
        plain=("thesis",),
    ),
    Text(
        "normal over uniform noise is then #,",
        [POWER["normal_noise 0.1"] / POWER["uniform_noise 0.1"]],
    ),
    Table(
        " | R | power loss [N] | error | distance after 4 s [m] | mean distance [m]"
        " | did not turn over, tracking",
        learned,
        plain=("R",),
    ),
    Text(
        "than white noise, # [#, #] at # N (R = 2) against # [#, #] for normal noise at # N and "
        "# [#, #] for uniform noise at # N",
        [
            x
            for name in ("kle3_model_learning 2.75", "normal_noise 0.1", "uniform_noise 0.1")
            for x in (*of(name, "error"), of(name, "power_loss")[0])
        ],
    ),
    Text(
        "(# [#, #] m against # [#, #])",
        [*of("kle3_model_learning 2.75", "tracking"), *of("normal_noise 0.1", "tracking")],
    ),
    Text(
        "# [#, #] at # N, bands apart from KL-E3's at # N; in tracking they overlap (# and # m)",
        [
            *of("ou_noise 0.3", "error"),
            of("ou_noise 0.3", "power_loss")[0],
            of("kle3_model_learning 2.75", "power_loss")[0],
            of("ou_noise 0.3", "tracking")[0],
            of("kle3_model_learning 2.75", "tracking")[0],
        ],
    ),
    Text(
        "ends at # m, the exact one at #",
        [of("ou_noise 0.3", "distance_after_4_s")[0], of("exact model", "distance_after_4_s")[0]],
    ),
    Table("cartpole, decisions | 4,000 | 8,000 | 12,000 | 16,000", skill(CARTPOLE)),
    Table("half-cheetah, decisions | 5,000 | 12,000 | 25,000 | 50,000", skill(CHEETAH)),
    Text(
        "above, from # to # decisions and at # only",
        [POLE.x[POLE_BELOW][0], *POLE.x[POLE_BELOW][-2:]],
    ),
    Text(
        "DDPG's policy has #, #, #, # and #, seed by seed",
        curve(CARTPOLE, "ddpg", ALONE).seeds(16_000),
    ),
    Text(
        "for DDPG in #% of the 25 pairs of seeds in training, and in #% for the policy alone",
        [by_area(CHEETAH, TRAINING)[0], by_area(CHEETAH, ALONE)[0]],
    ),
    Text("are disjoint at # of # evaluations", [(ABOVE | BELOW).sum(), len(ABOVE)]),
    Text(
        "DDPG's policy #, #, #, # and #, KL-E3's #, #, #, # and #",
        LAST_TEN,
    ),
    Text("is above DDPG's at # and # decisions only", TRAINED.x[KLE3_FIRST]),
    Text(
        "training returns of # [#, #] with KL-E3 and # [#, #] without",
        [
            *curve(SIXTY, "kle3_ddpg", TRAINING).at(12_000),
            *curve(SIXTY, "ddpg", TRAINING).at(12_000),
        ],
    ),
    Text("open (#% [#, #] of pairs of seeds for DDPG, by area)", by_area(CARTPOLE, ALONE)),
    Text(
        "policy has # alone where in training it has # with KL-E3",
        [curve(CARTPOLE, "kle3_ddpg", metric).seeds(11_000)[4] for metric in (ALONE, TRAINING)],
    ),
    Table(" | real-time step | 1 robot | 1,024 robots", plan_ms, plain=("real-time step",)),
]
PLAIN = [
    # settings
    "jax 0.10",
    "10 starts of 40 s",
    "T = 15,",
    "Sigma = 0.005 I",
    "with 20 cosines",
    "T = 5, N = 100 points, 5 cosines",
    "ms in 2 dimensions",
    "ms in 12; Fourier",
    "ms in 2,",
    "in 4,",
    "in 5 and",
    "in 6, where",
    "every 0.2 s for 20 s; 10 trials",
    "The highest hill is 1.0, the next 0.8",
    "a horizon of 1 s, Sigma of 0.02, the last 4 s",
    "Kappa 2, c 10",
    "(t_H 0.2 s, R 0.1, Sigma 0.1, N 20, line search)",
    "within 0.2 s",
    "after 10 s, medians of 10 trials",
    "(weight 500)",
    "gain 0.015 and the regulator of weight 5, 10 trials each",
    "At 150 KL-E3 keeps",
    "Below 150 the guard",
    "1200 decisions of 0.005 s around the same regulator (Q = 1, R = 1, of actions in [-1, 1]), "
    "20 trials",
    "Norm of u at hover is 0.82 here",
    "that noise 0.1 does not",
    "R = 0.5, Sigma = 0.1, N = 100, 0.6 s",
    "from -6 to 6; that reading, c = 10",
    "within 1 m/s and 1 rad/s",
    "0.41 a rotor",
    "0.15 per second",
    "2000 batches of 200",
    "a target 2 m away in each direction at most, 4 s",
    "over 20 trials and its 95% bootstrap",
    "1 is no better than a constant",
    "(R = 2)",
    "normal noise of 0.1 too",
    "no noise of 0.1 or less",
    "OU noise of 0.3",
    "of OU 0.3, ends",
    "the 1 m/s and 1 rad/s that are",
    "a floor of 0.05",
    "0.15 and 0.2 a decision",
    "(two layers of 256), rates (1e-4 and 1e-3, tau 0.01, batch 64), 200 random decisions and "
    "episodes of 200 decisions, seeds 0 to 4, cartpole 0.033 s and half-cheetah 0.05 s a decision",
    "averaged over 1,000 decisions",
    "IQM and 95% band:",
    "At 16,000 DDPG's",
    "the thesis' 250 episodes",
    "of the 25 pairs",
    "up to 200:",
    "to 12,000, had",
    "At 11,000 decisions seed 4's",
    "c = 1 and differences",
    "seeds 100 to 102",
    "root mean square 0.3",
    "R = 0.01 every action",
    "0.2 s on the cartpole and 0.1 s on the half-cheetah; in the thesis 0.1 s and 0.03 s",
    "(1 here)",
    "R = 0.01 * 0.99^t",
    "1/R",
    "0.13 of the first correction is left after 200 decisions",
    "seeds shown, 0 to 4",
    "1,024 of each kind",
    # the thesis' numbers
    "in the thesis 1.68",
    "about 0.67 there",
]
