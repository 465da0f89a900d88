"""Parts check their own fields: what a field accepts is declared beside it.

    @part
    class Noise:
        std: Positive = 0.3
        order: Literal["zero", "cubic"] = "cubic"
        hidden: tuple[Count, ...] = (256, 256)

Noise(std=0.0) raises `Noise: std=0.0: must be above 0`; a run names the key of its configuration
instead, `proposal.std=0.0: must be above 0`. Lists become tuples, so that parts can be hashed.
In a field of floats whole numbers become floats, so that all values give arrays of one type.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from types import NoneType, UnionType
from typing import (
    Annotated,
    Any,
    Literal,
    Self,
    TypeVar,
    Union,
    dataclass_transform,
    get_args,
    get_origin,
)

import numpy as np

Class = TypeVar("Class", bound=type)
LARGEST = 2**30  # whole number of a field: sums of two of them fit 32 bits


class FieldError(ValueError):
    """A field of a part is out of its range: its path, its value, and what that must be.

    The path is the field's name, and grows by `at` to its key in a configuration. lacks: the method
    that the value should have, if that is what is wrong.
    """

    def __init__(self, part: Any, name: str, must: str, lacks: str = "") -> None:
        self.path, self.value, self.must = name, as_yaml(getattr(part, name)), must
        self.lacks, self.kind = lacks, type(part).__name__
        super().__init__(f"{self.kind}: {self.line}")

    @property
    def line(self) -> str:
        """KEY=VALUE: what it must be."""
        return f"{self.path}={self.value}: {self.must}"

    def at(self, key: str) -> Self:
        """This error, of the part at a key of a configuration."""
        self.path = f"{key}.{self.path}"
        self.args = (self.line,)
        return self


@dataclass(frozen=True)
class Must:
    """A rule for the values of a field, and the words of its error."""

    hold: Callable[[Any], bool]
    words: str
    has: str = ""  # the method that the value must have; empty: another rule
    of: tuple[float, ...] = ()  # all values, where there are few

    def __repr__(self) -> str:  # in the signatures that `help` prints
        return self.words


def has(method: str, words: str) -> Must:
    """The rule that a value has this method; `words` is the whole message if it does not."""
    return Must(lambda part: hasattr(part, method), words, method)


def among(*values: float) -> Must:
    """The rule that a value is one of these; for words there is Literal."""
    return Must(lambda x: x in values, f"be {' or '.join(map(str, values))}", of=values)


NO_PART = bool | int | float | str | list | tuple | Mapping


def _whole(value: Any) -> bool:
    return hasattr(value, "__index__") and not isinstance(value, bool)


def _listed(value: Any) -> bool:
    """Whether a value can become a tuple; an array without axes is a number."""
    return (
        isinstance(value, Iterable)
        and not isinstance(value, str | Mapping)
        and bool(getattr(value, "shape", True))
    )


Count = Annotated[int, Must(lambda n: _whole(n) and n >= 1, "be a whole number, 1 or more")]
Several = Annotated[int, Must(lambda n: _whole(n) and n >= 2, "be a whole number, 2 or more")]
Natural = Annotated[int, Must(lambda n: _whole(n) and n >= 0, "be a whole number, 0 or more")]
Positive = Annotated[float, Must(lambda x: x > 0, "be above 0")]
NotNegative = Annotated[float, Must(lambda x: x >= 0, "be 0 or more")]
Share = Annotated[float, Must(lambda x: 0 < x <= 1, "lie in (0, 1]")]
Inside = Annotated[float, Must(lambda x: 0 < x < 1, "lie in (0, 1)")]
Discount = Annotated[float, Must(lambda x: 0 <= x < 1, "lie in [0, 1)")]
Fraction = Annotated[float, Must(lambda x: 0 <= x <= 1, "lie in [0, 1]")]
Signed = Annotated[float, Must(lambda x: -1 <= x <= 1, "lie in [-1, 1]")]
FILLED = Must(lambda values: len(values) > 0, "have one entry or more")  # a rule of lists
Strengths = Annotated[tuple[NotNegative, ...], FILLED]  # factors on the actions of a policy


@dataclass_transform(frozen_default=True)
def part(cls: Class) -> Class:
    """Make a class a frozen dataclass that checks its fields before its own `__post_init__`.

    Creating one raises FieldError, a ValueError, if a field is out of its range.
    """
    own: Any = cls.__dict__.get("__post_init__")

    def checked(self: Any) -> None:
        _check(self)
        if own is not None:
            own(self)

    if own is not None or not hasattr(cls, "__post_init__"):
        cls.__post_init__ = checked
    return dataclass(frozen=True)(cls)


def plain(kind: Any) -> Any:
    """A type without its ranges: `int` for `Count`."""
    return get_args(kind)[0] if get_origin(kind) is Annotated else kind


def choices(kind: Any) -> tuple[Any, ...]:
    """The types that a field accepts: those of a union, else its only one."""
    return get_args(kind) if get_origin(kind) in (Union, UnionType) else (kind,)


def _check(self: Any) -> None:
    """Make tuples, and raise FieldError for a field that is out of its range."""
    for field in fields(self):
        if isinstance(field.type, str):
            where = f"{type(self).__name__}.{field.name}"
            words = "@part reads types; remove `from __future__ import annotations`"
            raise TypeError(f"{where}: {words}")
        kinds = [kind for kind in choices(field.type) if kind is not NoneType]
        value = getattr(self, field.name)
        if value is None and len(kinds) < len(choices(field.type)):
            continue
        for kind in kinds:
            if get_origin(plain(kind)) is tuple:
                if not _listed(value) and len(kinds) > 1:
                    continue  # has the rule of a number
                value = _tuples(plain(kind), value)
                object.__setattr__(self, field.name, value)
            elif isinstance(value, tuple) and len(kinds) > 1:
                continue  # has the rule of its entries
            null = ", or null" if len(kinds) < len(choices(field.type)) else ""
            check(self, field.name, kind, null)
            value = _number(kind, value)
            object.__setattr__(self, field.name, value)


def method_of(kind: Any) -> str:
    """The method that a value of this type must have; empty: none."""
    return get_args(kind)[1].has if get_origin(kind) is Annotated else ""


def check(part: Any, name: str, kind: Any, null: str = "") -> None:
    """Raise FieldError if the value of a field breaks the rule of an annotated type."""
    if wrong := _wrong(kind, getattr(part, name)):
        missing = method_of(kind)
        raise FieldError(part, name, wrong if missing else wrong + null, missing)


def _wrong(kind: Any, value: Any) -> str:
    """What is wrong with a value of this type, in words; "" if nothing is."""
    of = get_args(kind)
    if get_origin(kind) is Annotated:
        must: Must = of[1]
        try:
            holds = bool(must.hold(value)) and not (
                of[0] in (int, float) and isinstance(value, bool)
            )
        except (TypeError, ValueError):  # a word or an array in a list of numbers, say
            holds = False
        if holds and of[0] is int and value > LARGEST:
            return f"must be at most {LARGEST}"
        wrong = must.words if must.has else f"must {must.words}"
        return _wrong(of[0], value) if holds else wrong
    if getattr(kind, "_is_protocol", False):
        return "must be a part" if isinstance(value, NO_PART) else ""
    if get_origin(kind) is Literal:
        return "" if value in of else f"choose one of {', '.join(map(str, of))}"
    if get_origin(kind) is not tuple:
        return ""
    if not isinstance(value, tuple):
        return "must be a list"
    each = of[:1] * len(value) if of[-1] is Ellipsis else of
    if len(each) != len(value):
        return f"must have {len(each)} entries"
    wrong = next(filter(None, map(_wrong_entry, each, value)), "")
    return "must be a list of lists" if wrong == "must be a list" else wrong


def _wrong_entry(kind: Any, value: Any) -> str:
    """What is wrong with an entry of a list; one without a rule of its own is a number."""
    if kind is int:
        return "" if _whole(value) else "must hold whole numbers"
    if kind is float:
        kind = Annotated[float, Must(math.isfinite, "hold finite numbers")]
    return _wrong(kind, value)


def _tuples(kind: Any, value: Any) -> Any:
    """A value of this type with tuples for its lists and arrays."""
    if get_origin(kind) is not tuple or not _listed(value):
        return value
    return tuple(_tuples(get_args(kind)[0], each) for each in value)


def _number(kind: Any, value: Any) -> Any:
    """A value of this type, with floats for whole numbers where the type has floats."""
    of = plain(kind)
    if get_origin(of) is tuple and isinstance(value, tuple):
        return tuple(_number(get_args(of)[0], each) for each in value)
    return float(value) if of is float and type(value) is int else value


def as_yaml(value: Any) -> Any:
    """A value as configurations write it."""
    if is_dataclass(value):
        return type(value).__name__
    value = value.tolist() if isinstance(value, np.ndarray) else value
    if isinstance(value, tuple | list):
        return [as_yaml(each) for each in value]
    return {"None": "null", "True": "true", "False": "false"}.get(str(value), value)
