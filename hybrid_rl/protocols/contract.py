"""One contract for all parts: a protocol says methods and shapes, JAX traces a part, and compares.

    class Model(Protocol):
        @gives("params, x [n], u [m] -> x [n]")
        def step(self, params, x, u): ...

Left what a method takes, right what it returns; with sizes an array of floats, without them a tree.
A name that stood before has the same structure, shapes and types again: a state that `init` gives
comes back from `step` as it was. `metrics` are numbers by name, and a letter without a number gets
one where it first stands. Nothing is compiled. What is wrong is one line with the file of the part.
"""

import inspect
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any, NoReturn, TypeVar, get_args

import jax
import jax.numpy as jnp

from hybrid_rl.errors import PartError, SourceOf, kind_of
from hybrid_rl.fields import plain
from hybrid_rl.types import EnvState, Path, Spec

Thing = TypeVar("Thing")
TERM = re.compile(r"(\w+)( \[(.*?)\])?")
OTHERS = {"hybrid_rl", "jax", "jaxlib", *sys.stdlib_module_names}  # packages
FORM = {"obs": "o", "reward": "", "terminated": "", "truncated": ""}  # of an EnvState
FLAGS = "terminated", "truncated"
T = 5  # decisions of a path


def gives(signature: str, *entries: str) -> Callable[[Thing], Thing]:
    """Say what a method of a protocol takes and returns, and the entries that this has."""

    def mark(method: Any) -> Any:
        method.gives, method.entries = signature, entries
        return method

    return mark


@dataclass
class Contract:
    """The contract of one part: what is known by the names in the signatures of its protocol."""

    part: object
    protocol: type
    spec: Spec
    error: type[PartError] = PartError
    owner: object = None  # the part that holds it, in a field
    name: str = ""  # of that field
    values: dict[str, Any] = field(default_factory=dict)  # by name

    def __post_init__(self) -> None:
        self.source = SourceOf(self.part, self.error)
        self.sizes = {"o": self.spec.obs, "m": self.spec.act, "n": self.spec.n}
        key = jax.eval_shape(lambda: jax.random.key(0))
        self.values = {"key": key, "spec": self.spec, **self.values}
        self.given: dict[str, str] = {}  # the method that gave a value

    def check_members(self) -> None:
        """Raise PartError for a class in place of an instance, or for a member that is missing."""
        check_instance(self.part, self.error)
        for name in members(self.protocol):
            if getattr(self.part, name, self) is self:
                needs = f", which {type(self.owner).__name__}.{self.name} needs"
                line = f"{self.source.at()} has no {name}{needs if self.name else ''}"
                raise self.error(f"{line}; see protocols.{self.protocol.__name__}")

    def check(self) -> None:
        """Raise PartError for a method that gives something else.

        A method is left out if a value that it takes is not known.
        """
        self.check_members()
        for name, signature in signatures(self.protocol).items():
            if all(self._known(*term) for term in terms(signature.split("->")[0])):
                self.trace(name)

    def trace(self, name: str) -> None:
        """Compare what a method gives, traced by JAX."""
        takes, returns = map(terms, signatures(self.protocol)[name].split("->"))
        arguments = [self._value(*term) for term in takes]
        fixed = tuple(i for i, (of, _) in enumerate(takes) if of == "spec")

        def call(*given: Any) -> Any:
            result = getattr(self.part, name)(*given)
            return jax.tree.map(self._of_path, result, is_leaf=inspect.isfunction)

        trace = jax.jit(call, static_argnums=fixed).trace
        result = self.source.blamed(name, trace, *arguments).out_info
        for entry in members(self.protocol)[name].entries:
            if not (isinstance(result, Mapping) and entry in result):
                self.refuse(name, f"returned no dict with an entry {entry!r}, which is learned")
        if len(returns) == 1:
            result = (result,)
        elif not isinstance(result, tuple) or len(result) != len(returns):
            must = ", ".join(of for of, _ in returns)
            self.refuse(name, f"returned {kind_of(result)}; it must be ({must})")
        for (of, sizes), value in zip(returns, result, strict=True):
            self._judge(name, of, sizes, value)

    def refuse(self, method: str, line: str) -> NoReturn:
        """Raise PartError about a method."""
        raise self.error(f"{self.source.at(method)}: {line}")

    def _known(self, name: str, sizes: str | None) -> bool:
        if sizes is None:
            return name == "x" or name in self.values
        return all(isinstance(size, int) for size in self._shape(sizes))

    def _value(self, name: str, sizes: str | None) -> Any:
        """The value of an argument: one that is known, or floats of these sizes."""
        if sizes is None and name in self.values:
            return self.values[name]
        return jax.ShapeDtypeStruct(self._shape("n" if sizes is None else sizes), jnp.float32)

    def _shape(self, sizes: str) -> tuple[int | str, ...]:
        """Sizes in numbers; a letter without one stays."""
        return tuple(self.sizes.get(size, size) for size in filter(None, sizes.split(", ")))

    def _of_path(self, result: Any) -> Any:
        """A result; of a function of a path what it gives."""
        if not inspect.isfunction(result):
            return result
        x = self._value("x", None)
        xs = jax.tree.map(lambda leaf: jnp.zeros((T + 1, *leaf.shape), leaf.dtype), x)
        return result(Path(xs, jnp.zeros((T, self.spec.act))))

    def _judge(self, method: str, name: str, sizes: str | None, value: Any) -> None:
        """Raise PartError for a returned value of another shape or type."""
        if name == "metrics":
            got = leaves(value) if isinstance(value, Mapping) else kind_of(value)
            if isinstance(got, str) or not all(of.endswith("[]") for of in got.values()):
                self.refuse(method, f"returned metrics {got}; it must be a dict of numbers")
            return
        if name == "env":
            if not isinstance(value, EnvState):
                self.refuse(method, f"returned {kind_of(value)}; it must be an EnvState")
            for part, form in (*FORM.items(), ("metrics", None)):
                self._judge(method, part, form, getattr(value, part))
        elif sizes is not None:
            self._judge_array(method, name, sizes, value)
        if sizes is None and name in self.values:
            self._compare(method, name, value)
        elif name not in self.values:
            self.values[name], self.given[name] = value, method

    def _judge_array(self, method: str, name: str, sizes: str, value: Any) -> None:
        shape = getattr(value, "shape", None)
        if shape is not None and len(shape) == len(self._shape(sizes)):
            new = {letter: n for letter, n in zip(sizes.split(", "), shape, strict=False) if letter}
            self.sizes = {letter: n for letter, n in new.items() if letter.isalpha()} | self.sizes
        must, kind = self._shape(sizes), jnp.bool_ if name in FLAGS else jnp.floating
        if shape != must or not jnp.issubdtype(value.dtype, kind):
            must = f"{'bool' if name in FLAGS else 'float32'}[{', '.join(map(str, must))}]"
            must += f", as spec.obs is {self.spec.obs}" if name == "obs" else ""
            self.refuse(method, f"returned {name} {kind_of(value)}; it must be {must}")

    def _compare(self, method: str, name: str, value: Any) -> None:
        """Raise PartError if the value of this name was another one before."""
        first = self.values[name]
        if isinstance(first, EnvState):  # what of `info` a step leaves out stays
            value = value.replace(info={**first.info, **value.info})
        then, now = leaves(first), leaves(value)
        before = self.given.get(name, "init")
        for path in (*then, *now):
            if then.get(path) != now.get(path):
                pair = f"{now.get(path, 'nothing')}, {before} gave {then.get(path, 'nothing')}"
                self.refuse(method, f"returned {name}{path} {pair}; both must be equal")
        if jax.tree.structure(first) != jax.tree.structure(value):
            self.refuse(method, f"returned {name} of another structure than {before}")


