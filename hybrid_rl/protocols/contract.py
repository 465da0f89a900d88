"""One contract for all parts: a protocol says methods and shapes, JAX traces a part, and compares.

    class Model(Protocol):
        @gives("params, x [n], u [m] -> x [n]")
        def step(self, params, x, u): ...

Left what a method takes, right what it returns; with sizes an array of floats, without them a tree.
A name that stood before has the same structure, shapes and types again: a state that `init` gives
comes back from `step` as it was. `metrics` are numbers by name, and a letter without a number gets
one where it first stands. Nothing is compiled. What is wrong is one line with the file of the part.

Source for the indices: JAX's documentation, "Sharp bits: out-of-bounds indexing", "checkify".
"""

import inspect
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import fields, is_dataclass
from functools import partial
from numbers import Real
from typing import Any, TypeVar, get_args

import jax
import jax.numpy as jnp
import numpy as np
from jax.experimental import checkify

from hybrid_rl.errors import PartError, SourceOf, UsageError
from hybrid_rl.types import EnvState, Path

Thing = TypeVar("Thing")
TERM = re.compile(r"(\w+)( \[(.*?)\])?")
OTHERS = {"hybrid_rl", "jax", "jaxlib", *sys.stdlib_module_names}  # packages
SIZES = {"B": 3, "T": 5}  # of what no part says
FORM = {"obs": "o", "reward": "", "terminated": "", "truncated": ""}  # of an EnvState
FLAGS = "terminated", "truncated"
REMEDIES = {  # of a number that is none
    **{"reward": "sum it, or take its entry; a whole number is no float"},
    **dict.fromkeys(FLAGS, "write a comparison, or jnp.zeros((), bool)"),
}
DRAWN = (
    "gives other numbers when it is traced again: what NumPy or Python draws is a constant of the "
    "compiled program; use jax.random, with a key"
)


def gives(signature: str) -> Callable[[Thing], Thing]:
    """Say what a method of a protocol takes and returns."""

    def mark(method: Any) -> Any:
        method.gives = signature
        return method

    return mark


def may(**signatures: str) -> Callable[[Thing], Thing]:
    """Say what the methods take and return that a part of this protocol need not have."""

    def mark(protocol: Any) -> Any:
        protocol._may = signatures
        return protocol

    return mark


