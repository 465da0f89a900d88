"""The leaves of a state, in files and back, by Orbax.

The name of a leaf is its path in the state: "learners.policy.params". Keys of JAX are stored as
their data, arrays without elements as their shape alone.
"""

import contextlib
import io
import json
import logging
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from urllib.parse import quote

import jax
import numpy as np

from hybrid_rl.errors import MisfitError
from hybrid_rl.types import PyTree

AFTERMATH = 0.5  # [s] in which TensorStore's threads print tracebacks after a failed write
WRITTEN = "manifest.ocdbt"  # by Orbax as the last file: without it nothing can be read


def flatten(state: PyTree) -> tuple[dict[str, np.ndarray], dict[str, dict]]:
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
    """(name, leaf) in the order of the tree, such as ("learners.sac.params", ...)."""
    pairs = jax.tree_util.tree_flatten_with_path(tree)[0]
    names = [quote(jax.tree_util.keystr(path, simple=True, separator=".")) for path, _ in pairs]
    assert len(set(names)) == len(names), "leaves of one state share a name"
    return [(name or "state", leaf) for name, (_, leaf) in zip(names, pairs, strict=True)]


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Suppress the output of Orbax and TensorStore."""
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


@contextlib.contextmanager
def _plain(path: Path) -> Iterator[Path]:
    r"""A path to the folder `path` that Orbax takes literally: it reads [...] and \ as patterns."""
    path = path.resolve()
    if not set("[]*?\\") & set(str(path)):
        yield path
        return
    with TemporaryDirectory() as private:
        link = Path(private).resolve() / "checkpoint"
        link.symlink_to(path, target_is_directory=True)
        yield link


def write(path: Path, leaves: dict[str, np.ndarray]) -> None:
    """The folder `path`/state by Orbax, uncompressed: three times as fast, and as small."""
    import orbax.checkpoint as ocp  # 1 s

    filled = {name: leaf for name, leaf in leaves.items() if leaf.size}  # it refuses empty ones
    handler = ocp.PyTreeCheckpointHandler(use_compression=False)
    with _quiet(), _plain(path) as plain, ocp.Checkpointer(handler) as writer:
        try:
            writer.save(plain / "state", ocp.args.PyTreeSave(filled))
        except Exception:
            time.sleep(AFTERMATH)
            raise
    if filled and not (path / "state" / WRITTEN).is_file():
        raise OSError(f"Orbax left no state/{WRITTEN}")


def read(path: Path, like: Any) -> tuple[PyTree, dict]:
    """The leaves of `like`, or of `like(meta)`, in a sound checkpoint, and its meta."""
    import orbax.checkpoint as ocp  # 1 s

    meta = json.loads((path / "meta.json").read_text(encoding="utf-8"))
    kinds = json.loads((path / "leaves.json").read_text(encoding="utf-8"))
    like = like(meta) if callable(like) else like
    wanted = dict(_named(like))
    _match(path, kinds, wanted)
    filled = {name: 0 for name in wanted if 0 not in kinds[name]["shape"]}
    host = dict.fromkeys(filled, ocp.RestoreArgs(restore_type=np.ndarray))
    args = ocp.args.PyTreeRestore(item=filled, restore_args=host, partial_restore=True)
    with _plain(path) as plain, ocp.Checkpointer(ocp.PyTreeCheckpointHandler()) as reader:
        # Orbax refuses an empty selection, which a method that learns nothing has.
        arrays = reader.restore(plain / "state", args) if filled else {}
    state = []
    for name, leaf in wanted.items():
        if name in arrays:
            array, kind = jax.numpy.array(arrays.pop(name)), kinds[name]["key"]
            state.append(jax.random.wrap_key_data(array, impl=kind) if kind else array)
        else:
            state.append(jax.numpy.zeros(leaf.shape, leaf.dtype))  # without elements
    return jax.tree.unflatten(jax.tree.structure(like), state), meta


def _match(path: Path, kinds: dict[str, dict], wanted: dict) -> None:
    """Raise MisfitError unless a sound checkpoint has the leaves `wanted`, of learners all."""
    learners = {tuple(name.split(".")[:2]) for name in wanted if name.startswith("learners.")}
    more = [name for name in kinds if tuple(name.split(".")[:2]) in learners]
    for name in {**wanted, **dict.fromkeys(more)}:
        leaf = wanted.get(name)
        here = "absent" if leaf is None else f"{leaf.dtype}{list(leaf.shape)}"
        there = f"{kinds[name]['dtype']}{kinds[name]['shape']}" if name in kinds else "absent"
        if here != there:
            line = f"{path} does not fit this run: {name} is {here} here and {there} there"
            raise MisfitError(line)
