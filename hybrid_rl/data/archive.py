"""The .npz files of the library: found, read without pickles, and compared with a task.

A file holds arrays by name, among them

    task: its name   sizes: (o, m)   dt [s] between decisions

and perhaps `about`, a text of JSON. The files in `demonstrations/` and `policies/` of this
repository come with the installed package: a relative path that does not exist in the working
directory is searched there.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.files.atomic import replacing
from hybrid_rl.protocols import Env
from hybrid_rl.types import NAME, PyTree, Spec

PACKAGE = Path(__file__).parents[1]
PARENTS = (PACKAGE, PACKAGE.parent)  # of FOLDERS in a wheel and in a checkout
FOLDERS = ("demonstrations", "policies")
HEADER = ("task", "sizes", "dt")
ABOUT = "about"
PARTS = ("policy", "model", "reward_model", "critic")  # whose parameters a policy's file may hold
WRITE = "`python -m hybrid_rl.demonstrate run=DIR policy=FILE` writes one"
WORDS = ("task", ABOUT)  # arrays that hold text


def write(file: Path | str, task: str, spec: Spec, arrays: Mapping[str, np.ndarray]) -> None:
    """Write `arrays` of `task`, whose sizes and time step are those of `spec`."""
    if not NAME.fullmatch(task):
        raise ValueError(f"task={task!r}: a file needs a name of letters, digits, _, . and -")
    header: dict[str, Any] = {
        "task": np.array(task),
        "sizes": np.array([spec.obs, spec.act]),
        "dt": np.array(spec.dt),
    }
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    with replacing(Path(file)) as draft, draft.open("wb") as out:
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
    header, which may be empty; others are then not read; hint: what to do if there is no such file.
    """
    needed = tuple(needed)
    path = find(file)
    if not path.is_file():
        raise ValueError(f"{prefix} no such file{hint and '; '}{hint}")
    try:
        with path.open("rb") as opened, np.load(opened) as data:
            names = {*data.files} & {*needed, *header, ABOUT} if needed else data.files
            arrays = {name: data[name] for name in names}
    except Exception as error:  # whatever NumPy makes of damaged bytes
        raise ValueError(f"{prefix} is damaged, cut short, or no .npz file") from error
    if missing := [name for name in (*needed, *header) if name not in arrays]:
        raise ValueError(f"{prefix} lacks {', '.join(missing)}")
    for name, array in arrays.items():
        if array.dtype.kind not in ("U" if name in WORDS else "biuf"):
            raise ValueError(f"{prefix} {name} must hold {'text' if name in WORDS else 'numbers'}")
    if header:
        _check_header(prefix, arrays)
    return arrays


def _check_header(prefix: str, arrays: Mapping[str, np.ndarray]) -> None:
    """Raise ValueError unless the header has the form that `write` gives it."""
    task, sizes, dt = (arrays[name] for name in HEADER)
    if sizes.shape != (2,) or sizes.dtype.kind not in "iu" or dt.ndim or task.ndim:
        raise ValueError(f"{prefix} sizes must be two numbers, dt a number, task a name")
    if not NAME.fullmatch(str(task)):
        raise ValueError(f"{prefix} task={str(task)[:40]!r}: must be letters, digits, _, . and -")


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
    spec, repeat = world.spec, (episode or {"action_repeat": 1})["action_repeat"]
    obs, act = arrays["sizes"].tolist()
    has = {"task": str(arrays["task"]), "obs": obs, "action": act, "dt": float(arrays["dt"])}
    needs = {"task": task, "obs": spec.obs, "action": spec.act, "dt": spec.dt * repeat}
    for name, value in has.items():
        if value != needs[name] and not (name == "dt" and np.isclose(value, needs[name])):
            raise ValueError(f"{prefix} is of {name} {value}; this run has {name} {needs[name]}")


def part_arrays(prefix: str, params: PyTree, part: str = "policy") -> dict[str, np.ndarray]:
    """The parameters of a part, of PARTS, by their names in a file."""
    leaves = jax.tree_util.tree_leaves_with_path(params)
    arrays = {_name(path, part): np.asarray(leaf) for path, leaf in leaves}
    return fitting(prefix, arrays, arrays)


def policy(
    file: str,
    like: PyTree,
    task: str,
    world: Env,
    episode: Mapping[str, int] | None,
    part: str = "policy",
) -> PyTree:
    """The parameters in `file` of a policy for `task` in `world`.

    like: their structure and shapes. part: of PARTS; those of the others are not read.
    """
    prefix = f"policy.file={file}:"
    arrays = read(prefix, file, hint=WRITE)
    check_task(prefix, arrays, task, world, episode)
    leaves, tree = jax.tree_util.tree_flatten_with_path(like)
    others = tuple(f"{name}/" for name in PARTS if name != part)
    names = (name for name in arrays if not name.startswith(others))
    own = {name: arrays[name] for name in names if name not in (*HEADER, ABOUT)}
    kept = fitting(prefix, own, {_name(path, part): leaf for path, leaf in leaves})
    return jax.tree.unflatten(tree, map(jnp.asarray, kept.values()))


def fitting(
    prefix: str, arrays: Mapping[str, np.ndarray], like: Mapping[str, Any]
) -> dict[str, np.ndarray]:
    """The arrays, finite, in the shapes, types and order of those of `like`, all and no others."""
    for name in sorted({*arrays, *like}):
        has, needs = (of[name].shape if name in of else "absent" for of in (arrays, like))
        if has != needs:
            raise ValueError(f"{prefix} {name} is {has}; it must be {needs}")
    with np.errstate(all="ignore"):  # what becomes infinite is refused
        kept = {name: arrays[name].astype(leaf.dtype) for name, leaf in like.items()}
    for name, array in kept.items():
        if not (finite := np.isfinite(array)).all():
            entry = np.argwhere(~finite)[0].tolist()
            raise ValueError(f"{prefix} {name} is not finite at {entry}")
    return kept


def _name(path: Any, part: str) -> str:
    """The name of the parameter of a part at `path`."""
    return "/".join([part, jax.tree_util.keystr(path, simple=True, separator="/")])
