"""Learning curves of many runs: read, brought to common steps, averaged over seeds.

    IQM = sum_i w_i v_(i) / sum_i w_i,   w_i = |[i-1, i] within [n/4, 3n/4]|

over the n sorted seeds v_(1) <= ... <= v_(n): the mean of the middle half, where a
seed on its border counts in part, so that few seeds are treated as evenly as many
(5 seeds: 0, 3/4, 1, 3/4, 0; for n divisible by 4 it is the 25% trimmed mean). The
band is the 95% percentile bootstrap of the IQM, resampling seeds.
Source: Agarwal et al., Deep RL at the Edge of the Statistical Precipice, NeurIPS 2021.

A seed that diverged, or whose return was not finite, counts as a failure (hybrid_rl.studies.logged).
"""

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.errors import UsageError
from hybrid_rl.run.results import NOT_ROWS, RunFolder, differences, find, short
from hybrid_rl.studies.logged import Learner, common, counted, learners, swept

RESAMPLES = 2000  # of the bootstrap
TIMES = ("step", "wall_s")  # of a row; any other x is a key of the configuration
ARRAYS = ("x", "each", "iqm", "low", "high")  # of a curve
Key = tuple[str, str]  # task and label of a curve


@dataclass(frozen=True)
class Curve:
    """One line of a figure."""

    task: str
    metric: str
    label: str  # what sets it apart from the other lines
    seeds: tuple[int, ...]  # S learners, in the order of `each`
    runs: tuple[str, ...]  # the run folder of each learner
    x: np.ndarray  # [G] decisions of a learner, seconds, or what was swept
    each: np.ndarray  # [S, G] the metric of each learner, NaN where it has none
    iqm: np.ndarray  # [G] interquartile mean over the learners that have a value
    low: np.ndarray  # [G] lower end of the 95% band
    high: np.ndarray  # [G] upper end
    notes: tuple[str, ...]  # what a reader should know, one line each

    @property
    def shared(self) -> np.ndarray:
        """[G] whether all learners have a value there."""
        return np.isfinite(self.each).all(0)


def curves(
    runs: str | Path | Iterable[str | Path],
    metric: str = "train/return",
    x: str = "step",
    group: str = "algo",
    smooth: float = 0.0,
) -> list[Curve]:
    """A curve for each task, each value of `group`, and each set of settings.

    runs: a glob, or folders; whatever lies below them and holds metrics.jsonl is a run.
    x: "step" [decisions], "wall_s" [s], or a number in the runs' configuration that a sweep went
    through, such as num_demonstrations: there a run is one point, what it had at last.
    group: a key of the runs' configuration. Runs that differ in more than `group` and `x` are
    different curves, named by what differs (hybrid_rl.run.results.differences); runs of the same
    settings are one curve, whatever their seeds.
    smooth: width of a moving mean over each seed, in units of x. Where the seeds logged at the
    same steps, these are the points; else each seed is averaged in bins, with a straight line
    over empty ones.
    A curve goes as far as its longest seed, averaged over those that have a value.

    Raises:
        UsageError: where nothing fits, and where a file is damaged; the line says what would.
    """
    folders = [RunFolder(path) for path in find(runs)]
    with_rows = [run for run in folders if run.rows]
    found: dict[Key, list[Learner]] = {}
    notes: dict[Key, list[str]] = {}
    for key, (members, differing) in _grouped(with_rows, x, group).items():
        every = [each for run in members for each in learners(run, metric, _time(x))]
        found[key] = [each for each in every if each.counts]
        notes[key] = [*differing, *_left_out(metric, every), *_cut(members)]
    if not any(len(each.x) for members in found.values() for each in members):
        raise _nothing(folders, metric)
    for task in {task for task, _ in found}:
        panel = {key: members for key, members in found.items() if key[0] == task and members}
        for key, (members, lines) in counted(metric, panel).items():
            found[key] = members
            notes[key] += lines
    if x not in TIMES:
        numbers = {run.path: run.number(x) for run in with_rows}
        for key, members in found.items():
            notes[key] += _twice([(each.seed, numbers[each.run]) for each in members])
            found[key] = swept(members, numbers)
    drawn = [key for key in sorted(found) if any(np.isfinite(each.y).any() for each in found[key])]
    lines = {key: [f"{', '.join(key)}: {line}" for line in notes[key]] for key in sorted(notes)}
    lines[drawn[0]] += [line for key in lines if key not in drawn for line in lines[key]]
    lines[drawn[0]] += [f"{run.path}: no rows yet; left out" for run in folders if not run.rows]
    return [_curve(key, metric, found[key], smooth, lines[key]) for key in drawn]


def from_json(file: str | Path) -> tuple[list[Curve], dict[str, str]]:
    """The curves that hybrid_rl.figures wrote beside a picture, and what it wrote of them.

    Raises:
        UsageError: where the file holds none.
    """
    try:
        read = json.loads(Path(file).read_text(encoding="utf-8"))
        drawn = [_from_numbers(one, read) for one in read["curves"]]
    except OSError as error:
        raise UsageError(f"runs={file}: cannot be read ({error.strerror})") from error
    except (ValueError, KeyError, TypeError) as error:
        raise UsageError(f"runs={file}: holds no curves that figures wrote") from error
    return drawn, {key: value for key, value in read.items() if isinstance(value, str)}


