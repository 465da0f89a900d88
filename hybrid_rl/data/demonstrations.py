"""What an expert did: a file of decisions, to imitate and to learn models from.

The file is NumPy's .npz, without pickles; N decisions in the order in which they were made,
episode after episode:

    obs [N, o]   action [N, m] in [-1, 1]   reward [N]   next_obs [N, o] the true one
    terminated [N]   truncated [N]   episode [N]: 0, 0, ..., 1, 1, ...
    task: its name   sizes: (o, m)   dt [s] of a decision

An episode that ends with neither flag counts as truncated.

The files in `demonstrations/` of this repository come with the installed package: a relative path
that the working directory does not have is searched there.
"""

import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.protocols import Env
from hybrid_rl.types import Transition

PACKAGE = Path(__file__).parents[1]
PACKAGED = (PACKAGE, PACKAGE.parent)  # `demonstrations/` lies in one: of a wheel, of a checkout
ROWS = Transition._fields
WHOLE = (*ROWS, "episode", "task", "sizes", "dt")
UNREADABLE = (OSError, ValueError, EOFError, TypeError, zipfile.BadZipFile, zlib.error)


def save(
    file: Path | str, task: str, dt: float, decisions: Transition, episode: np.ndarray
) -> None:
    """Write decisions [N] of `task`, at `dt` [s], of which each belongs to episode [N]."""
    rows = {name: np.asarray(value, np.float32) for name, value in decisions._asdict().items()}
    sizes = np.array([rows["obs"].shape[1], rows["action"].shape[1]])
    told: dict[str, Any] = {"task": np.array(task), "sizes": sizes, "dt": np.array(dt)}
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    with Path(file).open("wb") as out:
        np.savez_compressed(out, **rows, episode=np.asarray(episode, np.int32), **told)


def find(file: Path | str) -> Path:
    """`file` where it exists, else the file of that name that comes with the package."""
    paths = [Path(file)]
    if paths[0].parts[:1] == ("demonstrations",):
        paths += [folder / file for folder in PACKAGED]
    return next((path for path in paths if path.is_file()), paths[0])


def load(file: Path | str) -> dict[str, np.ndarray]:
    """All that `file` holds, by name; rows in float32.

    Raises:
        ValueError: where there is no such file, it is damaged, or contradicts itself.
    """
    said = f"demonstrations={file}:"
    path = find(file)
    if not path.is_file():
        raise ValueError(f"{said} no such file; `python -m hybrid_rl.demonstrate` records one")
    try:
        with path.open("rb") as data, np.load(data, allow_pickle=False) as held:
            found = {name: held[name] for name in held.files}
    except UNREADABLE as error:
        raise ValueError(f"{said} is damaged, cut short, or no .npz file") from error
    if missing := [name for name in WHOLE if name not in found]:
        raise ValueError(f"{said} lacks {', '.join(missing)}")
    for name in (*ROWS, "episode", "sizes", "dt"):
        if found[name].dtype.kind not in "biuf":
            raise ValueError(f"{said} {name} is not made of numbers")
    _check_sizes(said, found)
    for name in ROWS:
        found[name] = found[name].astype(np.float32)
        finite = np.isfinite(found[name].reshape(len(found[name]), -1)).all(1)
        if not finite.all():
            raise ValueError(f"{said} {name} is not finite in row {finite.argmin()}")
    if np.abs(found["action"]).max() > 1:
        raise ValueError(f"{said} action must lie in [-1, 1]")
    last = np.append(np.diff(found["episode"]) != 0, True)
    ends = found["terminated"] + found["truncated"] > 0
    if (ends & ~last).any():
        raise ValueError(
            f"{said} an episode goes on after its end, in row {(ends & ~last).argmax()}"
        )
    found["truncated"][last & ~ends] = 1
    return found


def _check_sizes(said: str, found: dict[str, np.ndarray]) -> None:
    """Raise ValueError where arrays do not fit each other, or episodes are out of order."""
    if found["sizes"].shape != (2,) or found["dt"].ndim or found["task"].ndim:
        raise ValueError(f"{said} sizes must be two numbers, dt a number, task a name")
    count, (o, m) = len(np.atleast_1d(found["reward"])), found["sizes"].tolist()
    if not count:
        raise ValueError(f"{said} holds no decision")
    wanted = {"obs": (count, o), "action": (count, m), "next_obs": (count, o)}
    for name in (*ROWS, "episode"):
        shape = wanted.get(name, (count,))
        if found[name].shape != shape:
            raise ValueError(f"{said} {name} is {found[name].shape}, not {shape}")
    if (np.diff(found["episode"]) < 0).any():
        raise ValueError(f"{said} episodes must follow one another")


@dataclass(frozen=True)
class Demonstrations:
    """The first `episodes` of `file`, of this task in this world.

    Raises:
        ValueError: where the file is none, is of another task, or has fewer episodes.
    """

    file: str
    task: str
    world: Env
    episode: Any = None  # its `action_repeat`, as in the configuration; None: 1
    episodes: int | None = None  # None: all

    def __post_init__(self) -> None:
        """Check the fields and the file."""
        if self.episodes is not None and self.episodes < 1:
            raise ValueError(f"num_demonstrations={self.episodes}: must be 1 or more, or null")
        self.load()

    def load(self) -> Transition:
        """Its decisions [N], in order."""
        found, said = load(self.file), f"demonstrations={self.file}:"
        if str(found["task"]) != self.task:
            raise ValueError(f"{said} is of task {found['task']}, not of {self.task}")
        spec = self.world.spec
        for name, has, needs in zip(
            ("obs", "action"), found["sizes"].tolist(), (spec.obs, spec.act), strict=True
        ):
            if has != needs:
                raise ValueError(f"{said} {name} has {has} numbers, this {self.task} has {needs}")
        dt = spec.dt * (self.episode or {"action_repeat": 1})["action_repeat"]
        if not np.isclose(found["dt"], dt):
            raise ValueError(f"{said} decides every {found['dt']:g} s, this {self.task} {dt:g} s")
        _, episode = np.unique(found["episode"], return_inverse=True)
        wanted = episode[-1] + 1 if self.episodes is None else self.episodes
        if wanted > episode[-1] + 1:
            raise ValueError(f"num_demonstrations={wanted}: {self.file} has {episode[-1] + 1}")
        rows: Any = (found[name][episode < wanted] for name in ROWS)
        return Transition(*rows)
