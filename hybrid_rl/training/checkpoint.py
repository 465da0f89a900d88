"""Checkpoints that are whole or absent, and come back bit for bit.

    FOLDER/STEP/state/         the leaves of the state, written by Orbax
               /leaves.json    name -> shape, dtype, and PRNG kind where it is a key
               /meta.json      what the caller wants back beside the state
               /manifest.json  every file above with its size and SHA-256

A checkpoint is written as FOLDER/.STEP.tmp, forced to the disk, then renamed:
whatever has a number for a name was finished. Leaves are stored flat, by their
path in the state, so that containers of any type are welcome and a part of the
state (say, parameters without replay memory) can be restored alone.
"""

import contextlib
import io
import json
import logging
import re
import shutil
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import quote

import jax
import numpy as np

from hybrid_rl.training import manifest
from hybrid_rl.types import PyTree

KEEP = 2  # complete checkpoints that stay
AFTERMATH = 0.5  # [s] in which TensorStore's threads print tracebacks after a failed write


class CheckpointError(OSError):
    """A checkpoint that cannot be written, or none that can be read; one line says why."""


def nbytes(state: PyTree) -> int:
    """[bytes] that a checkpoint of `state` takes on the disk, but for a few kB."""
    return sum(leaf.size * leaf.dtype.itemsize for leaf in jax.tree.leaves(state))


def steps(folder: Path) -> list[int]:
    """Steps of the finished checkpoints in `folder`, oldest first."""
    if not folder.is_dir():
        return []
    return sorted(int(path.name) for path in folder.iterdir() if path.name.isdecimal())


def save(folder: Path, step: int, state: PyTree, meta: dict, keep: int = KEEP) -> Path:
    """Writes FOLDER/STEP, then deletes all but the newest `keep`.

    Checkpoints beyond `step` go too: they belong to a future that was left when
    the run went on from here. `meta` is anything that JSON holds.
    """
    leaves, kinds = _flatten(state)
    texts = {"meta.json": json.dumps(meta, indent=1), "leaves.json": json.dumps(kinds, indent=0)}
    draft = folder / f".{step}.tmp"
    try:
        for stale in folder.glob(".*.tmp"):
            shutil.rmtree(stale)
        draft.mkdir(parents=True)
        _fits(folder, sum(leaf.nbytes for leaf in leaves.values()))
        for name, text in texts.items():
            (draft / name).write_text(text + "\n", encoding="utf-8")
        _write(draft.resolve() / "state", leaves)
        manifest.seal(draft)
        place = _rename(draft, folder / str(step))
    except Exception as problem:
        line = _refusal(folder, step, problem)
        shutil.rmtree(draft, ignore_errors=True)
        raise CheckpointError(line) from problem
    except BaseException:  # Ctrl-C and the like
        shutil.rmtree(draft, ignore_errors=True)
        raise
    _prune(folder, step, keep)
    return place


def restore(
    folder: Path, like: PyTree, step: int | None = None, part: bool = False
) -> tuple[int, PyTree, dict, list[str]]:
    """The newest sound checkpoint, or the one at `step`: (step, state, meta, notes).

    `like` gives the structure, shapes and dtypes (arrays, or what `jax.eval_shape`
    returns); leaves come back as arrays on the default device. part: `like` may lack leaves
    that the checkpoint has. `notes` says in one line each what was passed over.
    """
    found = steps(folder)
    if step is not None and step not in found:
        raise CheckpointError(f"{folder} has no checkpoint {step}; it has {found or 'none'}")
    wanted = found[::-1] if step is None else [step]
    notes = []
    for candidate in wanted:
        place = folder / str(candidate)
        flaw = manifest.flaw(place)
        if flaw is None:
            try:
                return candidate, *_read(place, like, part), notes
            except CheckpointError:
                raise
            except (OSError, ValueError) as problem:  # TensorStore raises ValueError
                flaw = " ".join(str(problem).split())
        notes.append(f"checkpoint {candidate} is passed over: {flaw}")
    if not notes:
        raise CheckpointError(f"{folder} holds no checkpoint")
    raise CheckpointError(f"{folder} holds no sound checkpoint: " + "; ".join(notes))


def _flatten(state: PyTree) -> tuple[dict[str, np.ndarray], dict[str, dict]]:
    """Arrays on the host by name, and what each was."""
    leaves, kinds = {}, {}
    for name, leaf in _named(state):
        key = jax.numpy.issubdtype(leaf.dtype, jax.dtypes.prng_key)
        kinds[name] = {
            "shape": list(leaf.shape),
            "dtype": str(leaf.dtype),
            "key": str(jax.random.key_impl(leaf)) if key else None,
        }
        leaves[name] = np.asarray(jax.device_get(jax.random.key_data(leaf) if key else leaf))
    return leaves, kinds


def _named(tree: PyTree) -> list[tuple[str, jax.Array]]:
    """Leaves beside their names, in the order of the tree: "learners.sac.params"."""
    pairs = jax.tree_util.tree_flatten_with_path(tree)[0]
    names = [quote(jax.tree_util.keystr(path, simple=True, separator=".")) for path, _ in pairs]
    if len(set(names)) < len(names):
        twice = sorted(name for name in set(names) if names.count(name) > 1)
        raise ValueError(f"leaves of one state share a name: {twice}")
    return [(name or "state", leaf) for name, (_, leaf) in zip(names, pairs, strict=True)]


