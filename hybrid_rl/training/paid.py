"""What a reward or a constraint of the user's must be; ours are tested."""

from typing import Any

import jax
import jax.numpy as jnp

from hybrid_rl.errors import gist, in_user_code
from hybrid_rl.types import Spec

METHODS = {"reward": "reward_of", "constraint": "excess"}  # of (x [o], u [m], after [o]) -> []


def check(name: str, part: Any, spec: Spec) -> None:
    """Trace the method of `part`, the reward or the constraint of an episode; None is none.

    Raises:
        ValueError: in one line, if it has none, fails, or gives something else than a number.
    """
    what = f"{name}={type(part).__name__}: "
    if name == "reward" and part is not None and not hasattr(part, METHODS[name]):
        raise ValueError(f"{what}has no reward_of; a model of it is reward_model")
    if part is None or type(part).__module__.startswith("hybrid_rl."):
        return
    what += f"{METHODS[name]}: "
    x, u = (jax.ShapeDtypeStruct((size,), jnp.float32) for size in (spec.obs, spec.act))
    try:
        got = jax.eval_shape(getattr(part, METHODS[name]), x, u, x)
    except Exception as error:  # whatever the user's code does
        raise ValueError(what + (in_user_code(error) or gist(error))) from error
    if getattr(got, "shape", None) != () or not jnp.issubdtype(got.dtype, jnp.floating):
        gives = f"{got.dtype}{list(got.shape)}" if hasattr(got, "shape") else type(got).__name__
        remedy = "sum it, or take its entry; a whole number is no float"
        raise ValueError(f"{what}gives {gives}; it must be float32[]: {remedy}")