def iqm(values: np.ndarray) -> np.ndarray:
    """Interquartile mean over the first axis: [n, ...] -> [...]."""
    n = len(values)
    edges = np.clip(np.arange(n + 1), n / 4, 3 * n / 4)
    return np.tensordot(np.diff(edges) / (n / 2), np.sort(values, axis=0), axes=1)


def band(values: np.ndarray, resamples: int = RESAMPLES) -> tuple[np.ndarray, np.ndarray]:
    """95% bootstrap band of the IQM over the first axis: [n, ...] -> two of [...]."""
    n = len(values)
    draws = np.random.default_rng(0).integers(n, size=(resamples, n))
    low, high = np.percentile([iqm(values[draw]) for draw in draws], [2.5, 97.5], axis=0)
    return low, high


def spread(values: np.ndarray) -> str:
    """IQM of [n] and its band, in words: "8,250 [6,429, 8,979]"; a single value alone."""
    middle = f"{iqm(values):,.4g}"
    if len(values) == 1:
        return middle
    low, high = band(values)
    return f"{middle} [{low:,.4g}, {high:,.4g}]"


def area(curve: Curve) -> np.ndarray:
    """[S] mean of each learner's metric over the run: the area under its curve over its width.

    Up to the last point that all learners have; NaN where there is none. Before its first row a
    learner has what it had there.
    """
    x, each = curve.x[curve.shared], curve.each[:, curve.shared]
    if not len(x):
        return np.full(len(each), np.nan)
    x, y = np.append(0.0, x), np.concatenate([each[:, :1], each], axis=1)
    return np.trapezoid(y, x, axis=1) / x[-1]


def steps_to(curve: Curve, threshold: float) -> np.ndarray:
    """[S] where each learner's metric first reaches `threshold`, infinite where it never does."""
    reached = curve.each >= threshold
    return np.where(reached.any(1), curve.x[reached.argmax(1)], np.inf)


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


def _time(x: str) -> str:
    return x if x in TIMES else "step"


def _grouped(
    runs: Sequence[RunFolder], x: str, group: str
) -> dict[Key, tuple[list[RunFolder], list[str]]]:
    """The runs of each curve, and their settings where the label is a letter."""
    parts: dict[tuple[str, str, str], list[RunFolder]] = {}
    for run in runs:
        parts.setdefault((run.word("task"), run.word(group), run.word("algo")), []).append(run)
    found: dict[Key, tuple[list[RunFolder], list[str]]] = {}
    for (task, value, algo), members in parts.items():
        label = algo if group == "algo" else f"{group}={value}"
        if len([key for key in parts if key[:2] == (task, value)]) > 1:
            label += f" algo={algo}"
        differ = differences(members, [key for key in (x, group) if key not in TIMES])
        for run, name, more in zip(members, short(differ), differ, strict=True):
            settings = ", ".join(f"{key}={shown}" for key, shown in more.items())
            lines = [settings] if settings and "=" not in name else []
            found.setdefault((task, f"{label} {name}".strip()), ([], lines))[0].append(run)
    return found


def _left_out(metric: str, every: list[Learner]) -> list[str]:
    """Which learners have no value of the metric yet."""
    without = [each for each in every if not each.counts]
    if len(without) == len(every):
        return [f"no {metric}"]
    return [f"seed {one.seed} of {one.run} has no {metric} yet; left out" for one in without]


def _cut(members: list[RunFolder]) -> list[str]:
    return [f"the last row of {run.path} is cut; left out" for run in members if run.cut]


def _nothing(folders: list[RunFolder], metric: str) -> UsageError:
    """What to say where no run has the metric."""
    names = {name for run in folders for row in run.rows for name in row} - set(NOT_ROWS)
    if names:
        return UsageError(
            f"metric={metric}: not in these runs; they have {', '.join(sorted(names))}"
        )
    more = f" and {len(folders) - 1} more" if len(folders) > 1 else ""
    return UsageError(
        f"metric={metric}: not in these runs; {folders[0].path / 'metrics.jsonl'}{more}: "
        "no metric yet"
    )


def _twice(learners: list[tuple[int, float]]) -> list[str]:
    """Which (seed, number) are there several times."""
    seeds = sorted({seed for seed, number in learners if learners.count((seed, number)) > 1})
    return [f"seeds {seeds} are in several run folders and count in each"] if seeds else []


def _curve(key: Key, metric: str, members: list[Learner], smooth: float, notes: list[str]) -> Curve:
    """Learners of one kind as one line."""
    (task, label), lines = key, list(notes)
    seeds = tuple(each.seed for each in members)
    lines += [f"{task}, {label}: {line}" for line in _twice([(seed, 0.0) for seed in seeds])]
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
    """IQM and ends of the band [3, G] of [S, G], at each point over those that have a value."""
    found = np.full((3, each.shape[1]), np.nan)
    present = np.isfinite(each)
    for pattern in np.unique(present, axis=1).T:
        if pattern.any():
            at = (present == pattern[:, None]).all(0)
            values = each[np.ix_(pattern, at)]
            found[:, at] = iqm(values), *band(values)
    return found


def _from_numbers(one: dict[str, Any], read: dict[str, Any]) -> Curve:
    """A curve from its JSON; null becomes NaN."""
    metric = one.get("metric", read["metric"])
    seeds, runs, notes = (tuple(one[name]) for name in ("seeds", "runs", "notes"))
    x, each, middle, low, high = (np.array(one[name], float) for name in ARRAYS)
    return Curve(one["task"], metric, one["label"], seeds, runs, x, each, middle, low, high, notes)
