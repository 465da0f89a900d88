"""Where a run's rows go: metrics.jsonl, and copies of it for other tools beside tensorboard/.

    csv      metrics.csv, a line step,seed,wall_s,metric,value for each number
    wandb    Weights & Biases, a run of theirs for each seed, in a group for each run folder
    trackio  Trackio, the same in a database on this disk, at each checkpoint

W&B's own variables apply: WANDB_PROJECT, WANDB_ENTITY and, without a network, WANDB_MODE=offline.
A resumed run continues the runs of W&B, which drop steps that they have already. Trackio's
databases are in runs/trackio, or in TRACKIO_DIR.
"""

import csv
import json
import os
import uuid
from collections.abc import Callable, Iterable, Sequence
from contextlib import redirect_stdout
from importlib import import_module
from io import StringIO
from pathlib import Path
from typing import Any

from hybrid_rl.errors import FAULTS, CheckpointError, UsageError, install
from hybrid_rl.files.atomic import open_own, own_folder
from hybrid_rl.run.files.reading import lines
from hybrid_rl.run.logs.records import COORDINATES, Row, row_of

HEADER = (*COORDINATES, "metric", "value")
PACKAGES = ("wandb", "trackio")  # extras of the same name
TRACKIO = ("TRACKIO_DIR", "runs/trackio")  # read by Trackio when it is imported


class Logger:
    """Where rows go; subclasses leave out methods for which they have nothing to do."""

    def rewind(self, rows: Iterable[Row], step: int) -> None:
        """Keep these rows only: the run continues after them, at `step`."""

    def write(self, row: Row) -> None:
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


class Lines(Logger):
    """metrics.jsonl in `folder`, an object of JSON for each row."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / "metrics.jsonl"
        self._file = open_own(self.path)

    @property
    def size(self) -> int:
        """[bytes] of all rows so far."""
        return self._file.tell()

    def cut(self, size: int) -> list[Row | None]:
        """The rows among the first `size` bytes, None for a damaged one; all others are deleted."""
        whole = [line for line in lines(self.path, size) if line.endswith(b"\n")]
        rows = list(map(row_of, whole))  # before anything is cut
        self._file.truncate(sum(map(len, whole)))
        self._file.seek(0, os.SEEK_END)
        return rows

    def write(self, row: Row) -> None:
        """Add a line."""
        self._file.write(json.dumps(row, allow_nan=False).encode("ascii") + b"\n")
        self._file.flush()

    def check(self) -> None:
        """Raise CheckpointError if the file is no longer the one that is open here."""
        ours = os.fstat(self._file.fileno())
        if not self.path.exists() or not os.path.samestat(self.path.stat(), ours):
            raise CheckpointError(
                f"{self.path}: moved, deleted or replaced while the run wrote it; the run has "
                "stopped, resume it where its folder is now"
            )

    def flush(self) -> None:
        """Force all lines to the disk."""
        self.check()
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close the file."""
        self._file.close()


class CSV(Logger):
    """metrics.csv in `folder`."""

    def __init__(self, folder: Path, *_: object) -> None:
        self._path = folder / "metrics.csv"
        new = not self._path.exists()
        self._file = open_own(self._path, "a", buffering=1, encoding="ascii", newline="")
        self._lines = csv.writer(self._file)
        if new:
            self._lines.writerow(HEADER)

    def rewind(self, rows: Iterable[Row], step: int) -> None:
        """Write the file again, with these rows."""
        self._file.truncate(0)
        self._lines.writerow(HEADER)
        for row in rows:
            self.write(row)

    def write(self, row: Row) -> None:
        """Add a line for each number."""
        at = [row[name] for name in COORDINATES]
        self._lines.writerows([*at, name, value] for name, value in scalars(row).items())

    def close(self) -> None:
        """Close the file."""
        self._file.close()


