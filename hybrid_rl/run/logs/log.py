"""The records of a run: metrics.jsonl, tensorboard/, summary.json, and loggers.

A checkpoint stores the length of metrics.jsonl at that time; a resumed run truncates the file to
that length, so that it has every row exactly once.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np

from hybrid_rl.run.files.integrity import write_text
from hybrid_rl.run.logs.loggers import Lines, Logger
from hybrid_rl.run.logs.records import json_value


class RunLog:
    """Writes rows of numbers to a run folder, which exists; `loggers` get them, too."""

    def __init__(self, run_dir: Path, seeds: Sequence[int], loggers: Sequence[Logger] = ()) -> None:
        from hybrid_rl.run.logs.tensorboard import TensorBoard  # 0.2 s

        self.run_dir = run_dir
        self._lines = Lines(run_dir)
        board = TensorBoard(run_dir, seeds, self._lines.check)
        self._loggers: tuple[Logger, ...] = (self._lines, board, *loggers)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for each in reversed(self._loggers):
            each.close()

    def write(self, rows: list[dict[str, Any]]) -> None:
        """Append rows {"step", "seed", "wall_s", name: number or word, ...}.

        Raises:
            CheckpointError: before a seed's first row, as `flush`.
        """
        for row in rows:
            plain = {n: v if isinstance(v, str) else number(v) for n, v in row.items()}
            plain["wall_s"] = round(float(row["wall_s"]), 3)
            for logger in self._loggers:
                logger.write(plain)

    def flush(self) -> int:
        """Force all rows to the disk; returns the size of metrics.jsonl [bytes], for `rewind`.

        Raises:
            CheckpointError: if the folder is no longer where it was.
        """
        for logger in self._loggers:
            logger.flush()
        return self._lines.size

    def rewind(self, offset: int, step: int) -> list[str]:
        """Delete what was written after the checkpoint at `step`; call it before `write`.

        offset: [bytes] that `flush` returned then. Returns one line for each difference from the
        state at the checkpoint.
        """
        rows = self._lines.cut(offset)
        sound = [row for row in rows if row is not None]
        for logger in self._loggers:
            logger.rewind(sound, step)
        if self._lines.size == offset and None not in rows:
            return []
        path = self._lines.path
        return [f"{path} has changed: rows before step {step} are missing or edited"]

    def summary(self, fields: dict[str, Any]) -> Path:
        """Replace summary.json; NaN and infinity become null."""
        path = self.run_dir / "summary.json"
        write_text(path, json.dumps(json_value(fields), indent=2, allow_nan=False) + "\n")
        return path


def number(value: Any) -> int | float | None:
    """A plain number: integers as they are, floats in the digits of float32, None if not finite."""
    scalar = np.asarray(value)
    if scalar.dtype.kind in "iub":
        return int(scalar)
    single = np.float32(scalar)
    return float(str(single)) if np.isfinite(single) else None
