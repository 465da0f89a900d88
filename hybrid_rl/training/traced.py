"""Calls of parts of the user's, traced by JAX: shapes, and errors that name the user's line."""

import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import partial
from typing import Any, Protocol

import jax
import numpy as np

from hybrid_rl import protocols
from hybrid_rl.errors import FAULTS, PartError, SourceOf, UsageError, one_line, ours, user_line
from hybrid_rl.training import pairs

OTHERS = {"hybrid_rl", "jax", "jaxlib", *sys.stdlib_module_names}  # packages


def trace(part: Any, method: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """Shapes of what `function` returns, which belongs to `method` of `part`, traced twice.

    Raises:
        PartError: if the two differ, as NumPy or Python drew numbers.
    """

    def judged(*arguments: Any) -> Any:
        result = function(*arguments)
        metrics = result[-1] if isinstance(result, tuple) else None
        for name, value in metrics.items() if isinstance(metrics, Mapping) else ():
            if not isinstance(value, (jax.Array, np.generic, np.ndarray, int, float)):
                line = f"metric {name} is {words(value)}; it must be a number, float32[]"
                raise PartError(f"{SourceOf(part).at(method)}: {line}")
        return result

    programs = [jax.jit(partial(judged)) for _ in range(2)]  # two functions: neither is kept
    both = [call(part, method, each.trace, *arguments) for each in programs]
    first, second = (f"{each.jaxpr}{[*map(str, each.jaxpr.consts)]}" for each in both)
    if of_user(part) and first != second:
        raise PartError(
            f"{SourceOf(part).at(method)}: gives other numbers when it is traced again: what NumPy "
            "or Python draws is a constant of the compiled program; use jax.random, with the key"
        )
    return both[0].out_info


def shapes(part: Any, method: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """Shapes of what `function` returns."""
    return call(part, method, jax.eval_shape, function, *arguments)


def call(part: Any, method: str, function: Callable[..., Any], *arguments: Any) -> Any:
    """What `function` returns; its errors name the user's part and the line.

    A ValueError that this package raised says what to change; the user's part comes after it.
    """
    mine = SourceOf(next(users(part), part))
    try:
        with pairs.refuse():
            return function(*arguments)
    except UsageError:
        raise
    except FAULTS as error:
        line = user_line(error)
        if line is None and isinstance(error, AttributeError) and of_user(error.obj):
            line = f"{SourceOf(error.obj).at()} has no {error.name}{_where(error.name, error.obj)}"
        where = f"in {type(part).__name__}.{method}"
        if line is None and isinstance(error, ValueError) and ours(error):
            raise PartError(f"{error}; {where}, with {mine.at()}") from error
        line = line or f"{mine.at()}: {one_line(error)}"
        raise PartError(f"{line.rstrip('.')}; {where}") from error


def _where(method: str | None, part: Any) -> str:
    """The protocols that say what a method is; if there are some, those that lack no other."""
    kinds = {name: getattr(protocols, name) for name in protocols.__all__}
    has = {
        name: {*dir(kind), *getattr(kind, "__annotations__", ())} for name, kind in kinds.items()
    }
    names = [name for name in has if method in has[name]]
    only = {*dir(part), *dir(Protocol), method}
    names = [name for name in names if has[name] <= only] or names
    return f"; see {', '.join(f'protocols.{name}' for name in names)}" if names else ""


def of_user(part: Any) -> bool:
    """Whether the class of a part is of the user's code."""
    kind = part if isinstance(part, type) else type(part)
    return kind.__module__.partition(".")[0] not in OTHERS


def users(part: Any) -> Iterator[Any]:
    """The parts of the user's in a part, itself first; of worlds none."""
    return filter(of_user, parts(part))


def parts(part: Any) -> Iterator[Any]:
    """The parts in a part, itself first; of worlds none."""
    if isinstance(part, list | tuple | dict):
        for each in part.values() if isinstance(part, dict) else part:
            yield from parts(each)
    elif is_dataclass(part) and not hasattr(part, "reset"):
        yield part
        for field in fields(part):
            yield from parts(getattr(part, field.name, None))


def needs_world(controller: Any) -> bool:
    """Whether a controller plans from the state of the world, where a model in it starts."""
    return any(hasattr(each, "start") for each in parts(controller))


def words(value: Any) -> str:
    """float32[2], or the kind of a Python value."""
    if hasattr(value, "shape") and hasattr(value, "dtype"):
        return f"{value.dtype}{list(value.shape)}"
    return "None" if value is None else f"a {type(value).__name__}"


def leaves(tree: Any) -> dict[str, str]:
    """Path of each leaf -> its type, such as float32[2]."""
    paths = jax.tree_util.tree_leaves_with_path(tree)
    return {jax.tree_util.keystr(path): words(leaf) for path, leaf in paths}