def _fits(folder: Path, needed: int) -> None:
    """Raises before the disk is filled. needed: [bytes]."""
    free = shutil.disk_usage(folder).free
    if needed > free:
        raise OSError(f"it needs {needed / 1e6:.0f} MB and the disk has {free / 1e6:.0f} MB left")


def _rename(draft: Path, place: Path) -> Path:
    """Gives a finished draft its name, and takes the name from an older one."""
    if place.exists():
        place.rename(place.with_name(f".{place.name}.replaced.tmp"))
    draft.rename(place)
    manifest.sync(place.parent)
    return place


def _prune(folder: Path, newest: int, keep: int) -> None:
    """Deletes what a new checkpoint makes superfluous."""
    sound = [s for s in steps(folder) if s <= newest and not manifest.flaw(folder / str(s), False)]
    stays = {str(s) for s in sound[-keep:]}
    for path in folder.iterdir():
        if (path.name.isdecimal() and path.name not in stays) or path.match(".*.tmp"):
            shutil.rmtree(path, ignore_errors=True)


def _refusal(folder: Path, step: int, problem: Exception) -> str:
    """One line for a checkpoint that could not be written."""
    reason = " ".join(str(problem).split()) or type(problem).__name__
    if system := re.search(r"([^:]+) \[os_error_code=", reason):  # the end of TensorStore's tale
        reason = system[1].strip()
    before = [s for s in steps(folder) if not manifest.flaw(folder / str(s), False)]
    kept = f"checkpoint {before[-1]} is whole" if before else "there is no earlier one"
    return f"checkpoint {step} in {folder} was not written: {reason}; {kept}"


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keeps Orbax's and TensorStore's running commentary off the terminal."""
    logger = logging.getLogger("absl")
    level, hook = logger.level, sys.unraisablehook
    logger.setLevel(logging.CRITICAL + 1)
    sys.unraisablehook = lambda _: None
    try:
        with contextlib.redirect_stderr(io.StringIO()):
            yield
    finally:
        logger.setLevel(level)
        sys.unraisablehook = hook


def _write(path: Path, leaves: dict[str, np.ndarray]) -> None:
    """Orbax, uncompressed: three times as fast as compressed, and random bits do not shrink."""
    import orbax.checkpoint as ocp  # 1 s

    filled = {name: leaf for name, leaf in leaves.items() if leaf.size}  # it refuses empty ones
    handler = ocp.PyTreeCheckpointHandler(use_compression=False)
    with _quiet(), ocp.Checkpointer(handler) as writer:
        try:
            writer.save(path, ocp.args.PyTreeSave(filled))
        except Exception:
            time.sleep(AFTERMATH)
            raise


def _read(place: Path, like: PyTree, part: bool) -> tuple[PyTree, dict]:
    """State and meta of a sound checkpoint."""
    import orbax.checkpoint as ocp  # 1 s

    meta = json.loads((place / "meta.json").read_text(encoding="utf-8"))
    kinds = json.loads((place / "leaves.json").read_text(encoding="utf-8"))
    wanted = dict(_named(like))
    _match(place, kinds, wanted, part)
    filled = {name: 0 for name in wanted if 0 not in kinds[name]["shape"]}
    host = dict.fromkeys(filled, ocp.RestoreArgs(restore_type=np.ndarray))
    args = ocp.args.PyTreeRestore(item=filled, restore_args=host, partial_restore=True)
    with _quiet(), ocp.Checkpointer(ocp.PyTreeCheckpointHandler()) as reader:
        arrays = reader.restore(place.resolve() / "state", args)
    state = []
    for name, leaf in wanted.items():
        array = jax.numpy.array(arrays.pop(name) if name in arrays else np.zeros(**_empty(leaf)))
        kind = kinds[name]["key"]
        state.append(jax.random.wrap_key_data(array, impl=kind) if kind else array)
    return jax.tree.unflatten(jax.tree.structure(like), state), meta


def _empty(leaf: jax.Array) -> dict:
    """Shape and dtype of an array without elements, of keys as of numbers."""
    key = jax.numpy.issubdtype(leaf.dtype, jax.dtypes.prng_key)
    data = jax.eval_shape(jax.random.key_data, leaf) if key else leaf
    return {"shape": data.shape, "dtype": data.dtype}


def _match(place: Path, kinds: dict[str, dict], wanted: dict, part: bool) -> None:
    """Raises where a sound checkpoint is of another run than `wanted`."""
    for name, leaf in wanted.items():
        here = f"{leaf.dtype}{list(leaf.shape)}"
        there = f"{kinds[name]['dtype']}{kinds[name]['shape']}" if name in kinds else "absent"
        if here != there:
            line = f"{place} does not fit this run: {name} is {here} here and {there} there"
            raise CheckpointError(line)
    surplus = sorted(set(kinds) - set(wanted))
    if surplus and not part:
        raise CheckpointError(f"{place} does not fit this run: {surplus[0]} is there and not here")
