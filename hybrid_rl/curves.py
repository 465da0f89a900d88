"""Learning curves of many runs: read, brought to common steps, averaged over seeds.

    IQM = sum_i w_i v_(i) / sum_i w_i,   w_i = |[i-1, i] within [n/4, 3n/4]|

over the n sorted seeds v_(1) <= ... <= v_(n): the mean of the middle half, where a
seed on its border counts in part, so that few seeds are treated as evenly as many
(5 seeds: 0, 3/4, 1, 3/4, 0; for n divisible by 4 it is the 25% trimmed mean). The
band is the 95% percentile bootstrap of the IQM, resampling seeds.
Source: Agarwal et al., Deep RL at the Edge of the Statistical Precipice, NeurIPS 2021.
"""

import glob
import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from omegaconf import DictConfig, OmegaConf

from hybrid_rl.config import UsageError

POINTS = 100  # of a curve whose seeds have no common steps
RESAMPLES = 2000  # of the bootstrap
TIMES = ("step", "wall_s")  # of a row; any other x is a key of the configuration
PLACE = ("step", "seed", "wall_s")  # of a row; every other name is a metric


@dataclass(frozen=True)
class Curve:
    """One line of a figure."""

    task: str
    metric: str
    label: str  # what sets it apart from the other lines
    seeds: tuple[int, ...]  # S learners, in the order of `each`
    runs: tuple[str, ...]  # the run folder of each learner
    x: np.ndarray  # [G] decisions of a learner, seconds, or what was swept
    each: np.ndarray  # [S, G] the metric of each learner
    iqm: np.ndarray  # [G] interquartile mean over the learners
    low: np.ndarray  # [G] lower end of the 95% band
    high: np.ndarray  # [G] upper end
    notes: tuple[str, ...]  # what a reader should know, one line each


@dataclass(frozen=True)
class Learner:
    """What one seed of one run logged."""

    run: Path
    seed: int
    x: np.ndarray  # [N] rising
    y: np.ndarray  # [N]


def curves(
    runs: str | Path | Iterable[str | Path],
    metric: str = "train/return",
    x: str = "step",
    group: str = "algo",
    smooth: float = 0.0,
) -> list[Curve]:
    """A curve for each task and each value of `group`, a key of the runs' configuration.

    runs: a glob, or folders; whatever lies below them and holds metrics.jsonl is a run.
    x: "step" [decisions], "wall_s" [s], or a number in the runs' configuration that a sweep went
    through, such as num_demonstrations: there a run is one point, what it had at last.
    smooth: width of a moving mean over each seed, in units of x. Where the seeds logged at the
    same steps, these are the points; else each seed is averaged in bins, with a straight line
    over empty ones.
    A curve ends where its shortest seed ends.

    Raises:
        UsageError: where nothing fits; the line says what would.
    """
    groups: dict[tuple[str, str], list[Learner]] = {}
    names: set[str] = set()
    for run in find(runs):
        found, logged = _read(run, metric, x if x in TIMES else "step")
        if x not in TIMES:
            found = [_last(learner, _number(run, x)) for learner in found]
        names |= logged
        if found:
            task, label = _name(run, "task"), _name(run, group)
            label = label if group == "algo" else f"{group}={label}"
            groups.setdefault((task, label), []).extend(found)
    if not groups:
        known = ", ".join(sorted(names)) or "no metric yet"
        raise UsageError(f"metric={metric}: not in these runs; they have {known}")
    if x not in TIMES:
        groups = {place: _swept(learners) for place, learners in groups.items()}
    return [
        _curve(task, metric, label, groups[task, label], smooth) for task, label in sorted(groups)
    ]


def find(runs: str | Path | Iterable[str | Path]) -> list[Path]:
    """Run folders that match a glob, or that lie in the folders given."""
    if isinstance(runs, (str, Path)):
        matches = [Path(match) for match in glob.glob(str(Path(runs).expanduser()), recursive=True)]
    else:
        matches = [Path(run) for run in runs]
    below = {path.parent for match in matches for path in match.glob("**/metrics.jsonl")}
    if not below:
        raise UsageError(f"runs={runs}: no run there (a folder that holds metrics.jsonl)")
    return sorted(below)


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


def area(curve: Curve) -> np.ndarray:
    """[S] mean of each learner's metric over the run: the area under its curve over its width.

    Before its first row a learner has what it had there.
    """
    x, y = np.append(0.0, curve.x), np.concatenate([curve.each[:, :1], curve.each], axis=1)
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


