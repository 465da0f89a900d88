"""A trained policy from a file: a teacher, or a fixed controller.

The file is a NumPy .npz without pickles, with the header of core/archive and every array of the
policy's parameters by its path, such as policy/trunk/params/Dense_0/kernel.
`python -m hybrid_rl.demonstrate run=DIR policy=FILE` writes it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core import archive
from hybrid_rl.protocols import Env, Policy
from hybrid_rl.types import PyTree, Spec

WRITE = "`python -m hybrid_rl.demonstrate run=DIR policy=FILE` writes one"


def _name(path: Any) -> str:
    """The name of the parameter at `path` in the file."""
    return "/".join(["policy", jax.tree_util.keystr(path, simple=True, separator="/")])


def save(file: Path | str, task: str, spec: Spec, params: PyTree) -> None:
    """Write the parameters of a policy for `task`, whose decisions have `spec`.

    Raises:
        ValueError: for parameters that are not finite.
    """
    leaves = jax.tree_util.tree_leaves_with_path(params)
    arrays = {_name(path): np.asarray(leaf) for path, leaf in leaves}
    _check_finite(f"policy={file}:", arrays)
    archive.write(file, task, spec, arrays)


def _check_finite(prefix: str, arrays: Mapping[str, np.ndarray]) -> None:
    """Raise ValueError for an array that is not finite."""
    for name, array in arrays.items():
        if not np.isfinite(array).all():
            raise ValueError(f"{prefix} {name} is not finite")


@dataclass(frozen=True)
class TrainedPolicy:
    """`policy` with the parameters in `file`, which must be of `task` in `world`.

    Its methods ignore the parameters that they get, so it can act where another policy learns.

    Raises:
        ValueError: for an unusable file, or one of another task or another policy.
    """

    policy: Policy
    file: str
    task: str
    world: Env
    episode: Mapping[str, int] | None = None  # with `action_repeat`; None: 1

    def __post_init__(self) -> None:
        """Check the file."""
        self.load()

    def load(self) -> PyTree:
        """The parameters of `policy`, as they were saved."""
        prefix, spec = f"policy.file={self.file}:", self.world.spec
        arrays = archive.read(prefix, self.file, hint=WRITE)
        archive.check_task(prefix, arrays, self.task, self.world, self.episode)
        expected = jax.eval_shape(lambda: self.policy.init(jax.random.key(0), spec))
        leaves, tree = jax.tree_util.tree_flatten_with_path(expected)
        shapes = {_name(path): leaf.shape for path, leaf in leaves}
        for name in sorted({*shapes, *arrays} - {*archive.HEADER}):
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
