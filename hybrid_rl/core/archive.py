"""The .npz files of the library: found, read without pickles, and compared with a task.

A file holds arrays by name, among them

    task: its name   sizes: (o, m)   dt [s] between decisions

and perhaps `about`, a text of JSON. The files in `demonstrations/` and `policies/` of this
repository come with the installed package: a relative path that does not exist in the working
directory is searched there.
"""

import zipfile
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.protocols import Env
from hybrid_rl.types import PyTree, Spec

PACKAGE = Path(__file__).parents[1]
PARENTS = (PACKAGE, PACKAGE.parent)  # of FOLDERS in a wheel and in a checkout
FOLDERS = ("demonstrations", "policies")
HEADER = ("task", "sizes", "dt")
ABOUT = "about"
WRITE = "`python -m hybrid_rl.demonstrate run=DIR policy=FILE` writes one"
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
    if paths[0].parts[:1] and paths[0].parts[0] in FOLDERS:
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
        if name not in ("task", ABOUT) and array.dtype.kind not in "biuf":
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


def policy_arrays(prefix: str, params: PyTree) -> dict[str, np.ndarray]:
    """The parameters of a policy by their names in a file.

    Raises:
        ValueError: for one that is not finite.
    """
    leaves = jax.tree_util.tree_leaves_with_path(params)
    arrays = {_name(path): np.asarray(leaf) for path, leaf in leaves}
    _check_finite(prefix, arrays)
    return arrays


def policy(
    file: str, like: PyTree, task: str, world: Env, episode: Mapping[str, int] | None
) -> PyTree:
    """The parameters in `file` of a policy for `task` in `world`.

    like: their structure and shapes.

    Raises:
        ValueError: for an unusable file, or one of another task or another policy.
    """
    prefix = f"policy.file={file}:"
    arrays = read(prefix, file, hint=WRITE)
    check_task(prefix, arrays, task, world, episode)
    leaves, tree = jax.tree_util.tree_flatten_with_path(like)
    shapes = {_name(path): leaf.shape for path, leaf in leaves}
    for name in sorted({*shapes, *arrays} - {*HEADER, ABOUT}):
        if name not in arrays:
            raise ValueError(f"{prefix} lacks {name}, which this policy has")
        if name not in shapes:
            raise ValueError(f"{prefix} has {name}, which this policy lacks")
        if arrays[name].shape != shapes[name]:
            raise ValueError(
                f"{prefix} {name} is {arrays[name].shape}, this policy's is {shapes[name]}"
            )
    kept = {name: arrays[name] for name in shapes}
    _check_finite(prefix, kept)
    return jax.tree.unflatten(tree, map(jnp.asarray, kept.values()))


def _name(path: Any) -> str:
    """The name of the parameter of a policy at `path`."""
    return "/".join(["policy", jax.tree_util.keystr(path, simple=True, separator="/")])


def _check_finite(prefix: str, arrays: Mapping[str, np.ndarray]) -> None:
    """Raise ValueError for an array that is not finite."""
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            raise ValueError(f"{prefix} {name} is not finite")