def _read(run: Path, metric: str, x: str) -> tuple[list[Learner], set[str]]:
    """The learners of a run that logged `metric`, and the names of all that was logged."""
    text = (run / "metrics.jsonl").read_text(encoding="utf-8")
    whole = text[: text.rfind("\n") + 1]  # a run at work may be in the middle of a row
    rows = [json.loads(line) for line in whole.splitlines()]
    names = {name for row in rows for name in row} - set(PLACE)
    points: dict[int, list[tuple[float, float]]] = {}
    for row in rows:
        if row.get(metric) is not None:  # null: it was not finite
            points.setdefault(row["seed"], []).append((row[x], row[metric]))
    learners = []
    for seed in sorted(points):
        at, y = np.array(points[seed], float).T
        order = np.argsort(at, kind="stable")
        learners.append(Learner(run, seed, at[order], y[order]))
    return learners, names


def _name(run: Path, key: str) -> str:
    """What a run says about itself, in summary.json or else in config.yaml."""
    summary, config = run / "summary.json", run / "config.yaml"
    said = json.loads(summary.read_text(encoding="utf-8")) if summary.exists() else {}
    if key not in said and config.exists():
        read = OmegaConf.load(config)
        parent, _, name = key.rpartition(".")
        place = OmegaConf.select(read, parent) if parent else read
        if isinstance(place, DictConfig) and name in place:
            said = {key: OmegaConf.select(read, key)}
    if key not in said:
        raise UsageError(f"group={key}: {run} says nothing of it in config.yaml")
    return "null" if said[key] is None else str(said[key])


def _number(run: Path, key: str) -> float:
    """The number at `key` of a run's configuration."""
    config = OmegaConf.load(run / "config.yaml") if (run / "config.yaml").exists() else None
    value = OmegaConf.select(config, key) if config is not None else None
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise UsageError(f"x={key}: must be step, wall_s, or a number in every run's config.yaml")
    return float(value)


def _last(learner: Learner, at: float) -> Learner:
    """A learner as one point: what it had at last."""
    return replace(learner, x=np.array([at]), y=learner.y[-1:])


def _swept(learners: list[Learner]) -> list[Learner]:
    """One learner for each seed, from its points in several runs."""
    joined = []
    for seed in sorted({learner.seed for learner in learners}):
        same = [learner for learner in learners if learner.seed == seed]
        x, y = (np.concatenate([getattr(learner, name) for learner in same]) for name in "xy")
        order = np.argsort(x, kind="stable")
        joined.append(Learner(same[0].run, seed, x[order], y[order]))
    return joined


def _curve(task: str, metric: str, label: str, learners: list[Learner], smooth: float) -> Curve:
    """Learners of one kind as one line."""
    ends = [learner.x[-1] for learner in learners]
    notes = []
    if min(ends) < 0.99 * max(ends):
        short = learners[int(np.argmin(ends))]
        end = f"{min(ends):,.0f} of {max(ends):,.0f}"
        notes.append(f"{task}, {label}: ends at {end}, with seed {short.seed} of {short.run}")
    seeds = tuple(learner.seed for learner in learners)
    twice = sorted({seed for seed in seeds if seeds.count(seed) > 1})
    if twice and "=" not in label:  # else the algorithms of a group share seeds
        notes.append(f"{task}, {label}: seeds {twice} are in several run folders and count in each")
    x, each = _common(learners, smooth)
    low, high = band(each)
    runs = tuple(str(learner.run) for learner in learners)
    return Curve(task, metric, label, seeds, runs, x, each, iqm(each), low, high, tuple(notes))


def _common(learners: list[Learner], smooth: float) -> tuple[np.ndarray, np.ndarray]:
    """Points that all learners share, and their values there: [G], [S, G]."""
    last = min(learner.x[-1] for learner in learners)
    shared = np.unique(learners[0].x[learners[0].x <= last])
    same = all(np.array_equal(np.unique(z.x[z.x <= last]), shared) for z in learners)
    if same and len(shared) <= 10 * POINTS:
        edges = np.append(-np.inf, shared)
        x = shared
    else:
        first = max(learner.x[0] for learner in learners)
        count = min(POINTS, max(2, min(len(learner.x) for learner in learners)))
        x = np.linspace(min(first, last), last, count)
        edges = np.append(-np.inf, x)
    return x, np.stack([_binned(learner, x, edges, smooth) for learner in learners])


def _binned(learner: Learner, x: np.ndarray, edges: np.ndarray, smooth: float) -> np.ndarray:
    """[G] means of a learner's rows in the bins (edges[i], edges[i+1]]."""
    y = _moving_mean(learner.x, learner.y, smooth)
    which = np.searchsorted(edges[1:], learner.x)  # the first edge at or after it
    inside = which < len(x)
    total = np.bincount(which[inside], y[inside], len(x))
    number = np.bincount(which[inside], minlength=len(x))
    full = number > 0
    return np.interp(x, x[full], total[full] / number[full])


def _moving_mean(x: np.ndarray, y: np.ndarray, width: float) -> np.ndarray:
    """[N] mean of all y whose x is within width / 2."""
    start = np.searchsorted(x, x - width / 2, side="left")
    end = np.searchsorted(x, x + width / 2, side="right")
    sums = np.append(0.0, np.cumsum(y))
    return (sums[end] - sums[start]) / (end - start)
