"""docs/results/README.md."""

from collections.abc import Sequence

from pages import light
from pages.cited import Table, Text
from pages.values import curve, number, p_value, read

PAGE = "docs/results/README.md"
FILE = "sac_beside_sb3"
LABELS = {
    "ours": "sac",
    "Stable-Baselines3, Gymnasium's world": "sb3_sac_gymnasium",
    "Stable-Baselines3, our world": "sb3_sac_ours",
}


def at_end(task: str, label: str) -> list[float]:
    """IQM and band of a line of the picture at 100,000."""
    return curve(FILE, label, task=task).at(100_000)


def returns_at(task: str, header: str) -> Table:
    """One task's table: a row each, evaluations side by side."""

    def values(label: str, column: str) -> Sequence[float]:
        return curve(FILE, LABELS[label], task=task).at(number(column))

    return Table(header, values)


def seeds(label: str, x: float, task: str = "halfcheetah"):
    return curve(FILE, label, task=task).seeds(x)


def span(label: str) -> list[float]:
    """Lowest and highest seed at 100,000."""
    each = seeds(label, 100_000)
    return [each.min(), each.max()]


def behind() -> float:
    """[%] of Stable-Baselines3's IQM on Gymnasium's half-cheetah that ours is short of."""
    return 100 * (
        1 - at_end("halfcheetah", "sac")[0] / at_end("halfcheetah", "sb3_sac_gymnasium")[0]
    )


def p(x: float, other: str, ours: str = "sac") -> float:
    """Mann-Whitney's, two-sided, half-cheetah."""
    return p_value(seeds(ours, x), seeds(other, x))


LIGHT_TASKS = ("cartpole", "halfcheetah", "hopper")
LIGHT, LIGHT_SAC = (
    curve("light_halfcheetah", label) for label in ("make train", "sac, networks of 128")
)
MINUTES = {task: curve("light_minutes", "settings=light", task=task) for task in LIGHT_TASKS}


TEN, TEN_HOPPERS = (light.ten_seeds(task) for task in ("half-cheetah", "hopper"))


def speed(label: str, column: str) -> list[float]:
    """Decisions/s in one of two turns."""
    return [read("light_speed")["rows"][column][("first", "second").index(label)]]


GYM, OURS = "sb3_sac_gymnasium", "sb3_sac_ours"
CITED = [
    returns_at(
        "halfcheetah",
        "half-cheetah, IQM and 95% band at | 50,000 | 60,000 | 80,000 | 100,000",
    ),
    returns_at("hopper", "hopper, IQM and 95% band at | 50,000 | 80,000 | 100,000"),
    Text(
        "end level: # and # at 100,000 (Mann-Whitney p #)",
        [at_end("halfcheetah", "sac")[0], at_end("halfcheetah", OURS)[0], p(100_000, OURS)],
    ),
    Text(
        "is ahead at 50,000 (bands disjoint, p #) and #% behind at 100,000 "
        "(bands overlap, p #, 10 seeds against 5: ours span # to #, theirs # to #)",
        [p(50_000, GYM), behind(), p(100_000, GYM), *span("sac"), *span(GYM)],
    ),
    Text("Stable-Baselines3 itself spans # to # at 100,000 on our world", span(OURS)),
    Text("between its two worlds p is # there", [p(100_000, OURS, GYM)]),
    Text(
        "float32: # s in all, of which # s compiling, and # decisions/s",
        [read("light_run")[key] for key in ("wall_s", "compile_s", "env_steps_per_s")],
    ),
    Text("It has # after # s", [MINUTES["halfcheetah"].each[0, 2], MINUTES["halfcheetah"].x[2]]),
    Text("its last evaluation, at 30,000 decisions, is #", [LIGHT.at(30_000)[0]]),
    Text(
        "the lowest has # at 30,000, the IQM is #.",
        [float(TEN.seeds(30_000).min()), TEN.at(30_000)[0]],
    ),
    Text(
        "swings up after # s (# at 8,000 decisions)",
        [MINUTES["cartpole"].x[7], MINUTES["cartpole"].each[0, 7]],
    ),
    Text(
        "size: # at 30,000 decisions, after # s.",
        [MINUTES["hopper"].each[0, -1], MINUTES["hopper"].x[-1]],
    ),
    Text("Ten seeds have [an IQM of #]", TEN_HOPPERS.at(30_000)[:1]),
    Text(
        "larger networks of the default they have # at 20,000, on a GPU",
        curve("hybrid_hopper", "hybrid_stochastic").at(20_000)[:1],
    ),
    Table(
        "half-cheetah, decisions/s of one learner on two idle cores, two turns | settings=mbpo "
        "| settings=light | default",
        speed,
    ),
    Text(
        "and has # at 60,000 and # at 120,000 decisions",
        [float(LIGHT_SAC.seeds(step).mean()) for step in (60_000, 120_000)],
    ),
]
PLAIN = [
    # settings
    "95% bootstrap",
    "5 episodes per seed",
    "64 seeds in one program",
    "16 cores of its host",
    "16 cores of their host",
    "MuJoCo 3.17.0",
    "before 0.2.0",
    "jax was 0.11.2, on the two cores 0.10",
    "batch 256, two layers of 256, 10,000 random decisions",
    "Stable-Baselines3 2.9.2",
    "5 seeds each (0 to 4)",
    "10 seeds (0 to 9)",
    "at 100,000",
    "is ahead at 50,000",
    "10 seeds against 5",
    "From 60,000 to 90,000 the bands overlap and no p is below 0.07",
    "2.5 GHz, 2 threads, Python 3.11, jax 0.10",
    "50,000 decisions",
    "two layers of 128, two updates on batches of 64, 5,000 random decisions",
    "seed 0, two otherwise idle",
    "at 30,000 decisions",
    "within 10 minutes on two cores and reaches 3,000",
    "With networks of 128",
    "Time from the start, compiling included, seed 0",
    "at 8,000 decisions",
    "at 30,000 decisions, after",
    "at 20,000, on a GPU",
    "at 30,000, the IQM",
    "chosen later, [on seeds 200 to 204]",
    "seeds 100 to 109 of `light_early`",
    "at 60,000 and",
    "at 120,000 decisions (mean of seeds 200 and 201",
    "on seeds 200 and 201 among six variants",
    "batches of 128",
    "`velocity_share` | two cores of an AMD EPYC | float32",
    # read from the console; the page says so
    "takes 1.3 ms per decision",
    "takes about 9 ms",
    "takes 8.5 ms",
    # aims
    "The aim was 600",
    "within 10 minutes",
    # read from the console; the page says so
    "about 210 decisions/s",
    "about 4 decisions/s",
]