def check_instance(part: object, error: type[PartError]) -> None:
    """Raise `error` for a class, in place of an instance of it."""
    if isinstance(part, type):
        raise error(f"{part.__module__}: {part.__name__} is a class; give {part.__name__}()")


def terms(text: str) -> list[tuple[str, str | None]]:
    """(name, sizes) of one side of a signature; no sizes: None."""
    return [(name, sizes if sized else None) for name, sized, sizes in TERM.findall(text)]


def members(protocol: type) -> dict[str, Any]:
    """Name -> method, property or annotation of what a part of this protocol has."""
    found: dict[str, Any] = {}
    for base in reversed(protocol.__mro__):
        if getattr(base, "_is_protocol", False):
            found |= {**inspect.get_annotations(base), **vars(base)}
    return {name: of for name, of in found.items() if name[0] != "_" or name == "__call__"}


def signatures(protocol: type) -> dict[str, str]:
    """Name -> what a method takes and returns."""
    has = {name: getattr(member, "gives", "") for name, member in members(protocol).items()}
    return {name: text for name, text in has.items() if text}


def parts(part: Any) -> Iterator[tuple[Any, str, Any, Any]]:
    """(owner, field, its protocol or None, part) of all parts in a part; of worlds none."""
    if isinstance(part, list | tuple | dict):
        for inner in part.values() if isinstance(part, dict) else part:
            yield from parts(inner)
    elif callable(getattr(part, "reset", None)):  # a world
        return
    elif is_dataclass(part) and not isinstance(part, type):
        for of in fields(part):
            value, kinds = getattr(part, of.name, None), [plain(of.type)]
            for kind in kinds:  # of unions and tuples, what they are of
                kinds += map(plain, get_args(kind))
            known = [kind for kind in kinds if getattr(kind, "_is_protocol", False)]
            held = value if isinstance(value, list | tuple) else (value,)
            for inner in value.values() if isinstance(value, Mapping) else held:
                if not (inner is None or isinstance(inner, bool | int | float | str)):
                    yield part, of.name, known[0] if len(known) == 1 else None, inner
                    yield from parts(inner)


def of_user(part: object) -> bool:
    """Whether the class of a part is of the user's code."""
    kind = part if isinstance(part, type) else type(part)
    return kind.__module__.partition(".")[0] not in OTHERS


def has_users(part: object) -> bool:
    """True if a part, or one in it, is of the user's code; or one of several parts in a list."""
    several = part if isinstance(part, list) else [part]
    return any(map(of_user, [*several, *(inner for _, _, _, inner in parts(part))]))


def leaves(tree: Any) -> dict[str, str]:
    """Path of each leaf -> its type, such as float32[2]."""
    paths = jax.tree_util.tree_leaves_with_path(tree)
    return {jax.tree_util.keystr(path): kind_of(leaf) for path, leaf in paths}
