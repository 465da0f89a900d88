"""Copies of a run's rows for other tools, beside metrics.jsonl.

A logger is made of what has begun, before the first row; it is called with each row, its `flush`
before each checkpoint, and its `close` at the end. TensorBoard's is in logs/tensorboard.

W&B's own variables apply: WANDB_PROJECT, WANDB_ENTITY and, without a network, WANDB_MODE=offline.
A resumed run continues the runs of W&B, which drop steps that they have already.
"""

import uuid
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from hybrid_rl.errors import UsageError, install
from hybrid_rl.files.atomic import open_own, own_folder
from hybrid_rl.run.logs.records import COORDINATES, Row
from hybrid_rl.settings.values import one_of


class Begun(NamedTuple):
    """A run whose rows are to come."""

    folder: Path
    seeds: Sequence[int]
    config: dict[str, Any]
    step: int | None = None  # from which it is resumed


def scalars(row: Row) -> dict[str, float]:
    """The finite numbers of a row."""
    return {
        name: value
        for name, value in row.items()
        if name not in COORDINATES and value is not None and not isinstance(value, str)
    }


class WandB:
    """Runs of Weights & Biases, one a seed, started by its first row.

    The run folder holds what they write, and an id for each of them.
    """

    def __init__(self, run: Begun) -> None:
        self._run = run
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

    def flush(self) -> None:
        """W&B sends rows by itself."""

    def close(self) -> None:
        """End the runs."""
        for run in self._runs.values():
            run.finish()


def to_wandb(name: str | None) -> bool:
    """True if the key `logger` of a configuration names W&B, which is installed; null: none."""
    if one_of("logger", name, (None, "wandb")) is None:
        return False
    try:
        import_module("wandb")
    except ImportError as error:
        raise UsageError(f"logger=wandb: not installed; {install('wandb')}") from error
    return True
