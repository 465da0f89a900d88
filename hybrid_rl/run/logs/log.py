"""The records of a run: metrics.jsonl, summary.json, TensorBoard's and perhaps W&B's.

A checkpoint stores the length of metrics.jsonl at that time; a resumed run truncates the file to
that length, so that it has every row exactly once.
"""

import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Self

import numpy as np

from hybrid_rl.errors import CheckpointError
from hybrid_rl.files.atomic import open_own, write_text
from hybrid_rl.run.logs.records import Row, json_value


class RunLog:
    """Writes rows of numbers to a run folder, which exists; nothing before the first row.

    config: settings of the run, for loggers. on_row: a function that gets the rows, too.
    """

    def __init__(
        self,
        run_dir: Path,
        seeds: Sequence[int],
        config: dict[str, Any] | None = None,
        on_row: Callable[[Row], Any] = lambda row: None,
    ) -> None:
        self.run_dir, self.path = run_dir, run_dir / "metrics.jsonl"
        self._seeds, self._config, self._on_row = seeds, config or {}, on_row
        self._resumed: int | None = None  # the step from which it is
        self._file: Any = None
        self._loggers: list[Any] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        for each in (*reversed(self._loggers), *filter(None, [self._file])):
            each.close()

    def write(self, rows: Sequence[Row]) -> None:
        """Append rows {"step", "seed", "wall_s", name: number or word, ...}."""
        for row in rows:
            self._open()
            plain = {name: v if isinstance(v, str) else number(v) for name, v in row.items()}
            plain["wall_s"] = round(float(row["wall_s"]), 3)
            self._file.write(json.dumps(plain, allow_nan=False).encode("ascii") + b"\n")
            self._file.flush()
            for logger in self._loggers:
                logger(plain)
            self._on_row(plain)

    def _open(self) -> None:
        """Open the files that are not open yet."""
        self._file = self._file or open_own(self.path)
        if not self._loggers:
            from hybrid_rl.run.logs import loggers  # TensorBoard takes 0.2 s

            self._check()
            self._loggers.append(loggers.TensorBoard(self.run_dir, self._seeds, self._resumed))
            if self._config.get("logger") == "wandb":
                self._loggers.append(loggers.WandB(self.run_dir, self._seeds, self._config))

    def _check(self) -> None:
        """Raise CheckpointError if metrics.jsonl is no longer the file that is open here."""
        ours = os.fstat(self._file.fileno())
        if not self.path.exists() or not os.path.samestat(self.path.stat(), ours):
            raise CheckpointError(
                f"{self.path}: moved, deleted or replaced while the run wrote it; the run has "
                "stopped, resume it where its folder is now"
            )

    def flush(self) -> int:
        """Force all rows to the disk; returns the size of metrics.jsonl [bytes], for `rewind`."""
        self._open()
        self._check()
        os.fsync(self._file.fileno())
        for logger in self._loggers:
            logger.flush()
        return self._file.tell()

    def rewind(self, offset: int, step: int) -> list[str]:
        """Delete what was written after the checkpoint at `step`; call it before `write`.

        offset: [bytes] that `flush` returned then. Returns one line for each difference from the
        state at the checkpoint.
        """
        self._file = open_own(self.path, "a+b")
        self._file.seek(0)
        whole = self._file.read(offset).rpartition(b"\n")
        self._file.truncate(len(whole[0] + whole[1]))
        self._file.seek(0, os.SEEK_END)
        self._resumed = step
        if self._file.tell() == offset:
            return []
        return [f"{self.path} has changed: rows before step {step} are missing"]

    def summary(self, fields: dict[str, Any]) -> None:
        """Replace summary.json; NaN and infinity become null."""
        text = json.dumps(json_value(fields), indent=2, allow_nan=False)
        write_text(self.run_dir / "summary.json", f"{text}\n")


def number(value: Any) -> int | float | None:
    """A plain number: integers as they are, floats in the digits of float32, None if not finite."""
    scalar = np.asarray(value)
    if scalar.dtype.kind in "iub":
        return int(scalar)
    single = np.float32(scalar)
    return float(str(single)) if np.isfinite(single) else None
