"""An expert's decisions in a file, for imitation and for learning models.

The file is a NumPy .npz without pickles; N decisions in the order in which they were made,
episode after episode:

    obs [N, o]   action [N, m] in [-1, 1]   reward [N]   next_obs [N, o], also at an end
    terminated [N]   truncated [N]   episode [N]: 0, 0, ..., 1, 1, ...

with the header of data/archive. An episode whose last decision has neither flag counts as
truncated.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from statistics import mode
from typing import Any

import numpy as np

from hybrid_rl.data import archive
from hybrid_rl.protocols import Env
from hybrid_rl.types import Spec, Transition

COLUMNS = Transition._fields
RECORD = "`python -m hybrid_rl.demonstrate` records one"


def save(
    file: Path | str, task: str, dt: float, decisions: Transition, episode: np.ndarray
) -> None:
    """Write `decisions` [N] of `task`, `dt` [s] apart; `episode` [N] numbers their episodes."""
    columns = {name: np.asarray(value, np.float32) for name, value in decisions._asdict().items()}
    spec = Spec(columns["obs"].shape[1], columns["action"].shape[1], dt)
    archive.write(file, task, spec, {**columns, "episode": np.asarray(episode, np.int32)})


def load(file: Path | str) -> dict[str, np.ndarray]:
    """The arrays of `file` by name; those of decisions in float32."""
    prefix = f"demonstrations={file}:"
    arrays = archive.read(prefix, file, (*COLUMNS, "episode"), RECORD)
    _check_sizes(prefix, arrays)
    for name in COLUMNS:
        with np.errstate(over="ignore"):  # what becomes infinite is refused
            arrays[name] = arrays[name].astype(np.float32)
        finite = np.isfinite(arrays[name].reshape(len(arrays[name]), -1)).all(1)
        if not finite.all():
            raise ValueError(f"{prefix} {name} is not finite in row {finite.argmin()}")
    if np.abs(arrays["action"]).max() > 1:
        raise ValueError(f"{prefix} action must lie in [-1, 1]")
    last = np.append(np.diff(arrays["episode"]) != 0, True)
    ends = arrays["terminated"] + arrays["truncated"] > 0
    if (ends & ~last).any():
        raise ValueError(
            f"{prefix} an episode continues after its end, in row {(ends & ~last).argmax()}"
        )
    arrays["truncated"][last & ~ends] = 1
    return arrays


def _check_sizes(prefix: str, arrays: dict[str, np.ndarray]) -> None:
    """Raise ValueError for inconsistent sizes, or episodes out of order."""
    (o, m), names = arrays["sizes"].tolist(), (*COLUMNS, "episode")
    count = mode(len(np.atleast_1d(arrays[name])) for name in names)  # the usual one
    if not count:
        raise ValueError(f"{prefix} holds no decision")
    shapes = {"obs": (count, o), "action": (count, m), "next_obs": (count, o)}
    for name in names:
        shape = shapes.get(name, (count,))
        if arrays[name].shape != shape:
            raise ValueError(f"{prefix} {name} is {arrays[name].shape}, not {shape}")
    if (np.diff(arrays["episode"]) < 0).any():
        raise ValueError(f"{prefix} episodes must follow one another")


@dataclass(frozen=True)
class Demonstrations:
    """The first `episodes` of `file`, which must be of `task` in `world`."""

    file: str
    task: str
    world: Env
    episode: Mapping[str, int] | None = None  # with `action_repeat`; None: 1
    episodes: int | None = None  # None: all

    def __post_init__(self) -> None:
        if self.episodes is not None and self.episodes < 1:
            raise ValueError(f"num_demonstrations={self.episodes}: must be 1 or more, or null")
        self.load()

    def load(self) -> Transition:
        """The decisions [N], in order."""
        arrays = load(self.file)
        archive.check_task(
            f"demonstrations={self.file}:", arrays, self.task, self.world, self.episode
        )
        _, episode = np.unique(arrays["episode"], return_inverse=True)
        count = episode[-1] + 1 if self.episodes is None else self.episodes
        if count > episode[-1] + 1:
            raise ValueError(f"num_demonstrations={count}: {self.file} has {episode[-1] + 1}")
        columns: Any = (arrays[name][episode < count] for name in COLUMNS)
        return Transition(*columns)
