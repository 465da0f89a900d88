"""Rows, one for each decision, and their file: one process appends them, another reads them.

A row is written whole by one call, and has its number and a checksum. What is in the file outlives
both processes, so nothing has to be sent again or acknowledged: a learner goes on reading behind
the last row that its checkpoint has learned from.
"""

import os
import zlib
from pathlib import Path

import numpy as np

from hybrid_rl.envs.adapters.robot import PENDING
from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import own_file
from hybrid_rl.types import Spec


def row_type(spec: Spec) -> np.dtype:
    """The fields of a row, of which `outside.learner.transition` makes a transition.

    A robot's process writes all of them (`outside.actor`), a loop of the user's only one time.
    """
    return np.dtype(
        [
            ("number", "<i8"),  # from 0
            ("stretch", "<i8"),  # decisions of one stretch follow each other without a gap
            ("episode", "<i8"),
            ("time", "<f8"),  # [s] of the decision, since the epoch
            ("obs", "<f4", spec.obs),
            ("action", "<f4", spec.act),  # that was executed, from -1 to 1
            ("sent", "<f4", (PENDING + 1, spec.act)),  # it and those before, the newest first
            ("times", "<f4", PENDING + 1),  # [s] when they were sent, since the observation
            ("interval", "<f4"),  # [s] until the next observation
            ("reward", "<f4"),
            ("terminated", "<i4"),
            ("truncated", "<i4"),
            ("next_obs", "<f4", spec.obs),
            ("late", "<f4"),  # [s] from the beginning of the period to the action
            ("age", "<f4"),  # [s] of the observation when the action was sent
            ("version", "<i8"),  # of the parameters, in decisions that they had learned from
            ("missed", "<i8"),  # deadlines since the robot's process began
            ("unsafe", "<i8"),  # safe actions in place of others since then
            ("check", "<u4"),
        ]
    )


class RowLog:
    """The rows of one robot in `file`."""

    def __init__(self, file: Path, spec: Spec) -> None:
        """Open or create the file; UsageError for rows of another kind."""
        self.kind = row_type(spec)
        self._file = own_file(file, os.O_RDWR | os.O_CREAT | os.O_APPEND)
        if self.count() and self.read(0) is None:
            raise UsageError(f"{file}: has rows of another version or robot; begin another run")

    def count(self) -> int:
        """Rows in the file."""
        return os.fstat(self._file).st_size // self.kind.itemsize

    def recover(self) -> np.ndarray | None:
        """Cut off a torn row at the end; returns the last sound one, or None."""
        count = self.count()
        while count and self.read(count - 1) is None:
            count -= 1
        os.ftruncate(self._file, count * self.kind.itemsize)
        return self.read(count - 1) if count else None

    def append(self, row: np.ndarray) -> None:
        """Write a row [] of `kind`; `recover` cuts off what a full disk left of it."""
        data = sealed(row)
        while data:
            data = data[os.write(self._file, data) :]

    def read(self, number: int) -> np.ndarray | None:
        """Row `number` []; None if it is not there, or not whole."""
        if number < 0:
            return None
        data = os.pread(self._file, self.kind.itemsize, number * self.kind.itemsize)
        row = opened(data, self.kind)
        return row if row is not None and row["number"] == number else None


def sealed(row: np.ndarray) -> bytes:
    """The bytes of a row [], which gets the checksum of the others as its last field."""
    row["check"] = zlib.crc32(row.tobytes()[:-4])
    return row.tobytes()


def opened(data: bytes, kind: np.dtype) -> np.ndarray | None:
    """The row [] in these bytes; None if they are not whole."""
    if len(data) != kind.itemsize or int.from_bytes(data[-4:], "little") != zlib.crc32(data[:-4]):
        return None
    return np.frombuffer(data, kind)[0]
