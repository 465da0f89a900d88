"""Indices out of range, which JAX clamps: x[99] of 17 numbers is the last of them.

Source: JAX's documentation, "Sharp bits: out-of-bounds indexing", "checkify".
"""

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import jax
from jax.experimental import checkify

CLAMPED = "JAX takes the nearest entry without a word"


def check(call: Callable[..., Any], *examples: tuple[Any, ...]) -> None:
    """Call it with each of `examples`, in one compiled program.

    Only an index that is the same wrong one in all of them counts, as one that follows from the
    state may be meant to be clamped. Slices, which stop at the end as NumPy's do, are not found.

    Raises:
        IndexError: with the user's lines in its traceback.
    """
    found: list[Exception] = []
    with suppress(Exception):  # of what checkify cannot transform
        checked = jax.jit(checkify.checkify(call, errors=checkify.index_checks))
        for each in examples:
            error, _ = checked(*each)
            try:
                error.throw()
            except checkify.JaxRuntimeError as wrong:
                found.append(wrong)
    if len(found) == len(examples) and len({*map(str, found)}) == 1:
        line, cause = str(found[0]).strip().rstrip("."), found[0].__cause__
        raise IndexError(f"{line}; {CLAMPED}").with_traceback(cause and cause.__traceback__)
