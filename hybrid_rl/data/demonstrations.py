"""An expert's decisions in a file, for imitation and for learning models.

The file is a NumPy .npz without pickles; N decisions in the order in which they were made,
episode after episode:

    obs [N, o]   action [N, m] in [-1, 1]   reward [N]   next_obs [N, o], also at an end
    terminated [N]   truncated [N]   episode [N]: 0, 0, ..., 1, 1, ...
    task: its name   sizes: (o, m)   dt [s] between decisions

An episode whose last decision has neither flag counts as truncated.

The files in `demonstrations/` of this repository come with the installed package: a relative path
that does not exist in the working directory is searched there.
"""

import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.protocols import Env
from hybrid_rl.types import Transition

PACKAGE = Path(__file__).parents[1]
PARENTS = (PACKAGE, PACKAGE.parent)  # of `demonstrations/` in a wheel and in a checkout
COLUMNS = Transition._fields
FIELDS = (*COLUMNS, "episode", "task", "sizes", "dt")
UNREADABLE = (OSError, ValueError, EOFError, TypeError, zipfile.BadZipFile, zlib.error)


def save(
    file: Path | str, task: str, dt: float, decisions: Transition, episode: np.ndarray
) -> None:
    """Write `decisions` [N] of `task`, `dt` [s] apart; `episode` [N] numbers their episodes."""
    columns = {name: np.asarray(value, np.float32) for name, value in decisions._asdict().items()}
    sizes = np.array([columns["obs"].shape[1], columns["action"].shape[1]])
    header: dict[str, Any] = {"task": np.array(task), "sizes": sizes, "dt": np.array(dt)}
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    with Path(file).open("wb") as out:
        np.savez_compressed(out, **columns, episode=np.asarray(episode, np.int32), **header)


def find(file: Path | str) -> Path:
    """The path of `file`, or if it does not exist of the packaged file of that name."""
    paths = [Path(file)]
    if paths[0].parts[:1] == ("demonstrations",):
        paths += [folder / file for folder in PARENTS]
    return next((path for path in paths if path.is_file()), paths[0])


def load(file: Path | str) -> dict[str, np.ndarray]:
    """The arrays of `file` by name; those of decisions in float32.

    Raises:
        ValueError: for a file that is missing, damaged or inconsistent.
    """
    prefix = f"demonstrations={file}:"
    path = find(file)
    if not path.is_file():
        raise ValueError(f"{prefix} no such file; `python -m hybrid_rl.demonstrate` records one")
    try:
        with path.open("rb") as data, np.load(data, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except UNREADABLE as error:
        raise ValueError(f"{prefix} is damaged, cut short, or no .npz file") from error
    if missing := [name for name in FIELDS if name not in arrays]:
        raise ValueError(f"{prefix} lacks {', '.join(missing)}")
    for name in (*COLUMNS, "episode", "sizes", "dt"):
        if arrays[name].dtype.kind not in "biuf":
            raise ValueError(f"{prefix} {name} must hold numbers")
    _check_sizes(prefix, arrays)
    for name in COLUMNS:
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
    if arrays["sizes"].shape != (2,) or arrays["dt"].ndim or arrays["task"].ndim:
        raise ValueError(f"{prefix} sizes must be two numbers, dt a number, task a name")
    count, (o, m) = len(np.atleast_1d(arrays["reward"])), arrays["sizes"].tolist()
    if not count:
        raise ValueError(f"{prefix} holds no decision")
    shapes = {"obs": (count, o), "action": (count, m), "next_obs": (count, o)}
    for name in (*COLUMNS, "episode"):
        shape = shapes.get(name, (count,))
        if arrays[name].shape != shape:
            raise ValueError(f"{prefix} {name} is {arrays[name].shape}, not {shape}")
    if (np.diff(arrays["episode"]) < 0).any():
        raise ValueError(f"{prefix} episodes must follow one another")


@dataclass(frozen=True)
class Demonstrations:
    """The first `episodes` of `file`, which must be of `task` in `world`.

    Raises:
        ValueError: for an unusable file, one of another task, or one with fewer episodes.
    """

    file: str
    task: str
    world: Env
    episode: Mapping[str, int] | None = None  # with `action_repeat`; None: 1
    episodes: int | None = None  # None: all

    def __post_init__(self) -> None:
        """Check the fields and the file."""
        if self.episodes is not None and self.episodes < 1:
            raise ValueError(f"num_demonstrations={self.episodes}: must be 1 or more, or null")
        self.load()

    def load(self) -> Transition:
        """The decisions [N], in order."""
        arrays, prefix = load(self.file), f"demonstrations={self.file}:"
        if str(arrays["task"]) != self.task:
            raise ValueError(f"{prefix} is of task {arrays['task']}, not of {self.task}")
        spec = self.world.spec
        for name, has, needs in zip(
            ("obs", "action"), arrays["sizes"].tolist(), (spec.obs, spec.act), strict=True
        ):
            if has != needs:
                raise ValueError(f"{prefix} {name} has {has} numbers, this {self.task} has {needs}")
        dt = spec.dt * (self.episode or {"action_repeat": 1})["action_repeat"]
        if not np.isclose(arrays["dt"], dt):
            raise ValueError(
                f"{prefix} decides every {arrays['dt']:g} s, this {self.task} {dt:g} s"
            )
        _, episode = np.unique(arrays["episode"], return_inverse=True)
        count = episode[-1] + 1 if self.episodes is None else self.episodes
        if count > episode[-1] + 1:
            raise ValueError(f"num_demonstrations={count}: {self.file} has {episode[-1] + 1}")
        columns: Any = (arrays[name][episode < count] for name in COLUMNS)
        return Transition(*columns)
