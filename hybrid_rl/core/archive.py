"""The .npz files of the library: found, read without pickles, and compared with a task.

A file holds arrays by name, among them

    task: its name   sizes: (o, m)   dt [s] between decisions

The files in `demonstrations/` of this repository come with the installed package: a relative path
that does not exist in the working directory is searched there.
"""

import zipfile
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.protocols import Env
from hybrid_rl.types import Spec

PACKAGE = Path(__file__).parents[1]
PARENTS = (PACKAGE, PACKAGE.parent)  # of `demonstrations/` in a wheel and in a checkout
HEADER = ("task", "sizes", "dt")
UNREADABLE = (OSError, ValueError, EOFError, TypeError, zipfile.BadZipFile, zlib.error)


def write(file: Path | str, task: str, spec: Spec, arrays: Mapping[str, np.ndarray]) -> None:
    """Write `arrays` of `task`, whose sizes and time step are those of `spec`."""
    header: dict[str, Any] = {
        "task": np.array(task),
        "sizes": np.array([spec.obs, spec.act]),
        "dt": np.array(spec.dt),
    }
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    with Path(file).open("wb") as out:
        np.savez_compressed(out, **arrays, **header)


def find(file: Path | str) -> Path:
    """The path of `file`, or if it does not exist of the packaged file of that name."""
    paths = [Path(file)]
    if paths[0].parts[:1] == ("demonstrations",):
        paths += [folder / file for folder in PARENTS]
    return next((path for path in paths if path.is_file()), paths[0])


def read(
    prefix: str,
    file: Path | str,
    needed: Iterable[str] = (),
    hint: str = "",
    header: tuple[str, ...] = HEADER,
) -> dict[str, np.ndarray]:
    """The arrays of `file` by name, with the header; the others are numbers.

    prefix: the beginning of every message; needed: names that the file must have besides the
    header, which may be empty; hint: what to do if there is no such file.

    Raises:
        ValueError: for a file that is missing or damaged, or lacks a name.
    """
    path = find(file)
    if not path.is_file():
        raise ValueError(f"{prefix} no such file{hint and '; '}{hint}")
    try:
        with path.open("rb") as data, np.load(data, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except UNREADABLE as error:
        raise ValueError(f"{prefix} is damaged, cut short, or no .npz file") from error
    if missing := [name for name in (*needed, *header) if name not in arrays]:
        raise ValueError(f"{prefix} lacks {', '.join(missing)}")
    for name, array in arrays.items():
        if name != "task" and array.dtype.kind not in "biuf":
            raise ValueError(f"{prefix} {name} must hold numbers")
    if not header:
        return arrays
    if arrays["sizes"].shape != (2,) or arrays["dt"].ndim or arrays["task"].ndim:
        raise ValueError(f"{prefix} sizes must be two numbers, dt a number, task a name")
    return arrays


def check_task(
    prefix: str,
    arrays: Mapping[str, np.ndarray],
    task: str,
    world: Env,
    episode: Mapping[str, int] | None,
) -> None:
    """Raise ValueError unless the header is of `task` in `world`.

    episode: with `action_repeat`, the steps of `world` in a decision; None: 1.
    """
    if str(arrays["task"]) != task:
        raise ValueError(f"{prefix} is of task {arrays['task']}, not of {task}")
    spec = world.spec
    for name, has, needs in zip(
        ("obs", "action"), arrays["sizes"].tolist(), (spec.obs, spec.act), strict=True
    ):
        if has != needs:
            raise ValueError(f"{prefix} {name} has {has} numbers, this {task} has {needs}")
    dt = spec.dt * (episode or {"action_repeat": 1})["action_repeat"]
    if not np.isclose(arrays["dt"], dt):
        raise ValueError(f"{prefix} decides every {arrays['dt']:g} s, this {task} {dt:g} s")
