"""Values of pages: short expressions over the JSON of docs/results.

A path in quotes, FILE/STEP/..., is what stands there in docs/results/FILE.json. A step is a key, an
index, the label (name, task, metric) of a row or of a figure's line, KEY=VALUE of a row, * (of each
row), and last, of a line, @X: its seeds [S] at X (@end: at its last X). `FUNCTIONS` take paths and
numbers, and so does arithmetic:

    "light_run/wall_s"    100 * mean("failures/low")    band("hybrid_hopper/sac@50000")
"""

import ast
import json
import operator
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import binomtest, mannwhitneyu, norm

from hybrid_rl.analysis.curves import RESAMPLES, improvement
from hybrid_rl.analysis.curves import iqm as iqm_of

RESULTS = Path(__file__).resolve().parents[2] / "docs" / "results"
NAMES = ("label", "name", "task", "metric")  # keys that name a row
BAND = {"iqm", "low", "high"}  # keys of what is read as three numbers


@cache
def read(name: str) -> Any:
    """docs/results/NAME.json."""
    return json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))


@cache
def at(path: str) -> Any:
    """What stands at a path: a number, an array of them, text, or a line of a figure."""
    way, _, x = path.partition("@")
    name, *steps = way.split("/")
    found = _follow(read(name), steps)
    if isinstance(found, list) and found and isinstance(found[0], dict):
        if len(found) > 1:
            raise LookupError(f"{path}: {len(found)} rows; a further step must choose one")
        found = found[0]
    if x and isinstance(found, dict):
        return np.array(found["each"], float)[:, -1 if x == "end" else found["x"].index(float(x))]
    if isinstance(found, dict) and not BAND - found.keys() and "x" not in found:
        return np.array([found[key] for key in ("iqm", "low", "high")])
    return _array(found) if isinstance(found, list) else found


def _follow(data: Any, steps: list[str]) -> Any:
    """A step may have slashes in it: it is the shortest one that leads anywhere."""
    if not steps:
        return data
    if steps[0] == "*":
        return [_follow(one, steps[1:]) for one in data]
    for count in range(1, len(steps) + 1):
        try:
            found = _step(data, "/".join(steps[:count]))
        except (LookupError, ValueError):
            continue
        return _follow(found, steps[count:])
    if isinstance(data, dict) and "curves" in data:
        return _follow(data["curves"], steps)
    if isinstance(data, list) and len(data) == 1:  # one row has been chosen
        return _follow(data[0], steps)
    raise LookupError(f"{'/'.join(steps)}: not in {list(data)[:9]}")


def _step(data: Any, step: str) -> Any:
    """A key or an index; of rows those that the step names."""
    if isinstance(data, dict):
        return data[step]
    key, equals, value = step.partition("=")
    rows = [one for one in data if isinstance(one, dict)]
    found = [one for one in rows if step in [one.get(name) for name in NAMES]]
    if not found and equals:
        found = [one for one in rows if str(one.get(key)) == value]
    return found or data[int(step)]


def band(x: Any) -> tuple[float, float, float]:
    """IQM over [n], and its 95% bootstrap band."""
    return _band(np.asarray(x, float).tobytes())


@cache
def _band(x: bytes) -> tuple[float, float, float]:
    each = np.frombuffer(x)
    draws = np.random.default_rng(0).integers(len(each), size=(RESAMPLES, len(each)))
    ((low,), (high,)) = np.percentile(iqm_of(each[draws.T][..., None]), [2.5, 97.5], axis=0)
    return float(iqm_of(each)), float(low), float(high)


def area(line: dict[str, Any], end: float | None = None) -> np.ndarray:
    """[S] mean of each seed's line from its first x on, up to `end`."""
    x, each = np.array(line["x"]), np.array(line["each"])
    included = x <= (x[-1] if end is None else end)
    x, each = x[included], each[:, included]
    return np.trapezoid(each, x, axis=1) / (x[-1] - x[0]) if len(x) > 1 else each[:, 0]


def ahead(x: Any, y: Any) -> list[float]:
    """[%] of pairs in which x is greater, and its band."""
    return [100 * part for part in improvement(x, y)]


