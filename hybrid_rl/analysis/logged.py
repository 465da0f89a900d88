"""One metric that learners logged, with failures counted, at common points.

Where a return or a success is not finite (null in metrics.jsonl), and from the step at which a
learner diverged, the learner is given the lowest value that any learner of the same task had up to
that step: the failure counts against its method, and the curve of the others goes on. Of other
metrics the worst value is not known, and a failed learner has no value.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from hybrid_rl.analysis.results import RunFolder

POINTS = 100  # of a curve whose seeds have no common steps
SPARE = 1.25  # steps of all learners over those of one, up to which the steps are common
SAME_END = 0.99  # ratio of two ends from which they are the same end
OUTCOMES = ("return", "success", "belief/best")  # name endings of metrics to maximise
RULE = "as the lowest value that any learner of the task had up to there"
Panel = Mapping[tuple[str, str], list["Learner"]]  # (task, label) -> learners, of one task


@dataclass(frozen=True)
class Learner:
    """The values that one seed of one run logged."""

    run: Path
    seed: int
    x: np.ndarray  # [N] ascending
    y: np.ndarray  # [N] NaN where it was not finite
    ended: float = np.inf  # x at which it diverged
    why: str = ""  # the quantity that was not finite

    @property
    def counts(self) -> bool:
        """Whether it has a value or a failure."""
        return len(self.x) > 0 or self.ended < np.inf


def learners(run: RunFolder, metric: str, x: str) -> list[Learner]:
    """The learners of a run; x: "step" or "wall_s"."""
    every, of_seed = [], defaultdict(list)
    for row in run.rows:
        of_seed[row["seed"]].append(row)
    for seed, rows in sorted(of_seed.items()):
        points = [(row[x], row[metric]) for row in rows if metric in row]
        at, y = np.array(points, float).reshape(-1, 2).T  # None becomes NaN
        order = np.argsort(at, kind="stable")
        end = next((row for row in rows if "diverged" in row), None)
        failed = (float(end[x]), str(end["diverged"])) if end else (np.inf, "")
        every.append(Learner(run.path, seed, at[order], y[order], *failed))
    return every


def count_failures(
    metric: str, panel: Panel
) -> dict[tuple[str, str], tuple[list[Learner], list[str]]]:
    """The learners of a task with values for their failures, and notes on these.

    A learner that diverged is continued over the points of the longest that did not.
    """
    everyone = [learner for members in panel.values() for learner in members]
    x, y = (np.concatenate([getattr(each, name) for each in everyone]) for name in "xy")
    order = np.argsort(x[np.isfinite(y)], kind="stable")
    steps, lowest = (values[np.isfinite(y)][order] for values in (x, y))
    lowest = np.minimum.accumulate(lowest)
    outcome = metric.endswith(OUTCOMES) and len(lowest) > 0

    def one(learner: Learner, points: np.ndarray) -> tuple[Learner, list[str]]:
        later = np.setdiff1d(points[points >= learner.ended], learner.x)
        x, y = np.append(learner.x, later), np.append(learner.y, np.full(len(later), np.nan))
        failed = np.isnan(y)
        if outcome and failed.any():
            before = np.searchsorted(steps, x[failed], side="right") - 1
            y[failed] = lowest[np.maximum(before, 0)]
        return replace(learner, x=x, y=y), _failures(learner, outcome)

    result = {}
    for key, members in panel.items():
        going = [each for each in members if each.ended == np.inf]
        going = going or [each for each in everyone if each.ended == np.inf] or members
        longest = max(going, key=lambda each: each.x.max(initial=-np.inf))
        each = [one(learner, longest.x) for learner in members]
        notes = [line for _, lines in each for line in lines]
        result[key] = [learner for learner, _ in each], notes
    return result


def _failures(learner: Learner, outcome: bool) -> list[str]:
    """A note for each kind of failure of a learner, with the rule that applies."""
    lines = []
    name = f"seed {learner.seed} of {learner.run}"
    empty = learner.x[np.isnan(learner.y) & (learner.x < learner.ended)]
    if len(empty):
        where = ", ".join(f"{at:,.0f}" for at in empty[:3]) + ", ..." * (len(empty) > 3)
        rule = f"counts {RULE}" if outcome else "is left out there"
        lines.append(f"{name} is not finite at {where} and {rule}")
    if learner.ended < np.inf:
        rule = f"counts from there on {RULE}" if outcome else "is left out from there on"
        lines.append(f"{name} diverged at {learner.ended:,.0f} ({learner.why}) and {rule}")
    return lines


def swept(members: Sequence[Learner], numbers: Mapping[Path, float]) -> list[Learner]:
    """One learner per seed: the last value of each of its runs over the number of that run."""
    joined = []
    for seed in sorted({learner.seed for learner in members}):
        same = [learner for learner in members if learner.seed == seed and len(learner.x)]
        x, y = np.array([(numbers[one.run], one.y[-1]) for one in same]).reshape(-1, 2).T
        order = np.argsort(x, kind="stable")
        joined.append(Learner(same[0].run, seed, x[order], y[order]))
    return joined


def common(members: Sequence[Learner], smooth: float) -> tuple[np.ndarray, np.ndarray]:
    """Common points [G] of all learners, and their values [S, G]; NaN where a learner has none."""
    lasts = [learner.x[-1] for learner in members if len(learner.x)]
    end = max(lasts)
    if min(lasts) >= SAME_END * end:
        end = min(lasts)
    steps = [np.unique(learner.x[learner.x <= end]) for learner in members]
    x = np.unique(np.concatenate(steps))
    if len(x) > min(SPARE * max(map(len, steps)) + 1, 10 * POINTS):
        widths = [(at[-1] - at[0]) / (len(at) - 1) for at in steps if len(at) > 1]
        first = min(max(at[0] for at in steps if len(at)), end)
        count = round((end - first) / max(widths)) + 1 if widths else 2
        x = np.linspace(first, end, min(max(count, 2), POINTS))
    return x, np.stack([_binned(learner, x, smooth) for learner in members])


def _binned(learner: Learner, x: np.ndarray, smooth: float) -> np.ndarray:
    """[G] means of a learner's rows in the bins (x[i-1], x[i]]; the first has no lower end.

    Empty bins between rows are interpolated linearly; before the first row, after the last one, and
    where rows are not finite, the value is NaN.
    """
    y = _moving_mean(learner.x, learner.y, smooth)
    which = np.searchsorted(x, learner.x)  # the first point at or after it
    good, bad = (chosen & (which < len(x)) for chosen in (np.isfinite(y), np.isnan(y)))
    total = np.bincount(which[good], y[good], len(x))
    number = np.bincount(which[good], minlength=len(x))
    full = number > 0
    if not full.any():
        return np.full(len(x), np.nan)
    values = np.interp(x, x[full], total[full] / number[full], left=np.nan, right=np.nan)
    values[(np.bincount(which[bad], minlength=len(x)) > 0) & ~full] = np.nan
    return values


def _moving_mean(x: np.ndarray, y: np.ndarray, width: float) -> np.ndarray:
    """[N] mean of all finite y whose x is within width / 2; NaN where y is NaN."""
    start = np.searchsorted(x, x - width / 2, side="left")
    end = np.searchsorted(x, x + width / 2, side="right")
    finite = np.isfinite(y)
    sums = np.append(0.0, np.cumsum(np.where(finite, y, 0.0)))
    number = np.append(0, np.cumsum(finite))
    mean = (sums[end] - sums[start]) / np.maximum(number[end] - number[start], 1)
    return np.where(finite, mean, np.nan)
