"""Scalars for TensorBoard, written without a thread, so that what is flushed survives a kill.

tensorboardX's own SummaryWriter passes events to a thread, and its flush does not wait for it.
"""

import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from tensorboardX.event_file_writer import EventsWriter
from tensorboardX.proto.event_pb2 import (  # made at import, so pyright cannot read it
    Event,  # pyright: ignore[reportAttributeAccessIssue]
    SessionLog,  # pyright: ignore[reportAttributeAccessIssue]
)
from tensorboardX.proto.summary_pb2 import Summary  # pyright: ignore[reportAttributeAccessIssue]

from hybrid_rl.files.atomic import own_folder
from hybrid_rl.run.logs.loggers import Logger, scalars
from hybrid_rl.run.logs.records import Row


class TensorBoard(Logger):
    """tensorboard/ in the run folder: a file, or a subfolder for each of several seeds.

    So a chart overlays the seeds. check: raises if the run folder is gone, which would be made
    again where it was.
    """

    def __init__(self, run_dir: Path, seeds: Sequence[int], check: Callable[[], None]) -> None:
        self._folder, self._check = run_dir / "tensorboard", check
        self._several = len(seeds) > 1
        self._files: dict[int, EventsWriter] = {}  # by seed, each opened at its first row
        self._purged: int | None = None  # TensorBoard ignores older entries from this step on

    def rewind(self, rows: Iterable[Row], step: int) -> None:
        """Mark what older files have after `step` as void."""
        self._purged = step + 1

    def write(self, row: Row) -> None:
        """Append the numbers of a row at its step."""
        values = [Summary.Value(tag=tag, simple_value=v) for tag, v in scalars(row).items()]
        event = Event(step=row["step"], summary=Summary(value=values), wall_time=time.time())
        self._file(row["seed"]).write_event(event)

    def _file(self, seed: int) -> EventsWriter:
        if seed not in self._files:
            self._check()
            folder = own_folder(self._folder)
            folder = own_folder(folder / f"seed_{seed}") if self._several else folder
            unique = f".{time.time_ns()}"  # files of the same second stay apart, in order
            self._files[seed] = EventsWriter(str(folder / "events"), unique)
            if self._purged is not None:
                start = SessionLog(status=SessionLog.START)
                event = Event(step=self._purged, session_log=start, wall_time=time.time())
                self._files[seed].write_event(event)
        return self._files[seed]

    def flush(self) -> None:
        """Force all events to the disk."""
        for file in self._files.values():
            file.flush()

    def close(self) -> None:
        """Close the files."""
        for file in self._files.values():
            file.close()
        self._files.clear()
