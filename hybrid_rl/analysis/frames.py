"""Rows and curves of runs as tables of pandas, which is no dependency."""

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from typing import Any

from hybrid_rl.analysis.results import RunFolder, find


def metrics(runs: str | Path | Iterable[str | Path]) -> Any:
    """A pandas.DataFrame of all rows of runs: run, step, seed, wall_s, and a column per metric.

        table = metrics("runs/hopper/sac/TIME")
        table.dropna(subset="eval/return").pivot(index="step", columns="seed", values="eval/return")

    A row has NaN in what it did not log. runs: folders, or a pattern as of `figures`.

    Raises:
        UsageError: if there is no run, or a damaged one.
        ImportError: without pandas.
    """
    frame = pandas().DataFrame
    folders = [RunFolder(path) for path in find(runs)]
    return frame([{"run": str(one.path), **row} for one in folders for row in one.rows])


def pandas() -> Any:
    """The module; an ImportError with the command that installs it if there is none."""
    try:
        return import_module("pandas")
    except ImportError as error:
        line = 'needs pandas, which is not installed; pip install "hybrid_rl[pandas]"'
        raise ImportError(line) from error
