"""The newest parameters of a learner in a file, which another process reads without waiting."""

import os
import zlib
from pathlib import Path
from typing import Any

import jax
import numpy as np

from hybrid_rl.files.atomic import open_own

HEAD = np.dtype([("version", "<i8"), ("check", "<u4"), ("size", "<u8")])


def publish(file: Path, tree: Any, version: int) -> None:
    """Write the leaves of `tree`; a reader finds these, or the ones before, and never a part."""
    leaves = [np.asarray(leaf) for leaf in jax.tree.leaves(tree)]
    body = b"".join(leaf.tobytes() for leaf in leaves)
    head = np.array((version, zlib.crc32(body), len(body)), HEAD)
    new = file.with_suffix(".new")
    with open_own(new, "wb") as out:
        out.write(head.tobytes() + body)
    os.replace(new, file)


def latest(file: Path, like: Any) -> tuple[int, Any] | None:
    """(version, tree) with the shapes of `like`; None if there is none, or none that fits."""
    leaves, structure = jax.tree.flatten(like)
    sizes = [int(np.prod(leaf.shape)) * np.dtype(leaf.dtype).itemsize for leaf in leaves]
    try:
        with open_own(file, "rb") as given:
            data = given.read(HEAD.itemsize + sum(sizes) + 1)
    except FileNotFoundError:
        return None
    if len(data) < HEAD.itemsize:
        return None
    head, body = np.frombuffer(data, HEAD, 1)[0], data[HEAD.itemsize :]
    if len(body) != sum(sizes) or head["size"] != len(body) or head["check"] != zlib.crc32(body):
        return None
    found, at = [], 0
    for leaf, size in zip(leaves, sizes, strict=True):
        part = np.frombuffer(body, leaf.dtype, size // np.dtype(leaf.dtype).itemsize, at)
        found.append(part.reshape(leaf.shape))
        at += size
    return int(head["version"]), jax.tree.unflatten(structure, found)
