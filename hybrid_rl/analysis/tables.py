"""Curves and rows of runs as tables. A long table has a row for each value of a seed.

    exp_name,env_name,seed,metric,env_step,value

These are the columns in which SimbaV2 and others publish their curves, so that their scripts draw
ours next to theirs. `avg_return` is their name of eval/return; other metrics keep their names.
exp_name is the label of the curve, env_name the task, env_step the number of decisions.
"""

import csv
import io
from collections import defaultdict
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.analysis.curves import Curve, curve_of
from hybrid_rl.analysis.logged import Learner
from hybrid_rl.analysis.results import RunFolder, find
from hybrid_rl.errors import UsageError
from hybrid_rl.files.reading import text as text_of
from hybrid_rl.run.folder import members

COLUMNS = ("exp_name", "env_name", "seed", "metric", "env_step", "value")
NAMES = {"eval/return": "avg_return"}
FLOAT32 = float(np.finfo(np.float32).max)  # greatest number that is drawn


def text(drawn: Sequence[Curve], x: str) -> str:
    """The text of the table; a missing value has no row."""
    _check_over_decisions(x)
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(COLUMNS)
    for curve in drawn:
        metric = NAMES.get(curve.metric, curve.metric)
        for seed, values in zip(curve.seeds, curve.each, strict=True):
            for step, value in zip(curve.x, values.astype("float32"), strict=True):
                if np.isfinite(value):
                    rows.writerow((curve.label, curve.task, seed, metric, f"{step:.10g}", value))
    return out.getvalue()


def read(
    file: str | Path, metric: str, tasks: Collection[str], x: str = "step", smooth: float = 0.0
) -> list[Curve]:
    """The curves of `metric` in a table with these columns, labelled by exp_name and its file.

    tasks: of the runs that they are drawn beside, over x.
    """
    _check_over_decisions(x)
    found: dict = defaultdict(lambda: defaultdict(list))
    try:
        rows = csv.DictReader(io.StringIO(text_of(Path(file)).removeprefix("\ufeff")))
        for row in rows:
            point = float(row["env_step"]), float(row["value"])
            drawable = max(map(abs, point)) <= FLOAT32  # NaN is not
            if row["metric"] in (metric, NAMES.get(metric)) and drawable:
                found[row["env_name"], row["exp_name"]][int(row["seed"])].append(point)
    except UsageError as error:
        raise UsageError(f"others={error}") from error
    except (KeyError, ValueError, TypeError, csv.Error) as error:
        raise UsageError(f"others={file}: must have the columns {', '.join(COLUMNS)}") from error
    if not found or {task for task, _ in found} - set(tasks):
        wanted = f"the metric {NAMES.get(metric, metric)}, env_name of {', '.join(sorted(tasks))}"
        raise UsageError(f"others={file}: must have rows of {wanted}, and of no other task")
    return [
        curve_of(
            (task, f"{name} ({Path(file).name})"),
            metric,
            [Learner(Path(file), seed, *np.array(sorted(p)).T) for seed, p in each.items()],
            smooth,
        )
        for (task, name), each in found.items()
    ]


def metrics(runs: str | Path | Iterable[str | Path]) -> Any:
    """A pandas.DataFrame of all rows of runs: run, step, seed, wall_s, and a column per metric.

        table = metrics("runs/hopper/sac/TIME")
        table.dropna(subset="eval/return").pivot(index="step", columns="seed", values="eval/return")

    A row has NaN in what it did not log. runs: folders, or a pattern as of `figures`. Of a sweep in
    one program there is also a column for each of its keys, such as policy_learner.discount.

    Raises:
        UsageError: if there is no run, or a damaged one.
        ImportError: without pandas.
    """
    import pandas  # pyright: ignore[reportMissingImports]: an extra

    table = []
    for path in find(runs):
        swept = members(path.parent).get(path, {})  # what sets it apart in its sweep
        table += [{"run": str(path), **swept, **row} for row in RunFolder(path).rows]
    return pandas.DataFrame(table)


def _check_over_decisions(x: str) -> None:
    if x != "step":
        raise UsageError(f"x={x}: tables are over decisions, x=step")