class Contract:
    """The contract of one part: values and sizes by their names in signatures."""

    def __init__(
        self,
        part: Any,
        protocol: Any,
        values: Mapping[str, Any],
        error: type[PartError] = PartError,
        owner: Any = None,
        field: str = "",
    ) -> None:
        self.part, self.protocol, self.error = part, protocol, error
        self.owner, self.field = owner, field  # that holds it
        self.source = SourceOf(part, error)
        self.values, self.sizes, self.given = dict(values), dict(SIZES), dict.fromkeys(values, "")
        spec = values["spec"]
        self.sizes |= {"o": spec.obs, "m": spec.act, "n": spec.n}
        self.values.setdefault("key", jax.eval_shape(lambda: jax.random.key(0)))

    def check_members(self) -> None:
        """Raise PartError for a class, or for a member that the part lacks or has otherwise."""
        if isinstance(self.part, type):
            line = f"{self.part.__module__}: {self.part.__name__} is a class"
            raise self.error(f"{line}; give {self.part.__name__}()")
        lacks = [name for name in members(self.protocol) if getattr(self.part, name, self) is self]
        if lacks and self.field and not of_user(self.part):  # of the library: another choice
            line = f"has no {', '.join(lacks)}, which {type(self.owner).__name__} needs"
            raise UsageError(f"{self.field}={type(self.part).__name__}: {line}; choose another one")
        for name, member in members(self.protocol).items():
            if inspect.isfunction(member):
                self.source.takes(name, *[*inspect.signature(member).parameters][1:])
            elif name in lacks:
                line = f"has no {name}; see protocols.{self.protocol.__name__}"
                raise self.error(f"{self.source.at()} {line}")

    def check(self, *names: str) -> "Contract":
        """Raise PartError for a method that gives something else; of these names, or all."""
        self.check_members()
        for name, signature in signatures(self.protocol).items():
            takes = terms(signature.split("->")[0])
            known = all(type(size) is int for _, of in takes for size in self._shape(of or ""))
            if known and name in (names or {name}) and getattr(self.part, name, None) is not None:
                self.trace(name, signature)
        return self

    def tried(self) -> None:
        """Raise PartError for an index out of range in what the user's part pays."""
        if of_user(self.part):
            rng, spec = np.random.default_rng(0), self.values["spec"]
            x, u = (rng.normal(size=(2, size)).astype(np.float32) for size in (spec.obs, spec.act))
            (name,) = signatures(self.protocol)
            check_indices(self.source, name, (x[0], u[0], x[1]), (x[1], u[1], x[0]))

    def trace(self, name: str, signature: str, twice: bool = False) -> Any:
        """Compare what a method gives, traced by JAX; the trace.

        twice: traced again, it must be the same program.
        """
        takes, returns = map(terms, signature.split("->"))
        arguments = [self.value(*term) for term in takes if term[0] != "spec"]

        def call(*given: Any) -> Any:
            left = iter(given)
            whole = [self.values["spec"] if of == "spec" else next(left) for of, _ in takes]
            result = getattr(self.part, name)(*whole)
            if len(returns) == 1:
                result = (result,)
            elif not isinstance(result, tuple) or len(result) != len(returns):
                got = f"a tuple of {len(result)}" if isinstance(result, tuple) else words(result)
                must = ", ".join(of for of, _ in returns)
                self.refuse(name, f"returned {got}; it must be ({must})")
            result = tuple(map(self._measured, result))
            for (of, sizes), value in zip(returns, result, strict=True):
                self._judge(name, of, sizes, value)
            return result

        # a world may be of another library; two functions: neither trace is kept
        ranks = "allow" if ("env", None) in returns else "raise"
        programs = [jax.jit(partial(call)) for _ in range(1 + twice)]
        with jax.numpy_rank_promotion(ranks):
            traced = [self.source.blamed(name, each.trace, *arguments) for each in programs]
        if len({program_text(each) for each in traced}) > 1:
            self.refuse(name, DRAWN)
        for (of, sizes), value in zip(returns, traced[0].out_info, strict=True):
            if of != "metrics" and (sizes is None or of not in self.values):
                self._bind(name, of, value)
        return traced[0]

    def value(self, name: str, sizes: str | None = None) -> Any:
        """The value of an argument: one that is known, or floats of these sizes."""
        if name == "path":
            x, T = self.value("x"), self.sizes["T"]
            x = jax.tree.map(lambda leaf: jax.ShapeDtypeStruct((T + 1, *leaf.shape), leaf.dtype), x)
            return Path(x, self.value("u", "T, m"))
        if sizes is None and name in self.values:
            return self.values[name]
        return jax.ShapeDtypeStruct(self._shape("n" if sizes is None else sizes), jnp.float32)

    def refuse(self, method: str, line: str) -> None:
        """Raise PartError about a method."""
        raise self.error(f"{self.source.at(method)}: {line}")

    def _shape(self, sizes: str) -> tuple[int | str, ...]:
        """[T+1, n] in numbers; a letter without one stays."""
        shape = []
        for size in filter(None, sizes.split(", ")):
            letter, plus, more = size.partition("+")
            number = self.sizes.get(letter, letter)
            shape.append(number + int(more) if plus and isinstance(number, int) else number)
        return tuple(shape)

    def _measured(self, result: Any) -> Any:
        """A result; of a function of a path what it gives."""
        if not inspect.isfunction(result):
            return result
        return result(
            jax.tree.map(lambda leaf: jnp.zeros(leaf.shape, leaf.dtype), self.value("path"))
        )

    def _judge(self, method: str, name: str, sizes: str | None, value: Any) -> None:
        """Raise PartError for a returned value of another shape or type."""
        if name == "env":
            self._judge_env(method, value)
        elif name == "metrics":
            self._judge_metrics(method, value)
        elif sizes is not None:
            for size in (size for size in sizes.split(", ") if size.isalpha()):
                if size not in self.sizes and getattr(value, "ndim", 0) == 1 + sizes.count(","):
                    self.sizes[size] = value.shape[sizes.split(", ").index(size)]
            self._judge_array(method, name, self._shape(sizes), value)

    def _judge_array(
        self, method: str, name: str, shape: tuple[int | str, ...], value: Any
    ) -> None:
        kind = jnp.bool_ if name in FLAGS else jnp.floating
        if type(value) is float and not shape and name not in FLAGS:
            return
        if is_array(value) and value.shape == shape and jnp.issubdtype(value.dtype, kind):
            return
        must = f"it must be {'bool' if name in FLAGS else 'float32'}[{', '.join(map(str, shape))}]"
        remedy = REMEDIES.get(name)
        if name == "obs":
            size = jnp.size(value) if is_array(value) else 0
            must += f", as spec.obs is {shape[0]}"
            remedy = f"return {shape[0]} numbers, or write Spec(obs={size}, ...)"
        must += f": {remedy}" if remedy else ""
        self.refuse(method, f"returned {name} {words(value)}; {must}")

    def _judge_metrics(self, method: str, metrics: Any) -> None:
        if not isinstance(metrics, Mapping):
            self.refuse(method, f"returned metrics {words(metrics)}; it must be a dict of numbers")
        for name, value in metrics.items():
            if not isinstance(value, Real) and getattr(value, "shape", None) != ():
                self.refuse(method, f"metric {name} is {words(value)}; it must be one number")

    def _judge_env(self, method: str, state: Any) -> None:
        """Raise PartError for anything but an EnvState of the spec."""
        if not isinstance(state, EnvState):
            got = f"a tuple of {len(state)}, as Gymnasium's do" if isinstance(state, tuple) else ""
            self.refuse(method, f"returned {got or words(state)}; it must be an EnvState")
        for name, sizes in FORM.items():
            self._judge_array(method, name, self._shape(sizes), getattr(state, name))
        if not isinstance(state.info, Mapping):
            self.refuse(method, f"returned info {words(state.info)}; it must be a dict")
        self._judge_metrics(method, state.metrics)

    def _bind(self, method: str, name: str, value: Any) -> None:
        """Keep a value by its name; raise PartError if it was another one before."""
        if name not in self.values:
            self.values[name], self.given[name] = value, method
            return
        first = self.values[name]
        if isinstance(first, EnvState):  # what of `info` a step leaves out stays
            value = value.replace(info={**first.info, **value.info})
        one, two = leaves(first), leaves(value)
        before = self.given[name] or "init"
        for path in (*one, *two):
            if one.get(path) != two.get(path):
                now, then = (of.get(path, "nothing") for of in (two, one))
                line = f"returned {name}{path} {now}, {before} gave {then}; both must be equal"
                self.refuse(method, line)
        if jax.tree.structure(first) != jax.tree.structure(value):
            self.refuse(method, f"returned {name} of another structure than {before}")


