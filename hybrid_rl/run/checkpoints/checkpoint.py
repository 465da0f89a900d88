"""Checkpoints that are complete or absent, and are restored bit for bit.

    FOLDER/STEP/state/         the leaves of the state, written by Orbax
               /leaves.json    name -> shape, dtype, and PRNG implementation of a key
               /meta.json      further values of the caller
               /manifest.json  every file above with its size and SHA-256

A checkpoint is written to a draft, forced to the disk, then renamed, so every folder whose name is
a number is complete; one without a manifest never was. An older checkpoint of that step is
FOLDER/.STEP.replaced.NONCE.tmp between the two renames, and counts as STEP until there is a new
one. A checkpoint is renamed before it is deleted, so another process reads all of it or none, and
then takes a newer one. Leaves are stored flat, by their path in the state, so the state may consist
of any containers, and a part of it (parameters without replay memory, say) can be restored alone.
"""

import contextlib
import hashlib
import json
import os
import re
import secrets
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

from hybrid_rl.errors import CheckpointError
from hybrid_rl.files.atomic import own_folder, sync
from hybrid_rl.run.checkpoints import leaves
from hybrid_rl.types import PyTree

Like = PyTree | Callable[[dict[str, Any]], PyTree]  # what is read, perhaps by the meta
MANIFEST = "manifest.json"
KEEP = 2  # complete checkpoints
NAME = re.compile(r"(\d+)|\.(\d+)\.replaced\.\w+\.tmp")  # of a finished checkpoint


def steps(folder: Path) -> list[int]:
    """Steps of the finished checkpoints in `folder`, oldest first."""
    return sorted(_finished(folder))


def _finished(folder: Path) -> dict[int, Path]:
    """The finished checkpoints in `folder` by step."""
    checkpoints: dict[int, Path] = {}
    for path in folder.iterdir() if folder.is_dir() else ():
        if (match := NAME.fullmatch(path.name)) and path.is_dir():
            step = int(match[1] or match[2])
            if match[1] or step not in checkpoints:  # a replaced one counts if there is no other
                checkpoints[step] = path
    return checkpoints


def meta(folder: Path) -> dict[str, Any]:
    """meta.json of the newest readable checkpoint; {} if there is none."""
    for _, path in sorted(_finished(folder).items(), reverse=True):
        with contextlib.suppress(OSError, ValueError):
            return json.loads((path / "meta.json").read_text(encoding="utf-8"))
    return {}


def save(folder: Path, step: int, state: PyTree, meta: dict, keep: int = KEEP) -> Path:
    """Write FOLDER/STEP, then delete all but the newest `keep` checkpoints.

    Checkpoints beyond `step` are deleted, too: the run was resumed from an earlier one.
    meta: values that JSON can represent. After a CheckpointError earlier checkpoints are as before.
    """
    arrays, kinds = leaves.flatten(state)
    texts = {"meta.json": json.dumps(meta, indent=1), "leaves.json": json.dumps(kinds, indent=0)}
    draft = _hidden(folder, str(step))
    try:
        own_folder(folder)  # not its parents: a run folder that is gone stays gone
        for number, path in _finished(folder).items():
            if path.name != str(number):  # replaced, and a kill left no newer one
                _rename(path, folder / str(number))
        _sweep(folder)
        draft.mkdir()
        for name, text in texts.items():
            (draft / name).write_text(text + "\n", encoding="utf-8")
        leaves.write(draft, arrays)
        list_files(draft)
        path = _rename(draft, folder / str(step))
    except Exception as problem:
        raise CheckpointError(_refusal(folder, step, problem)) from problem
    finally:
        if draft.exists():  # after an error, or Ctrl-C
            shutil.rmtree(draft, ignore_errors=True)
    known = steps(folder)
    sound = [s for s in known if s <= step and not verify(folder / str(s), False)]
    for old in set(known) - set(sound[-keep:]):  # those that the new one replaces
        with contextlib.suppress(OSError):
            (folder / str(old)).rename(_hidden(folder, f"{old}.pruned"))
    _sweep(folder)
    return path


