"""The newest parameters of a learner in a file, which another process reads without waiting.

The file is one row with a checksum, as those of `row_log`, with a field for each leaf.
"""

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jax
import numpy as np

from hybrid_rl.files.atomic import open_own
from hybrid_rl.outside.row_log import opened, sealed


def publish(file: Path, tree: Any, version: int) -> None:
    """Write the leaves of `tree`; a reader finds these, or the ones before, and never a part."""
    leaves = [np.asarray(leaf) for leaf in jax.tree.leaves(tree)]
    row = np.array((version, *leaves, 0), _kind(leaves))
    new = file.with_suffix(".new")
    with open_own(new, "wb") as out:
        out.write(sealed(row))
    os.replace(new, file)


def latest(file: Path, like: Any) -> tuple[int, Any] | None:
    """(version, tree) with the shapes of `like`; None if there is none, or none that fits."""
    leaves, structure = jax.tree.flatten(like)
    kind = _kind(leaves)
    try:
        with open_own(file, "rb") as given:
            row: Any = opened(given.read(kind.itemsize + 1), kind)
    except FileNotFoundError:
        return None
    if row is None:
        return None
    version, *found, _ = (row[name] for name in kind.names or ())
    return int(version), jax.tree.unflatten(structure, found)


def _kind(leaves: Sequence[Any]) -> np.dtype:
    """The fields of the row."""
    own = [(str(i), leaf.dtype, leaf.shape) for i, leaf in enumerate(leaves)]
    return np.dtype([("version", "<i8"), *own, ("check", "<u4")])
