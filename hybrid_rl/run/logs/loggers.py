"""Copies of a run's rows for other tools, beside metrics.jsonl: TensorBoard's and perhaps W&B's.

A logger is called with each row, its `flush` before each checkpoint, and its `close` at the end.

W&B's own variables apply: WANDB_PROJECT, WANDB_ENTITY and, without a network, WANDB_MODE=offline.
A resumed run continues the runs of W&B, which drop steps that they have already.
"""

import time
import uuid
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from tensorboardX.event_file_writer import EventsWriter
from tensorboardX.proto.event_pb2 import (  # made at import, so pyright cannot read it
    Event,  # pyright: ignore[reportAttributeAccessIssue]
    SessionLog,  # pyright: ignore[reportAttributeAccessIssue]
)
from tensorboardX.proto.summary_pb2 import Summary  # pyright: ignore[reportAttributeAccessIssue]

from hybrid_rl.files.atomic import open_own, own_folder
from hybrid_rl.run.logs.records import COORDINATES, Row


def scalars(row: Row) -> dict[str, float]:
    """The finite numbers of a row."""
    named = {name: value for name, value in row.items() if name not in COORDINATES}
    return {name: v for name, v in named.items() if v is not None and not isinstance(v, str)}


class TensorBoard:
    """tensorboard/ in the run folder: a file, or a subfolder for each of several seeds.

    So a chart overlays the seeds. What older files have after the step of a resumed run is void.
    tensorboardX's own SummaryWriter passes events to a thread, and its flush does not wait for it:
    here what is flushed survives a kill.
    """

    def __init__(self, run_dir: Path, seeds: Sequence[int], resumed: int | None = None) -> None:
        """resumed: the step from which the run is."""
        folder = own_folder(run_dir / "tensorboard")
        self._files: dict[int, EventsWriter] = {}
        for seed in seeds:
            home = own_folder(folder / f"seed_{seed}") if len(seeds) > 1 else folder
            unique = f".{time.time_ns()}"  # files of the same second stay apart, in order
            self._files[seed] = EventsWriter(str(home / "events"), unique)
            if resumed is not None:
                start = SessionLog(status=SessionLog.START)
                event = Event(step=resumed + 1, session_log=start, wall_time=time.time())
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


class WandB:
    """Runs of Weights & Biases, one a seed, started by its first row.

    The run folder holds what they write, and an id for each of them.
    """

    def __init__(self, run_dir: Path, seeds: Sequence[int], config: dict[str, Any]) -> None:
        self._folder, self._seeds, self._config = run_dir, seeds, config
        self._runs: dict[int, Any] = {}  # by seed

    def __call__(self, row: Row) -> None:
        """Log the numbers of a row at its step."""
        if values := scalars(row):
            seed = int(row["seed"])
            if seed not in self._runs:
                self._runs[seed] = self._started(seed)
            self._runs[seed].log(values | {"wall_s": row["wall_s"]}, step=int(row["step"]))

    def _started(self, seed: int) -> Any:
        wandb: Any = import_module("wandb")
        folder, config = self._folder, self._config
        return wandb.init(
            id=self.id_of(seed),
            resume="allow",
            name=folder.name + (f" seed {seed}" if len(self._seeds) > 1 else ""),
            group=str(folder),
            job_type=f"{config['task']} {config['algo']}",
            dir=str(folder),
            config=config | {"seed": seed},
            reinit="create_new",
            settings=wandb.Settings(console="off"),
        )

    def id_of(self, seed: int) -> str:
        """The id of the run of a seed, the same when it is resumed."""
        file = self._folder / "wandb" / f"seed_{seed}.id"
        if not file.exists():
            own_folder(file.parent)
            with open_own(file, "w", encoding="ascii") as out:
                out.write(uuid.uuid4().hex[:12])
        with open_own(file, "r", encoding="ascii") as given:
            return given.read(100)

    def flush(self) -> None:
        """W&B sends rows by itself."""

    def close(self) -> None:
        """End the runs."""
        for run in self._runs.values():
            run.finish()
