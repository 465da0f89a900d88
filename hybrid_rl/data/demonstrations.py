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
from typing import Any

import numpy as np
from jax import ShapeDtypeStruct

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
    prefix, names = f"demonstrations={file}:", (*COLUMNS, "episode")
    arrays = archive.read(prefix, file, names, RECORD)
    (o, m), count = arrays["sizes"].tolist(), len(np.atleast_1d(arrays["obs"]))
    sizes = {"obs": (count, o), "action": (count, m), "next_obs": (count, o)}
    like = {name: ShapeDtypeStruct(sizes.get(name, (count,)), np.float32) for name in COLUMNS}
    like["episode"] = ShapeDtypeStruct((count,), arrays["episode"].dtype)
    arrays |= archive.fitting(prefix, {name: arrays[name] for name in names}, like)
    last = np.append(np.diff(arrays["episode"]) != 0, np.ones(min(count, 1), bool))
    ends = arrays["terminated"] + arrays["truncated"] > 0
    wrong = {
        "there is no decision": not count,
        "action must lie in [-1, 1]": (np.abs(arrays["action"]) > 1).any(1),
        "episodes must follow one another": np.diff(arrays["episode"]) < 0,
        "an episode continues after its end": ends & ~last,
    }
    for words, rows in wrong.items():
        if np.any(rows):
            raise ValueError(f"{prefix} {words}, in row {np.argmax(rows)}")
    arrays["truncated"][last & ~ends] = 1
    return arrays


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
