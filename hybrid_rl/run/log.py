"""The records of a run: metrics.jsonl, tensorboard/, summary.json, and loggers.

A checkpoint stores the length of metrics.jsonl at that time; a resumed run truncates the file to
that length, so that it has every row exactly once.
"""

import json
import math
import os
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from hybrid_rl.errors import CheckpointError
from hybrid_rl.run.integrity import write_text
from hybrid_rl.run.loggers import Logger, scalars
from hybrid_rl.run.reading import appended, lines
from hybrid_rl.run.records import row_of

if TYPE_CHECKING:
    from hybrid_rl.run.board import Board


class RunLog:
    """Writes rows of numbers to a run folder, which exists.

    tensorboard/ has one event file for a single learner, and one subfolder per seed for several,
    so that a chart overlays the seeds. loggers: get the rows, too.
    """

    def __init__(self, run_dir: Path, seeds: Sequence[int], loggers: Sequence[Logger] = ()) -> None:
        self.run_dir = run_dir
        self.loggers = loggers
        self.seeds = tuple(seeds)
        self._rows = appended(run_dir / "metrics.jsonl")
        self._boards: dict[int, Board] = {}  # by seed
        self._purge_step: int | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        problem: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for each in (*self._boards.values(), *self.loggers):
            each.close()
        self._boards.clear()
        self._rows.close()

    def write(self, rows: list[dict[str, Any]]) -> None:
        """Append rows {"step", "seed", "wall_s", name: number or word, ...}.

        Raises:
            CheckpointError: before the first row, as `flush`.
        """
        for row in rows:
            plain = {n: v if isinstance(v, str) else number(v) for n, v in row.items()}
            plain["wall_s"] = round(float(row["wall_s"]), 3)
            self._rows.write(json.dumps(plain, allow_nan=False).encode("ascii") + b"\n")
            self._board(int(row["seed"])).write(int(row["step"]), scalars(plain))
            for logger in self.loggers:
                logger.write(plain)
        self._rows.flush()

    def flush(self) -> int:
        """Force all rows to the disk; returns the size of metrics.jsonl [bytes], for `rewind`.

        Raises:
            CheckpointError: if the folder is no longer where it was.
        """
        self._check_folder()
        for each in (*self._boards.values(), *self.loggers):
            each.flush()
        self._rows.flush()
        os.fsync(self._rows.fileno())
        return self._rows.tell()

    def _check_folder(self) -> None:
        """Raise CheckpointError if metrics.jsonl is not the file that is open here."""
        path, ours = self.run_dir / "metrics.jsonl", os.fstat(self._rows.fileno())
        if not path.exists() or not os.path.samestat(path.stat(), ours):
            raise CheckpointError(
                f"{path}: moved, deleted or replaced while the run wrote it; the run has stopped, "
                "resume it where its folder is now"
            )

    def rewind(self, offset: int, step: int) -> list[str]:
        """Delete what was written after the checkpoint at `step`; call it before `write`.

        offset: [bytes] that `flush` returned then. Returns one line for each difference from the
        state at the checkpoint.
        """
        path = self.run_dir / "metrics.jsonl"
        whole = [line for line in lines(path, offset) if line.endswith(b"\n")]
        rows = list(map(row_of, whole))  # before anything is cut
        size = sum(map(len, whole))
        self._rows.truncate(size)
        self._rows.seek(0, os.SEEK_END)
        self._purge_step = step + 1
        for logger in self.loggers:
            logger.rewind(row for row in rows if row is not None)
        if size == offset and None not in rows:
            return []
        return [f"{path} has changed: rows before step {step} are missing or edited"]

    def summary(self, fields: dict[str, Any]) -> Path:
        """Replace summary.json; NaN and infinity become null."""
        path = self.run_dir / "summary.json"
        write_text(path, json.dumps(_finite(fields), indent=2, allow_nan=False) + "\n")
        return path

    def _board(self, seed: int) -> "Board":
        """The TensorBoard file of a seed, opened at its first row."""
        if seed not in self._boards:
            from hybrid_rl.run.board import Board  # 0.2 s

            self._check_folder()  # a folder would be made again where it was
            several = (f"seed_{seed}",) if len(self.seeds) > 1 else ()
            folder = self.run_dir.joinpath("tensorboard", *several)
            self._boards[seed] = Board(folder, self._purge_step)
        return self._boards[seed]


def number(value: Any) -> int | float | None:
    """A plain number: integers as they are, floats in the digits of float32, None if not finite."""
    scalar = np.asarray(value)
    if scalar.dtype.kind in "iub":
        return int(scalar)
    single = np.float32(scalar)
    return float(str(single)) if np.isfinite(single) else None


def _finite(value: Any) -> Any:
    """`value` with None for NaN and infinity."""
    match value:
        case dict():
            return {name: _finite(entry) for name, entry in value.items()}
        case list() | tuple():
            return [_finite(entry) for entry in value]
        case float() | np.floating():
            return float(value) if math.isfinite(value) else None
        case np.integer():
            return int(value)
        case _:
            return value
