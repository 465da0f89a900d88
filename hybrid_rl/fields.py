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
from numbers import Integral, Real
from types import NoneType, UnionType
from typing import (
    Annotated,
    Any,
    Literal,
    NoReturn,
    Self,
    SupportsIndex,
    TypeVar,
    Union,
    dataclass_transform,
    get_args,
    get_origin,
    get_type_hints,
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


Fail = Callable[..., NoReturn]  # the words of what is wrong, and the method that is missing
NO_PART = bool | int | float | str | list | tuple | Mapping
PLAIN = {  # type of a field -> what it accepts, its name in messages
    bool: (bool, "true or false"),
    int: (Integral, "a whole number"),
    float: (Real, "a number"),
    str: (str, "a word"),
}


def _whole(value: Any) -> bool:
    return isinstance(value, SupportsIndex) and not isinstance(value, bool)


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
    own = cls.__dict__.get("__post_init__")
    inherited = getattr(cls, "__post_init__", None)

    def checked(self: Any) -> None:
        for field in fields(self):
            object.__setattr__(self, field.name, check(self, field.name, field.type))
        if own is not None:
            own(self)

    if own is not None or inherited is None:
        cls.__post_init__ = checked
    made = dataclass(frozen=True)(cls)
    hints = get_type_hints(made, include_extras=True)
    for field in fields(made):  # a word, where a module postpones its annotations
        field.type = hints[field.name]
    return made


def plain(kind: Any) -> Any:
    """A type without its ranges: `int` for `Count`."""
    return get_args(kind)[0] if get_origin(kind) is Annotated else kind


def choices(kind: Any) -> tuple[Any, ...]:
    """The types that a field accepts: those of a union, else its only one."""
    return get_args(kind) if get_origin(kind) in (Union, UnionType) else (kind,)


def check_all(part: Any) -> Any:
    """The part; FieldError for a value that a field of it, a dataclass of any sort, refuses."""
    for field in fields(part) if is_dataclass(part) else ():
        check(part, field.name, field.type)
    return part


def check_span(part: Any) -> None:
    """FieldError unless `low` and `high` are as many numbers, one or more, each low below its high.

    Of numbers, or lists of them.
    """
    low, high = np.atleast_1d(part.low), np.atleast_1d(part.high)
    if low.shape != high.shape or not (low.size and (low < high).all()):
        raise FieldError(part, "low", f"must lie below high={as_yaml(part.high)}, number by number")


def check(part: object, name: str, kind: Any) -> Any:
    """The value of a field as its type has it: tuples for lists, floats for whole numbers.

    Raises:
        FieldError: if it breaks the rule of the type.
    """
    null = ", or null" if NoneType in choices(kind) else ""

    def fail(words: str, lacks: str = "") -> NoReturn:
        raise FieldError(part, name, words if lacks else words + null, lacks)

    return _fitted(kind, getattr(part, name), fail)


def _fitted(kind: Any, value: Any, fail: Fail, entry: bool = False) -> Any:
    """A value as this type has it; entry: of a list, whose numbers are finite."""
    kinds = [each for each in choices(kind) if each is not NoneType]
    if value is None and len(kinds) < len(choices(kind)):
        return None
    if len(kinds) > 1:  # a list has the rules of lists, another value the others
        lists = _listed(value)
        kinds = [each for each in kinds if (get_origin(plain(each)) is tuple) == lists] or kinds
    if not (entry or {*kinds} - {*PLAIN} or any(_is(kind, value) for kind in kinds)):
        fail(f"must be {' or '.join(PLAIN[kind][1] for kind in kinds)}")
    for kind in kinds:
        origin, of = get_origin(kind), get_args(kind)
        if origin is Annotated:
            if of[0] is not int:  # its rules say that it is a whole number
                value = _fitted(of[0], value, fail)
            _obey(of[1], value, fail, of[0] in (int, float))
        elif origin is Literal:
            if value not in of:
                fail(f"choose one of {', '.join(map(str, of))}")
        elif origin is tuple:
            value = _row(of, value, fail)
        elif getattr(kind, "_is_protocol", False):
            if isinstance(value, NO_PART):
                fail("must be a part")
        elif entry and kind is int and not _whole(value):
            fail("must hold whole numbers")
        elif kind is float:
            if entry and not (isinstance(value, Real) and math.isfinite(value)):
                fail("must hold finite numbers")
            value = float(value) if type(value) is int else value
    return value


def _is(kind: type, value: Any) -> bool:
    """Whether a value is of a plain type; arrays, as of a traced number, are of each."""
    if not isinstance(value, NO_PART | None):
        return True
    return isinstance(value, PLAIN[kind][0]) and (kind is bool or not isinstance(value, bool))


def _obey(must: Must, value: Any, fail: Fail, number: bool) -> None:
    """Fail for a value that breaks a rule; number: of a number, which is not too large."""
    try:
        holds = bool(must.hold(value)) and not (number and isinstance(value, bool))
    except (TypeError, ValueError):  # a word or an array in a list of numbers, say
        holds = False
    if not holds:
        fail(must.words if must.has else f"must {must.words}", must.has)
    if isinstance(value, int) and value > LARGEST:
        fail(f"must be at most {LARGEST}")


def _row(of: tuple[Any, ...], value: Any, fail: Fail) -> tuple[Any, ...]:
    """A list as a tuple; of: the types of its entries, or one of all and an Ellipsis."""
    if not _listed(value):
        fail("must be a list")
    entries = tuple(value)
    kinds = of[:1] * len(entries) if of[-1] is Ellipsis else of
    if len(kinds) != len(entries):
        fail(f"must have {len(kinds)} entries")

    def inner(words: str, lacks: str = "") -> NoReturn:
        fail("must be a list of lists" if words == "must be a list" else words, lacks)

    return tuple(_fitted(k, x, inner, True) for k, x in zip(kinds, entries, strict=True))


def as_yaml(value: Any) -> Any:
    """A value as configurations write it."""
    if is_dataclass(value):
        return type(value).__name__
    value = value.tolist() if isinstance(value, np.ndarray) else value
    if isinstance(value, tuple | list):
        return [as_yaml(each) for each in value]
    return {"None": "null", "True": "true", "False": "false"}.get(str(value), value)
