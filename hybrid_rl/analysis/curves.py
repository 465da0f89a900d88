"""Learning curves of many runs, on common steps and averaged over seeds.

    IQM = sum_i w_i v_(i) / sum_i w_i,   w_i = |[i-1, i] within [n/4, 3n/4]|

over the n sorted seeds v_(1) <= ... <= v_(n): the mean of the middle half. A seed on its border
has a partial weight (5 seeds: 0, 3/4, 1, 3/4, 0); for n divisible by 4 it is the 25% trimmed mean.
The band is the 95% percentile bootstrap of the IQM, resampling seeds.
Source: Agarwal et al., Deep RL at the Edge of the Statistical Precipice, NeurIPS 2021.

A seed that diverged or had an infinite or NaN return is a failure (hybrid_rl.analysis.logged).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.analysis.logged import Learner, common, count_failures, learners, swept
from hybrid_rl.analysis.results import NOT_METRICS, RunFolder, differences, find, short
from hybrid_rl.errors import UsageError

RESAMPLES = 2000  # of the bootstrap
TIMES = ("step", "wall_s")  # of a row; any other x is a key of the configuration
Key = tuple[str, str]  # task and label of a curve


@dataclass(frozen=True)
class Curve:
    """One line of a figure."""

    task: str
    metric: str
    label: str  # method and the settings in which the lines differ
    seeds: tuple[int, ...]  # S learners, in the order of `each`
    runs: tuple[str, ...]  # the run folder of each learner
    x: np.ndarray  # [G] decisions of a learner, seconds, or the swept value
    each: np.ndarray  # [S, G] the metric of each learner, NaN where it has none
    iqm: np.ndarray  # [G] interquartile mean over the learners that have a value
    low: np.ndarray  # [G] lower end of the 95% band
    high: np.ndarray  # [G] upper end
    notes: tuple[str, ...]  # failed seeds and missing values, one line each

    @property
    def shared(self) -> np.ndarray:
        """[G] whether all learners have a value there."""
        return np.isfinite(self.each).all(0)

    def frame(self) -> Any:
        """A pandas.DataFrame: a row per value, columns task, label, seed, metric, x, value."""
        import pandas  # pyright: ignore[reportMissingImports]: an extra

        s, g = np.nonzero(np.isfinite(self.each))
        values = {"seed": np.array(self.seeds)[s], "metric": self.metric}
        values |= {"x": self.x[g], "value": self.each[s, g]}
        return pandas.DataFrame({"task": self.task, "label": self.label} | values)


def curves(
    runs: str | Path | Iterable[str | Path],
    metric: str = "train/return",
    x: str = "step",
    group: str = "algo",
    smooth: float = 0.0,
) -> list[Curve]:
    """A curve for each task, each value of `group`, and each set of settings.

    Runs of equal settings, whatever their seeds, are one curve; others are labelled by their
    differences (hybrid_rl.analysis.results). If the seeds logged at the same steps, these are the
    points; else each seed is averaged in bins, with linear interpolation over empty ones. A curve
    is as long as its longest seed, averaged over the seeds that have a value.

    Args:
        runs: a glob, or folders; every folder in them that has metrics.jsonl is a run.
        metric: a key of metrics.jsonl.
        x: "step" [decisions], "wall_s" [s], or a number in the runs' configuration that was swept:
            a run is then one point, with its last value.
        group: a key of the runs' configuration.
        smooth: width of a moving mean over each seed, in units of x.

    Raises:
        UsageError: if no run matches, no run has the metric, or a file is damaged.
    """
    folders = [RunFolder(path) for path in find(runs)]
    groups: dict[Key, list[Learner]] = {}
    notes: dict[Key, list[str]] = {}
    for key, (members, settings) in _grouped(folders, x, group).items():
        time = x if x in TIMES else "step"
        every = [each for run in members for each in learners(run, metric, time)]
        groups[key] = [each for each in every if each.counts]
        notes[key] = [*settings, *_without_metric(metric, every)]
    if not any(np.isfinite(each.y).any() for members in groups.values() for each in members):
        raise _no_metric(folders, metric)
    for task in {task for (task, _), members in groups.items() if members}:
        panel = {key: members for key, members in groups.items() if key[0] == task and members}
        for key, (members, lines) in count_failures(metric, panel).items():
            groups[key] = members
            notes[key] += lines
    if x not in TIMES:
        numbers = {run.path: run.number(x) for run in folders}
        for key, members in groups.items():
            notes[key] += _duplicates([(each.seed, numbers[each.run]) for each in members])
            groups[key] = swept(members, numbers)
    drawn = sorted(
        key for key, members in groups.items() if any(np.isfinite(each.y).any() for each in members)
    )
    lines = _lines(notes, drawn)
    return [curve_of(key, metric, groups[key], smooth, lines[key]) for key in drawn]


def iqm(values: np.ndarray) -> np.ndarray:
    """Interquartile mean over the first axis: [n, ...] -> [...]."""
    n = len(values)
    edges = np.clip(np.arange(n + 1), n / 4, 3 * n / 4)
    return np.tensordot(np.diff(edges) / (n / 2), np.sort(values, axis=0), axes=1)


def band(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """95% bootstrap band of the IQM over the first axis: [n, ...] -> two of [...]."""
    n = len(values)
    draws = np.random.default_rng(0).integers(n, size=(RESAMPLES, n))
    low, high = np.percentile([iqm(values[draw]) for draw in draws], [2.5, 97.5], axis=0)
    return low, high


def format_number(value: float) -> str:
    """A value with four digits, or with all digits of its whole part: "0.1234", "11,387"."""
    return f"{value:,.4g}" if abs(value) < 1000 else f"{value:,.0f}"


def spread(values: np.ndarray) -> str:
    """IQM of [n] and its band as text: "8,250 [6,429, 8,979]"; no band for a single value."""
    middle = format_number(float(iqm(values)))
    if len(values) == 1:
        return middle
    low, high = (format_number(float(end)) for end in band(values))
    return f"{middle} [{low}, {high}]"


def plural(count: int, noun: str) -> str:
    """The count with its noun: "1 seed", "2 seeds"."""
    return f"{count:,} {noun}{'s' * (count != 1)}"


def area(curve: Curve, since: float = -np.inf, until: float = np.inf) -> np.ndarray:
    """[S] mean of each learner's metric: the area under its curve over its width.

    Between the first and the last point that all learners have, or from x = `since` to x = `until`
    within them; NaN if no point is left.
    """
    x, each = curve.x[curve.shared], curve.each[:, curve.shared]
    if not len(x) or max(x[0], since) > min(x[-1], until):
        return np.full(len(each), np.nan)
    ends = np.array([max(x[0], since), min(x[-1], until)])
    at = np.union1d(ends, x[(ends[0] < x) & (x < ends[1])])
    y = np.stack([np.interp(at, x, own) for own in each])
    return np.trapezoid(y, at, axis=1) / (at[-1] - at[0]) if len(at) > 1 else y[:, 0]


def improvement(x: np.ndarray, y: np.ndarray) -> tuple[float, float, float]:
    """P(X > Y) of scores [n] and [m], ties counting half, and its 95% bootstrap band.

    Source: Agarwal et al. 2021, probability of improvement (the Mann-Whitney U statistic).
    """

    def rate(x: np.ndarray, y: np.ndarray) -> float:
        ahead, level = x[:, None] > y[None], x[:, None] == y[None]
        return float(np.mean(ahead + 0.5 * level))

    rng = np.random.default_rng(0)
    draws = [rate(rng.choice(x, len(x)), rng.choice(y, len(y))) for _ in range(RESAMPLES)]
    low, high = np.percentile(draws, [2.5, 97.5])
    return rate(x, y), float(low), float(high)


def _lines(notes: dict[Key, list[str]], drawn: list[Key]) -> dict[Key, list[str]]:
    """The notes of each curve that is drawn; those of no curve are with the first one."""
    lines = {key: [f"{', '.join(key)}: {note}" for note in notes[key]] for key in sorted(notes)}
    lines[drawn[0]] += [line for key in lines if key not in drawn for line in lines[key]]
    return lines


def _grouped(
    runs: Sequence[RunFolder], x: str, group: str
) -> dict[Key, tuple[list[RunFolder], list[str]]]:
    """The runs of each curve, and their settings if the label is a letter."""
    parts: dict[tuple[str, str, str], list[RunFolder]] = {}
    for run in runs:
        parts.setdefault((run.word("task"), run.word(group), run.word("algo")), []).append(run)
    groups: dict[Key, tuple[list[RunFolder], list[str]]] = {}
    for (task, value, algo), members in parts.items():
        label = algo if group == "algo" else f"{group}={value}"
        if len([key for key in parts if key[:2] == (task, value)]) > 1:
            label += f" algo={algo}"
        differ = differences(members, [key for key in (x, group) if key not in TIMES])
        for run, name, more in zip(members, short(differ), differ, strict=True):
            settings = ", ".join(f"{key}={shown}" for key, shown in more.items())
            lines = [settings] if settings and "=" not in name else []
            groups.setdefault((task, f"{label} {name}".strip()), ([], lines))[0].append(run)
    return groups


def _without_metric(metric: str, every: list[Learner]) -> list[str]:
    """A note for each learner that has no value of the metric yet."""
    without = [each for each in every if not each.counts]
    if len(without) == len(every):
        return [f"no {metric}"]
    return [f"seed {one.seed} of {one.run} has no {metric} yet; left out" for one in without]


def _no_metric(folders: list[RunFolder], metric: str) -> UsageError:
    """The error if no run has a value of the metric; it names those that the runs have."""
    names = {name for run in folders for row in run.rows for name in row} - set(NOT_METRICS)
    if metric in names:
        return UsageError(f"metric={metric}: has no finite value in these runs")
    has = ", ".join(sorted(names)) or "none yet"
    return UsageError(f"metric={metric}: not in these runs; they have {has}")


def _duplicates(learners: list[tuple[int, float]]) -> list[str]:
    """A note on each (seed, number) that occurs several times."""
    seeds = sorted({seed for seed, number in learners if learners.count((seed, number)) > 1})
    return [f"seeds {seeds} are in several run folders and count in each"] if seeds else []


def curve_of(
    key: Key, metric: str, members: list[Learner], smooth: float, notes: Sequence[str] = ()
) -> Curve:
    """The curve of the learners `members`."""
    (task, label), lines = key, list(notes)
    seeds = tuple(each.seed for each in members)
    lines += [f"{task}, {label}: {line}" for line in _duplicates([(seed, 0.0) for seed in seeds])]
    x, each = common(members, smooth)
    number = np.isfinite(each).sum(0)
    if (number < len(each)).any():
        few = int(np.argmin(np.where(number > 0, number, len(each))))
        where = f"{number[few]} of {len(each)} at {x[few]:,.10g}"
        lines.append(f"{task}, {label}: thin where not all seeds have a value, {where}")
    runs = tuple(str(each.run) for each in members)
    middle, low, high = _averaged(each)
    return Curve(task, metric, label, seeds, runs, x, each, middle, low, high, tuple(lines))


def _averaged(each: np.ndarray) -> np.ndarray:
    """IQM and ends of the band [3, G] of [S, G], at each point over the seeds with a value."""
    averages = np.full((3, each.shape[1]), np.nan)
    present = np.isfinite(each)
    for pattern in np.unique(present, axis=1).T:
        if pattern.any():
            at = (present == pattern[:, None]).all(0)
            values = each[np.ix_(pattern, at)]
            averages[:, at] = iqm(values), *band(values)
    return averages