class WandB(Logger):
    """Runs of Weights & Biases for `seeds`, with the settings `config`; started by their first row.

    folder: of the run; it holds what they write, and an id for each of them.
    """

    def __init__(self, folder: Path, seeds: Sequence[int], config: dict[str, Any]) -> None:
        self._folder, self._config, self._several = folder, config, len(seeds) > 1
        self._runs: dict[int, Any] = {}  # by seed

    def write(self, row: Row) -> None:
        """Log the numbers of a row at its step."""
        if values := scalars(row):
            run = self._run(int(row["seed"]))
            run.log(values | {"wall_s": row["wall_s"]}, step=int(row["step"]))

    def _run(self, seed: int) -> Any:
        if seed not in self._runs:
            wandb: Any = import_module("wandb")
            name = self._folder.name + (f" seed {seed}" if self._several else "")
            self._runs[seed] = wandb.init(
                id=self._id(seed),
                resume="allow",
                name=name,
                group=str(self._folder),
                job_type=f"{self._config['task']} {self._config['algo']}",
                dir=str(self._folder),
                config=self._config | {"seed": seed},
                reinit="create_new",
                settings=wandb.Settings(console="off"),
            )
        return self._runs[seed]

    def _id(self, seed: int) -> str:
        """The id of the run of a seed, the same when it is resumed."""
        file = self._folder / "wandb" / f"seed_{seed}.id"
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
        self._runs.clear()


class Trackio(Logger):
    """Runs of Trackio for `seeds`, with the settings `config`, in a project for each task.

    Only one of them can be open, so rows are kept until `flush`, before a checkpoint, or the end.
    """

    def __init__(self, folder: Path, seeds: Sequence[int], config: dict[str, Any]) -> None:
        self._folder, self._config = folder, config
        self._rows: dict[int, list[Row]] = {seed: [] for seed in seeds}
        self._begun: set[int] = set()  # seeds that have a run

    def rewind(self, rows: Iterable[Row], step: int) -> None:
        """Continue the runs, which have these rows."""
        self._begun = set(self._rows)

    def write(self, row: Row) -> None:
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
                run = self._run(trackio, seed)
                for row in rows:
                    run.log(scalars(row) | {"wall_s": row["wall_s"]}, step=int(row["step"]))
                trackio.finish()
            rows.clear()

    def _run(self, trackio: Any, seed: int) -> Any:
        resume = "allow" if seed in self._begun else "never"
        self._begun.add(seed)
        return trackio.init(
            project=str(self._config["task"]),
            name=f"{self._folder} seed {seed}",
            group=str(self._folder),
            config=self._config | {"seed": seed},
            resume=resume,
            embed=False,
            auto_log_gpu=False,
            auto_log_cpu=False,
        )

    def close(self) -> None:
        """Hand over the rest."""
        self.flush()


class Callback(Logger):
    """A function of the user's, which is called with every new row, a dictionary.

    Where it returns False, `ask` is called with 0, and it gets the rows up to the end. Where it
    raises, also; `problem` is what it raised, and it is not called again.
    """

    def __init__(self, function: Callable[[Row], Any]) -> None:
        self._function, self._asked = function, False
        self.ask: Callable[[int], None] = lambda number: None
        self.problem: BaseException | None = None

    def write(self, row: Row) -> None:
        """Call the function."""
        if self.problem is not None:
            return
        try:
            ends = self._function(dict(row)) is False
        except FAULTS as problem:
            self.problem, ends = problem, True
        if ends and not self._asked:
            self._asked = True
            self.ask(0)


class Named(Logger):
    """Hands rows on to `logger`, with `more` in them."""

    def __init__(self, logger: Logger, more: Row) -> None:
        self._logger, self._more = logger, more

    def write(self, row: Row) -> None:
        """Hand on a row."""
        self._logger.write(row | self._more)


KINDS = {"csv": CSV, "wandb": WandB, "trackio": Trackio}


def check(given: Any) -> tuple[str, ...]:
    """The loggers that the key `logger` of a configuration names; null: none."""
    names = () if given is None else (given,) if isinstance(given, str) else tuple(given)
    if unknown := [name for name in names if name not in KINDS]:
        line = f"choose from {', '.join(KINDS)}, or null"
        always = "every run writes metrics.jsonl and tensorboard/"
        raise UsageError(f"logger={unknown[0]}: {line}; {always}")
    for name in (each for each in names if each in PACKAGES):
        os.environ.setdefault(*TRACKIO)
        try:
            import_module(name)
        except ImportError as error:
            raise UsageError(f"logger={name}: not installed; {install(name)}") from error
    return names