def terms(text: str) -> list[tuple[str, str | None]]:
    """(name, sizes) of one side of a signature; no sizes: None."""
    return [(name, sizes if sized else None) for name, sized, sizes in TERM.findall(text)]


def members(protocol: Any) -> dict[str, Any]:
    """Name -> method, property or annotation of what a part of this protocol has."""
    found: dict[str, Any] = {}
    for base in reversed(protocol.__mro__):
        if getattr(base, "_is_protocol", False):
            found |= {**inspect.get_annotations(base), **vars(base)}
    return {name: of for name, of in found.items() if name[0] != "_" or name == "__call__"}


def signatures(protocol: Any) -> dict[str, str]:
    """Name -> what a method takes and returns."""
    has = {name: getattr(member, "gives", "") for name, member in members(protocol).items()}
    return {name: text for name, text in has.items() if text} | getattr(protocol, "_may", {})


def parts(part: Any) -> Iterator[tuple[Any, str, Any, Any]]:
    """(owner, field, its protocol or None, part) of all parts in a part; of worlds none."""
    if isinstance(part, list | tuple | dict):
        for inner in part.values() if isinstance(part, dict) else part:
            yield from parts(inner)
    elif is_dataclass(part) and not isinstance(part, type) and not _is_world(part):
        for field in fields(part):
            value, kinds = getattr(part, field.name, None), [field.type]
            for kind in kinds:  # of unions, tuples and annotations, what they are of
                kinds += get_args(kind)
            known = [kind for kind in kinds if getattr(kind, "_is_protocol", False)]
            one = value if isinstance(value, list | tuple) else (value,)
            for inner in value.values() if isinstance(value, Mapping) else one:
                if not (inner is None or isinstance(inner, bool | int | float | str)):
                    yield part, field.name, known[0] if len(known) == 1 else None, inner
                    yield from parts(inner)


