"""Scalars for TensorBoard, written without a thread, so that what is flushed survives a kill.

tensorboardX's own SummaryWriter passes events to a thread, and its flush does not wait for it.
"""

import time

from tensorboardX.event_file_writer import EventsWriter
from tensorboardX.proto.event_pb2 import (  # made at import, so pyright cannot read it
    Event,  # pyright: ignore[reportAttributeAccessIssue]
    SessionLog,  # pyright: ignore[reportAttributeAccessIssue]
)
from tensorboardX.proto.summary_pb2 import Summary  # pyright: ignore[reportAttributeAccessIssue]

from hybrid_rl.files.atomic import own_folder
from hybrid_rl.run.logs.loggers import Begun, scalars
from hybrid_rl.run.logs.records import Row


class TensorBoard:
    """tensorboard/ in the run folder: a file, or a subfolder for each of several seeds.

    So a chart overlays the seeds. What older files have after the step of a resumed run is void.
    """

    def __init__(self, run: Begun) -> None:
        folder = own_folder(run.folder / "tensorboard")
        self._files: dict[int, EventsWriter] = {}
        for seed in run.seeds:
            home = own_folder(folder / f"seed_{seed}") if len(run.seeds) > 1 else folder
            unique = f".{time.time_ns()}"  # files of the same second stay apart, in order
            self._files[seed] = EventsWriter(str(home / "events"), unique)
            if run.step is not None:
                start = SessionLog(status=SessionLog.START)
                event = Event(step=run.step + 1, session_log=start, wall_time=time.time())
                self._files[seed].write_event(event)

    def __call__(self, row: Row) -> None:
        """Append the numbers of a row at its step."""
        values = [Summary.Value(tag=tag, simple_value=v) for tag, v in scalars(row).items()]
        event = Event(step=row["step"], summary=Summary(value=values), wall_time=time.time())
        self._files[row["seed"]].write_event(event)

    def flush(self) -> None:
        """Force all events to the disk."""
        for file in self._files.values():
            file.flush()

    def close(self) -> None:
        """Close the files."""
        for file in self._files.values():
            file.close()
