"""Copies of a run's rows for other tools, beside metrics.jsonl and tensorboard/.

    csv      metrics.csv, a line step,seed,wall_s,metric,value for each number
    wandb    Weights & Biases, a run of theirs for each seed, in a group for each run folder
    trackio  Trackio, the same in a database on this disk, at each checkpoint

W&B's own variables apply: WANDB_PROJECT, WANDB_ENTITY and, without a network, WANDB_MODE=offline.
A resumed run continues the runs of W&B, which drop steps that they have already. Trackio's
databases are in runs/trackio, or in TRACKIO_DIR.

A logger is called with each row; it is made before the first one, of what the run has begun with.
"""

import csv
import os
import uuid
from collections.abc import Callable, Sequence
from contextlib import redirect_stdout
from importlib import import_module
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple

from hybrid_rl.errors import UsageError, install
from hybrid_rl.files.atomic import open_own, own_folder
from hybrid_rl.run.logs.records import COORDINATES, Row

HEADER = (*COORDINATES, "metric", "value")
PACKAGES = ("wandb", "trackio")  # extras of the same name
TRACKIO = ("TRACKIO_DIR", "runs/trackio")  # read by Trackio when it is imported


class Begun(NamedTuple):
    """A run whose rows are to come."""

    folder: Path
    seeds: Sequence[int]
    config: dict[str, Any]
    rows: Sequence[Row] = ()  # that a resumed run has already
    step: int | None = None  # from which it is resumed


class Logger:
    """Gets rows; subclasses leave out methods for which they have nothing to do."""

    def __call__(self, row: Row) -> None:
        """Add a row."""

    def flush(self) -> None:
        """Pass on all rows."""

    def close(self) -> None:
        """End it."""


def scalars(row: Row) -> dict[str, float]:
    """The finite numbers of a row."""
    return {
        name: value
        for name, value in row.items()
        if name not in COORDINATES and value is not None and not isinstance(value, str)
    }


class CSV(Logger):
    """metrics.csv in the run folder, written again where a run is resumed."""

    def __init__(self, run: Begun) -> None:
        path = run.folder / "metrics.csv"
        self._file = open_own(path, "w", buffering=1, encoding="ascii", newline="")
        self._lines = csv.writer(self._file)
        self._lines.writerow(HEADER)
        for row in run.rows:
            self(row)

    def __call__(self, row: Row) -> None:
        """Add a line for each number."""
        at = [row[name] for name in COORDINATES]
        self._lines.writerows([*at, name, value] for name, value in scalars(row).items())

    def close(self) -> None:
        """Close the file."""
        self._file.close()


class WandB(Logger):
    """Runs of Weights & Biases, one a seed, started by its first row.

    The run folder holds what they write, and an id for each of them.
    """

    def __init__(self, run: Begun) -> None:
        self._run = run._replace(rows=())
        self._runs: dict[int, Any] = {}  # by seed

    def __call__(self, row: Row) -> None:
        """Log the numbers of a row at its step."""
        if values := scalars(row):
            run = self._started(int(row["seed"]))
            run.log(values | {"wall_s": row["wall_s"]}, step=int(row["step"]))

    def _started(self, seed: int) -> Any:
        if seed not in self._runs:
            wandb: Any = import_module("wandb")
            folder, config = self._run.folder, self._run.config
            self._runs[seed] = wandb.init(
                id=self.id_of(seed),
                resume="allow",
                name=folder.name + (f" seed {seed}" if len(self._run.seeds) > 1 else ""),
                group=str(folder),
                job_type=f"{config['task']} {config['algo']}",
                dir=str(folder),
                config=config | {"seed": seed},
                reinit="create_new",
                settings=wandb.Settings(console="off"),
            )
        return self._runs[seed]

    def id_of(self, seed: int) -> str:
        """The id of the run of a seed, the same when it is resumed."""
        file = self._run.folder / "wandb" / f"seed_{seed}.id"
        if not file.exists():
            own_folder(file.parent)
            with open_own(file, "w", encoding="ascii") as out:
                out.write(uuid.uuid4().hex[:12])
        with open_own(file, "r", encoding="ascii") as given:
            return given.read(100)

    def close(self) -> None:
        """End the runs."""
        for run in self._runs.values():
            run.finish()


class Trackio(Logger):
    """Runs of Trackio, one a seed, in a project for each task.

    Only one of them can be open, so rows are kept until `flush`, before a checkpoint, or the end.
    """

    def __init__(self, run: Begun) -> None:
        self._run = run._replace(rows=())
        self._rows: dict[int, list[Row]] = {seed: [] for seed in run.seeds}
        self._known = set() if run.step is None else set(run.seeds)  # seeds that have a run

    def __call__(self, row: Row) -> None:
        """Keep a row."""
        if scalars(row):
            self._rows[int(row["seed"])].append(row)

    def flush(self) -> None:
        """Hand over all rows, seed by seed."""
        for seed, rows in self._rows.items():
            if not rows:
                continue
            with redirect_stdout(StringIO()):  # several lines each time
                trackio: Any = import_module("trackio")
                run = trackio.init(
                    project=str(self._run.config["task"]),
                    name=f"{self._run.folder} seed {seed}",
                    group=str(self._run.folder),
                    config=self._run.config | {"seed": seed},
                    resume="allow" if seed in self._known else "never",
                    embed=False,
                    auto_log_gpu=False,
                    auto_log_cpu=False,
                )
                for row in rows:
                    run.log(scalars(row) | {"wall_s": row["wall_s"]}, step=int(row["step"]))
                trackio.finish()
            self._known.add(seed)
            rows.clear()

    def close(self) -> None:
        """Hand over the rest."""
        self.flush()


KINDS: dict[str, Callable[[Begun], Logger]] = {"csv": CSV, "wandb": WandB, "trackio": Trackio}


def check(given: Any) -> tuple[str, ...]:
    """The loggers that the key `logger` of a configuration names; null: none."""
    names = () if given is None else (given,) if isinstance(given, str) else tuple(given)
    for name in names:
        if name not in KINDS:
            raise UsageError(f"logger={name}: choose from {', '.join(KINDS)}, or null")
        if name in PACKAGES:
            os.environ.setdefault(*TRACKIO)
            try:
                import_module(name)
            except ImportError as error:
                raise UsageError(f"logger={name}: not installed; {install(name)}") from error
    return names
