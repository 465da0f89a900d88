"""Rows and curves of runs as tables of pandas, which is no dependency."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from hybrid_rl.analysis.results import RunFolder, find
from hybrid_rl.run.folder import members


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
    import pandas

    folders = [RunFolder(path) for path in find(runs)]
    named = [({"run": str(one.path), **_values(one.path)}, one.rows) for one in folders]
    return pandas.DataFrame([name | row for name, rows in named for row in rows])


def _values(run: Path) -> dict[str, float]:
    """What sets a run apart in the sweep that it belongs to, by key; {} for any other run."""
    return members(run.parent).get(run, {})
