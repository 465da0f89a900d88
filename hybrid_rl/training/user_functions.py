"""A check of a reward or a constraint of the user's; those of this library have tests."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.envs.indices import check as check_indices
from hybrid_rl.errors import FAULTS, SourceOf, blame
from hybrid_rl.training import pairs
from hybrid_rl.types import Spec

METHODS = {"reward": "reward_of", "constraint": "excess"}  # of (x [o], u [m], after [o]) -> []


def check(name: str, part: Any, spec: Spec) -> None:
    """Trace and try the method of `part`, an episode's reward or constraint; None is none.

    Raises:
        ValueError: in one line, if it has none, fails, gives something else than a number, or an
            index in it is out of range.
    """
    what = f"{name}={type(part).__name__}: "
    if name == "reward" and part is not None and not hasattr(part, METHODS[name]):
        raise ValueError(f"{what}has no reward_of; a model of it is reward_model")
    if part is None or type(part).__module__.startswith("hybrid_rl."):
        return
    SourceOf(part).takes(METHODS[name], "x", "u", "after")
    what += f"{METHODS[name]}: "
    call, rng, sizes = getattr(part, METHODS[name]), np.random.default_rng(0), (spec.obs, spec.act)
    x, u = (rng.normal(size=(2, size)).astype(np.float32) for size in sizes)
    try:
        with pairs.refuse():
            got = jax.eval_shape(call, x[0], u[0], x[1])
        check_indices(call, (x[0], u[0], x[1]), (x[1], u[1], x[0]))
    except FAULTS as error:
        raise ValueError(what + blame(error)) from error
    if getattr(got, "shape", None) != () or not jnp.issubdtype(got.dtype, jnp.floating):
        gives = f"{got.dtype}{list(got.shape)}" if hasattr(got, "shape") else type(got).__name__
        remedy = "sum it, or take its entry; a whole number is no float"
        raise ValueError(f"{what}gives {gives}; it must be float32[]: {remedy}")