def restore(
    folder: Path, like: Like, step: int | None = None
) -> tuple[int, PyTree, dict, list[str]]:
    """The newest sound checkpoint, or the one at `step`: (step, state, meta, notes).

    `like`, or `like(meta)`, gives the structure, shapes and dtypes (arrays, or what
    `jax.eval_shape` returns), of all leaves or of some; they are arrays on the default device.
    notes: one line for each checkpoint that was skipped. Another process may write checkpoints to
    `folder` and delete older ones meanwhile.
    """
    while True:
        checkpoints = _finished(folder)
        wanted, notes = {step} if step is not None else {*checkpoints}, []
        for candidate in sorted(wanted & checkpoints.keys(), reverse=True):
            path = checkpoints[candidate]
            before = _identity(path)
            read, flaw = None, verify(path)
            try:
                read = leaves.read(path, like) if flaw is None else None
            except CheckpointError:
                raise
            except (OSError, ValueError) as problem:  # TensorStore raises ValueError
                flaw = " ".join(str(problem).split())
            if before is None or _identity(path) != before:
                break  # deleted or replaced while it was read: begin again
            if read is not None:
                return candidate, *read, notes
            notes.append(f"checkpoint {candidate} is skipped: {flaw}")
        else:
            named = "checkpoint" if step is None else f"checkpoint {step}"
            flaw = f"no sound checkpoint: {'; '.join(notes)}" if notes else f"no {named}"
            raise CheckpointError(f"{folder} holds {flaw}")


def _identity(path: Path) -> tuple[int, int, int] | None:
    """An identity of a folder that survives renaming; None if there is none."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_dev, status.st_ino, status.st_mtime_ns


def _sweep(folder: Path) -> None:
    """Delete what belongs to no checkpoint; what cannot be deleted stays."""
    for path in folder.glob(".*.tmp"):
        shutil.rmtree(path, ignore_errors=True)


def _hidden(folder: Path, stem: str) -> Path:
    """A new name of what is no checkpoint, or no longer: FOLDER/.STEM.NONCE.tmp."""
    return folder / f".{stem}.{secrets.token_hex(4)}.tmp"


def _rename(draft: Path, path: Path) -> Path:
    """Give a complete draft its name, which an older checkpoint loses."""
    if os.path.lexists(path):
        path.rename(_hidden(path.parent, f"{path.name}.replaced"))
    draft.rename(path)
    sync(path.parent)
    return path


def _refusal(folder: Path, step: int, problem: Exception) -> str:
    """One line for a checkpoint that could not be written."""
    reason = " ".join(str(problem).split()) or type(problem).__name__
    if system := re.search(r"([^:]+) \[os_error_code=", reason):  # the end of TensorStore's message
        reason = system[1].strip()
    before = [s for s in steps(folder) if not verify(folder / str(s), False)]
    last = f"checkpoint {before[-1]} is intact" if before else "there is no earlier one"
    return f"checkpoint {step} in {folder} was not written: {reason}; {last}"


def list_files(folder: Path) -> None:
    """List all files below `folder`, then force files and folders to the disk."""
    below, manifest = sorted(folder.rglob("*")), folder / MANIFEST
    listed = {
        path.relative_to(folder).as_posix(): {"bytes": path.stat().st_size, "sha256": digest(path)}
        for path in below
        if path.is_file()
    }
    manifest.write_text(json.dumps({"files": listed}, indent=1) + "\n", encoding="ascii")
    for path in [*below, manifest, folder]:
        sync(path)


def verify(folder: Path, contents: bool = True) -> str | None:
    """The first difference of `folder` from its manifest; None if there is none.

    contents: read every byte, not only sizes.
    """
    try:
        listed = json.loads((folder / MANIFEST).read_text(encoding="ascii"))["files"]
        files = [(name, entry["bytes"], entry["sha256"]) for name, entry in listed.items()]
    except FileNotFoundError:
        return f"it has no {MANIFEST}, so its writing was cut off"
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError) as problem:
        return f"its {MANIFEST} cannot be read ({type(problem).__name__})"
    for name, size, sha256 in files:
        try:
            if not (folder / name).is_file():  # a pipe or a device might have no end
                return f"{name} is missing, or no plain file"
            if (size_now := (folder / name).stat().st_size) != size:
                return f"{name} has {size_now} bytes instead of {size}"
            if contents and digest(folder / name) != sha256:
                return f"{name} has changed since it was written (SHA-256 differs)"
        except OSError as problem:
            return f"{name} cannot be read ({problem.strerror})"
    return None


def digest(path: Path) -> str:
    """SHA-256 of a file, in hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
