"""docs/results/chapter6.md."""

from pages import chapter6_backflips
from pages.chapter6_values import (
    ABOVE,
    ALONE,
    BELOW,
    CARTPOLE,
    CHEETAH,
    GREATEST,
    HALF,
    KLE3,
    KLE3_FIRST,
    LAST_TEN,
    LQR,
    POLE,
    POLE_BELOW,
    POWER,
    QUICK,
    SIXTY,
    TRAINED,
    TRAINING,
    TV,
    by_area,
    cost,
    divergence,
    fig_6_6,
    flight,
    guarded,
    learned,
    plan_ms,
    regulators,
    searched,
    skill,
)
from pages.cited import Table, Text
from pages.values import curve, read

PAGE = "docs/results/chapter6.md"
CITED = [
    *chapter6_backflips.CITED,
    Table("after | 5 s | 10 s | 20 s | 40 s", divergence),
    Text(
        "sum of Gaussians #, Fourier with 20 cosines per axis # (#% of its mass negative), "
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
        " | trials that reach it | greatest V, median",
        searched,
    ),
    Text("optimisation without dynamics, # times as fast", [LQR / KLE3]),
    Table(
        "the regulator's weight of the position | | greatest V | V after 10 s"
        " | measurements until 0.95, median | trials that reach it",
        regulators,
    ),
    Text("greatest V to # times LQR's", [HALF]),
    Text("KL-E3 needs # measurements and LQR-Bayesian optimisation #,", QUICK[::-1]),
    Text("a factor of # where the slow regulator gives #**", [QUICK[0] / QUICK[1], LQR / KLE3]),
    Text("as in the thesis, by a factor of # and", [GREATEST[0] / GREATEST[1]]),
    Table(
        "level | greatest V, median (range) | measurements until 0.95, median"
        " | trials that reach it | best after 20",
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
            for x in (*fig_6_6(name, "error"), fig_6_6(name, "power_loss")[0])
        ],
    ),
    Text(
        "(# [#, #] m against # [#, #])",
        [
            *fig_6_6("kle3_model_learning 2.75", "tracking"),
            *fig_6_6("normal_noise 0.1", "tracking"),
        ],
    ),
    Text(
        "# [#, #] at # N, with a band disjoint from KL-E3's at # N; "
        "in tracking they overlap (# and # m)",
        [
            *fig_6_6("ou_noise 0.3", "error"),
            fig_6_6("ou_noise 0.3", "power_loss")[0],
            fig_6_6("kle3_model_learning 2.75", "power_loss")[0],
            fig_6_6("ou_noise 0.3", "tracking")[0],
            fig_6_6("kle3_model_learning 2.75", "tracking")[0],
        ],
    ),
    Text(
        "ends at # m, the exact one at #",
        [
            fig_6_6("ou_noise 0.3", "distance_after_4_s")[0],
            fig_6_6("exact model", "distance_after_4_s")[0],
        ],
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
    *chapter6_backflips.PLAIN,
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
    "After 10 s V is",
    "(weight 500)",
    "gain 0.015 and the regulator of weight 5, 10 trials each",
    "At 150 KL-E3 keeps",
    "Below 150 the guard",
    "1200 decisions of 0.005 s around the same regulator (Q = 1, R = 1, of actions in [-1, 1]), "
    "20 trials",
    "Norm of u at hover is 0.82 here",
    "that noise 0.1 does not",
    "R = 0.5, Sigma = 0.1, N = 100, 0.6 s",
    "from -6 to 6; this interpretation, c = 10",
    "(0.01 s) late; since version 0.2.0",
    "random numbers since version 0.2.0",
    "within 1 m/s and 1 rad/s",
    "0.41 per rotor",
    "0.15 per second",
    "2000 batches of 200",
    "a target 2 m away in each direction at most, 4 s",
    "over 20 trials and its 95% bootstrap",
    "1 is no better than a constant",
    "(R = 2)",
    "normal noise of 0.1 too",
    "no noise of 0.1 or less",
    "OU noise of 0.3",
    "of OU noise 0.3, ends",
    "the 1 m/s and 1 rad/s that are",
    "a floor of 0.05",
    "0.15 and 0.2 per decision",
    "(two layers of 256), rates (1e-4 and 1e-3, tau 0.01, batch 64), 200 random decisions and "
    "episodes of 200 decisions, seeds 0 to 4, cartpole 0.033 s and half-cheetah 0.05 s per "
    "decision",
    "averaged over 1,000 decisions",
    "IQM and 95% band:",
    "At 16,000 DDPG's",
    "the thesis' 250 episodes",
    "of the 25 pairs",
    "up to 200:",
    "to 12,000, had",
    "At 11,000 decisions seed 4's",
    "c = 1 and large differences",
    "seeds 100 to 102",
    "root mean square 0.3",
    "R = 0.01 every action",
    "0.2 s on the cartpole and 0.1 s on the half-cheetah; in the thesis 0.1 s and 0.03 s",
    "(1 here)",
    "R = 0.01 * 0.99^t",
    "1/R",
    "0.13 of the first correction is left after 200 decisions",
    "seeds shown, 0 to 4",
    "1,024 robots of each kind",
    # the thesis' numbers
    "in the thesis 1.68",
    "about 0.67 there",
]