def p_within(*pairs: Any) -> float:
    """Two-sided p of x1, y1, x2, y2, ...: Mann-Whitney's test within each pair, taken together.

    Source: van Elteren 1960, for pairs of equal sizes.
    """
    excess = variance = 0.0
    for x, y in zip(map(np.asarray, pairs[::2]), map(np.asarray, pairs[1::2]), strict=True):
        n, m = len(x), len(y)
        excess += float(mannwhitneyu(x, y).statistic) - n * m / 2
        variance += n * m * (n + m + 1) / 12
    return float(2 * norm.sf(abs(excess) / np.sqrt(variance)))


def reached(evaluations: dict[str, list[float]], aim: float) -> float:
    """The first of the decisions, keys of the evaluations [S], whose IQM is `aim`; or infinity."""
    found = [int(n) for n, each in evaluations.items() if iqm_of(np.array(each)) >= aim]
    return min(found, default=np.inf)


def _iqms(line: dict[str, Any]) -> np.ndarray:
    """[G] IQM over the seeds."""
    return iqm_of(np.array(line["each"]))


def _less(x: np.ndarray, y: np.ndarray) -> tuple[int, int]:
    """In how many pairs x is less, and in how many the two differ."""
    return int((x < y).sum()), int((x != y).sum())


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "ahead": ahead,
    "area": area,
    "band": band,
    "count": lambda x: np.asarray(x).size,
    "first": lambda x, n: x[: int(n)],
    "iqm": lambda x: float(iqm_of(np.asarray(x))),
    "last": lambda x, n: x[..., -int(n) :],
    "join": lambda *x: np.concatenate(x),
    "max": lambda *x: max(np.max(one) for one in x),
    "mean": np.mean,
    "median_range": lambda x: [np.median(x), np.min(x), np.max(x)],
    "means": lambda x: np.mean(x, axis=1),  # of each row
    "median": np.median,
    "min": lambda *x: min(np.min(one) for one in x),
    "peak": lambda line: float(np.max(_iqms(line))),  # the greatest IQM of a line
    "peak_at": lambda line: line["x"][np.argmax(_iqms(line))],
    "p": lambda x, y: float(mannwhitneyu(x, y).pvalue),  # two-sided
    "p_within": p_within,
    "range": lambda x: [np.mean(x), np.min(x), np.max(x)],  # mean, lowest and highest
    "reached": reached,
    "sign": lambda x, y: float(binomtest(*_less(x, y)).pvalue),  # p of the sign test, of pairs
    "sort": np.sort,
    "sum": np.sum,
}
OPERATORS: dict[type, Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Lt: operator.lt,
    ast.GtE: operator.ge,
    ast.USub: operator.neg,
}


def evaluated(expression: str) -> list[float]:
    """The numbers of an expression, in order."""
    try:
        found = _value(ast.parse(expression.strip(), mode="eval").body)
        return [float(one) for one in np.concatenate([np.ravel(part) for part in _parts(found)])]
    except (LookupError, SyntaxError, TypeError, ValueError, OSError) as error:
        raise ValueError(f"{expression.strip()}: {error}") from error


def _parts(found: Any) -> Any:
    return found if isinstance(found, tuple) else (found,)


def _value(node: ast.AST) -> Any:
    match node:
        case ast.Constant(value=str(path)):
            return at(path)
        case ast.Constant(value=int() | float() as number):
            return number
        case ast.Tuple(elts=nodes):
            return tuple(part for one in nodes for part in _parts(_value(one)))
        case ast.Call(func=ast.Name(id=name), args=nodes) if name in FUNCTIONS:
            return FUNCTIONS[name](*map(_value, nodes))
        case ast.BinOp(left=left, op=sign, right=right) if type(sign) in OPERATORS:
            return OPERATORS[type(sign)](_array(_value(left)), _array(_value(right)))
        case ast.Compare(left=left, ops=[sign], comparators=[right]) if type(sign) in OPERATORS:
            return OPERATORS[type(sign)](_array(_value(left)), _array(_value(right)))
        case ast.UnaryOp(op=sign, operand=operand) if type(sign) in OPERATORS:
            return OPERATORS[type(sign)](_array(_value(operand)))
    raise ValueError(f"use {', '.join(FUNCTIONS)}, paths, numbers and + - * / < >=")


def _array(found: Any) -> Any:
    """An array of a list, or the number; null is infinite: what never happened."""
    if not isinstance(found, list | tuple):
        return found
    each = np.array(found, float)
    return np.where(np.isnan(each), np.inf, each)
