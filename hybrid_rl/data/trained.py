"""A trained policy from a file: a teacher, or a fixed controller.

The file is a NumPy .npz without pickles, with the header of data/archive and every array of the
policy's parameters by its path, such as policy/trunk/params/Dense_0/kernel. `about` describes it.
`python -m hybrid_rl.demonstrate run=DIR policy=FILE` writes it.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax
import numpy as np
from jax import Array

from hybrid_rl.data import archive
from hybrid_rl.files import targets as parts
from hybrid_rl.protocols import Env
from hybrid_rl.types import PyTree, Spec

ITSELF = "hybrid_rl.data.trained.SavedPolicy"
SMALL = 1000  # entries of an array that keeps its precision


def save(
    file: Path | str,
    task: str,
    spec: Spec,
    params: PyTree,
    about: Mapping[str, Any] | None = None,
    models: Mapping[str, PyTree] | None = None,
) -> None:
    """Write the parameters of a policy for `task`, whose decisions have `spec`.

    about: what JSON can hold about its origin. models: parameters of `model`, `reward_model` and
    perhaps `critic`, to plan with, which are written with 16 bits.
    """
    arrays = archive.part_arrays(f"policy={file}:", params)
    for name, tree in (models or {}).items():
        halved = jax.tree.map(_halved, tree)
        arrays |= archive.part_arrays(f"policy={file}:", halved, name)
    if about is not None:
        arrays[archive.ABOUT] = np.array(json.dumps(about))
    archive.write(file, task, spec, arrays)


def _halved(leaf: Any) -> np.ndarray:
    """An array of weights with 16 bits; small arrays, such as statistics, as they are."""
    leaf = np.asarray(leaf)
    return leaf.astype(np.float16) if leaf.size > SMALL and leaf.dtype == np.float32 else leaf


def described(file: str) -> Any:
    """The policy that `file` describes: its class and fields, without parameters."""
    prefix = f"policy.file={file}:"
    arrays = archive.read(prefix, file, hint=archive.WRITE)
    try:
        node = json.loads(str(arrays[archive.ABOUT]))["policy"]
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise ValueError(f"{prefix} does not describe its policy; {archive.WRITE}") from error
    return part(prefix, file, node)


def part(prefix: str, file: str, node: Any) -> Any:
    """The part that `node` of the description in `file` names, with the parts in it.

    prefix: the beginning of every message.
    """
    try:
        if any(name == ITSELF for _, name in parts.targets([node])):
            raise ValueError("describes a policy in another file, not its own")
        return parts.build(node, archive.find(file))
    except ValueError as error:
        raise ValueError(f"{prefix} {error}") from error


@dataclass(frozen=True)
class SavedPolicy:
    """`policy` with the parameters in `file`, which must be of `task` in `world`.

    policy: None is the one that the file describes.

    Its methods ignore the parameters that they get, so it can act where another policy learns.
    """

    policy: Any  # Policy, or None
    file: str
    task: str
    world: Env
    episode: Mapping[str, int] | None = None  # with `action_repeat`; None: 1

    def __post_init__(self) -> None:
        """Read the description if there is no policy, and check the file."""
        if self.policy is None:
            object.__setattr__(self, "policy", described(self.file))
        self.load()

    def load(self) -> PyTree:
        """The parameters of `policy`, as they were saved."""
        expected = jax.eval_shape(lambda: self.policy.init(jax.random.key(0), self.world.spec))
        return archive.policy(self.file, expected, self.task, self.world, self.episode)

    def init(self, key: Array, spec: Spec) -> tuple[()]:
        """No parameters of its own."""
        return ()

    def mean(self, params: Any, x: Array) -> Array:
        """The action [m] without noise, at x [n]."""
        return self.policy.mean(self.load(), x)

    def sample(self, params: Any, x: Array, noise: Array) -> tuple[Array, Array]:
        """The action [m] for noise [m] ~ N(0, I), and its log-density []."""
        return self.policy.sample(self.load(), x, noise)

    def variance(self, params: Any, x: Array) -> Array:
        """Variance [m] of the action at x [n]."""
        return self.policy.variance(self.load(), x)
