"""Scalars for TensorBoard, written without a thread, so that what is flushed survives a kill.

tensorboardX's own SummaryWriter passes events to a thread, and its flush does not wait for it.
"""

import time
from pathlib import Path

from tensorboardX.event_file_writer import EventsWriter
from tensorboardX.proto.event_pb2 import (  # made at import, so pyright cannot read it
    Event,  # pyright: ignore[reportAttributeAccessIssue]
    SessionLog,  # pyright: ignore[reportAttributeAccessIssue]
)
from tensorboardX.proto.summary_pb2 import (
    Summary,  # pyright: ignore[reportAttributeAccessIssue]
)


class Board:
    """One event file in `folder`.

    purge_step: TensorBoard ignores entries of older files from this step on.
    """

    def __init__(self, folder: Path, purge_step: int | None = None) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        unique = f".{time.time_ns()}"  # files of the same second stay apart, in order
        self._file = EventsWriter(str(folder / "events"), unique)
        if purge_step is not None:
            start = SessionLog(status=SessionLog.START)
            self._file.write_event(Event(step=purge_step, session_log=start, wall_time=time.time()))

    def write(self, step: int, scalars: dict[str, float]) -> None:
        """Append name -> value at `step`."""
        values = [Summary.Value(tag=tag, simple_value=value) for tag, value in scalars.items()]
        event = Event(step=step, summary=Summary(value=values), wall_time=time.time())
        self._file.write_event(event)

    def flush(self) -> None:
        """Force all events to the disk."""
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()
