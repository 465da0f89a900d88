"""Floating-point operations of a program, counted in its trace before it is compiled.

A product of matrices [a, b] and [b, c] counts 2 a b c; all else is left out. The body of a scan
counts as often as it runs, the most expensive branch of a conditional counts, and a loop
whose length is known only at run time counts once.
"""

from collections.abc import Iterator
from math import prod
from typing import Any


def operations(jaxpr: Any) -> float:
    """Operations of a jaxpr, closed or open."""
    total = 0.0
    for equation in getattr(jaxpr, "jaxpr", jaxpr).eqns:
        each = [operations(inner) for inner in _inner(equation.params.values())]
        match equation.primitive.name:
            case "dot_general":
                total += _product(equation)
            case "cond":
                total += max(each)
            case "scan":
                total += equation.params["length"] * sum(each)
            case _:
                total += sum(each)
    return total


def _inner(values: Any) -> Iterator[Any]:
    """The jaxprs among the parameters of an equation."""
    for value in values:
        if hasattr(getattr(value, "jaxpr", value), "eqns"):
            yield value
        elif isinstance(value, tuple | list):
            yield from _inner(value)


def _product(equation: Any) -> float:
    """Operations of a product: two for each entry of the result and each term of its sum."""
    (contracted, _), _ = equation.params["dimension_numbers"]
    terms = prod(equation.invars[0].aval.shape[axis] for axis in contracted)
    return 2.0 * equation.outvars[0].aval.size * terms