def _is_world(part: Any) -> bool:
    return callable(getattr(part, "reset", None))


def of_user(part: Any) -> bool:
    """Whether the class of a part is of the user's code."""
    kind = part if isinstance(part, type) else type(part)
    return kind.__module__.partition(".")[0] not in OTHERS


def has_users(part: Any) -> bool:
    """Whether a part, or one in it, is of the user's code."""
    return any(map(of_user, [part, *(inner for _, _, _, inner in parts(part))]))


def check_indices(source: SourceOf, method: str, *examples: tuple[Any, ...]) -> None:
    """Raise PartError for an index out of range, of which JAX takes the nearest entry.

    The method runs with each of `examples`, in one compiled program. Only an index that is the same
    wrong one in all of them counts, as one that follows from the state may be meant to be clamped.
    Slices, which stop at the end as NumPy's do, are not found.
    """
    found: list[Exception] = []
    with suppress(Exception):  # of what checkify cannot transform
        call = getattr(source.object, method)
        checked = jax.jit(checkify.checkify(call, errors=checkify.index_checks))
        for given in examples:
            error, _ = checked(*given)
            try:
                error.throw()
            except checkify.JaxRuntimeError as wrong:
                found.append(wrong)
    if len(found) == len(examples) and len({*map(str, found)}) == 1:
        line, cause = str(found[0]).strip().rstrip("."), found[0].__cause__
        error = IndexError(f"{line}; JAX takes the nearest entry without a word")
        source.blamed(method, _throw, error.with_traceback(cause and cause.__traceback__))


def _throw(error: Exception) -> None:
    raise error


def program_text(traced: Any) -> str:
    """The program that JAX traced, with its constants."""
    program = traced.jaxpr
    constants = "\n".join(map(str, program.consts))
    return re.sub(r" at 0x\w+", "", f"{program}\n{constants}")


def is_array(value: Any) -> bool:
    """Whether a value has a shape and a type."""
    return None not in (getattr(value, "shape", None), getattr(value, "dtype", None))


def words(value: Any) -> str:
    """float32[2], or the kind of a Python value."""
    if is_array(value):
        return f"{value.dtype}{list(value.shape)}"
    return "None" if value is None else f"a {type(value).__name__}"


def leaves(tree: Any) -> dict[str, str]:
    """Path of each leaf -> its type, such as float32[2]."""
    paths = jax.tree_util.tree_leaves_with_path(tree)
    return {jax.tree_util.keystr(path): words(leaf) for path, leaf in paths}
