"""A function of JAX as straight-line JavaScript: one statement for each number that it computes.

    w = clip(a, -1, 1)                      const t1 = Math.max(-1.0, a[0]);
    r = dx / dt - 0.1 |w|^2         ->      const t2 = Math.min(1.0, t1);
                                            ...

The function is traced, and each of its arrays becomes an array of JavaScript's expressions. What
moves entries (slices, concatenations, ...) is done by JAX itself on the indices of these entries;
what computes becomes a statement. MuJoCo's steps (`envs/mujoco/native.py`) become a call of
`physics(x, n, names)`, with x = [qpos, qvel, act, warmstart, ctrl] and the names of the fields of
MjData, if any, that follow the state. JavaScript computes in doubles.
"""

import json
from collections.abc import Callable, Sequence
from functools import reduce
from typing import Any

import jax
import numpy as np
from jax.extend import core

from hybrid_rl.envs.mujoco import mjcf, native

MOVES = {
    *("slice", "squeeze", "concatenate", "broadcast_in_dim", "reshape", "split", "stack"),
    *("unstack", "transpose", "rev", "expand_dims", "gather", "dynamic_slice", "copy"),
}
INLINED = {"jit", "pjit", "closed_call", "custom_jvp_call", "custom_vjp_call"}
INDEXED = {"gather", "dynamic_slice"}  # their first operand moves, the others say to where
ENTRYWISE = {
    "add": "{} + {}",
    "sub": "{} - {}",
    "mul": "{} * {}",
    "div": "{} / {}",
    "rem": "{} % {}",
    "neg": "-{}",
    "square": "{0} * {0}",
    "max": "Math.max({}, {})",
    "min": "Math.min({}, {})",
    "clamp": "Math.min(Math.max({1}, {0}), {2})",
    "pow": "Math.pow({}, {})",
    "atan2": "Math.atan2({}, {})",
    "rsqrt": "1 / Math.sqrt({})",
    "is_finite": "Number.isFinite({})",
    "select_n": "{0} ? {2} : {1}",
    "eq": "{} == {}",
    "ne": "{} != {}",
    "lt": "{} < {}",
    "le": "{} <= {}",
    "gt": "{} > {}",
    "ge": "{} >= {}",
    "and": "{} & {}",
    "or": "{} | {}",
    "not": "!{}",
}
NAMED = "abs acosh asinh atanh cos cosh exp expm1 floor log log1p sign sin sinh sqrt tan tanh"
ENTRYWISE |= {name: f"Math.{name}({{}})" for name in NAMED.split()}
REDUCED = {"sum": "add", "max": "max", "min": "min", "and": "and", "or": "or", "prod": "mul"}


class Program:
    """Statements of JavaScript, as they are written."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.assets: dict[str, None] = {}  # of MuJoCo, in order

    def function(self, f: Callable[..., Any], names: Sequence[str], like: Sequence[Any]) -> Any:
        """The outputs of `f`, arrays of expressions, after the statements that compute them.

        names: JavaScript's arrays of the arguments; each is flat, with one entry per number.
        like: arrays with their shapes.
        """
        traced, shape = jax.make_jaxpr(f, return_shape=True)(*like)
        inputs: list[np.ndarray] = []
        for name, tree in zip(names, like, strict=True):
            i = 0
            for leaf in jax.tree.leaves(tree):
                inputs.append(_symbols([f"{name}[{i + k}]" for k in range(leaf.size)], leaf.shape))
                i += leaf.size
        outputs = [_text(each) for each in self._run(traced, inputs)]
        return jax.tree.unflatten(jax.tree.structure(shape), outputs)

    def _run(self, closed: Any, inputs: Sequence[np.ndarray]) -> list[np.ndarray]:
        """The outputs of a traced function: numbers where they are constant, else expressions."""
        jaxpr = closed.jaxpr
        known: dict[Any, Any] = dict(zip(jaxpr.constvars, closed.consts, strict=True))
        known |= dict(zip(jaxpr.invars, inputs, strict=True))

        def value(atom: Any) -> np.ndarray:
            return np.asarray(atom.val if isinstance(atom, core.Literal) else known[atom])

        for equation in jaxpr.eqns:
            results = self._equation(equation, [value(atom) for atom in equation.invars])
            known |= dict(zip(equation.outvars, results, strict=True))
        return [value(atom) for atom in jaxpr.outvars]

    def _equation(self, equation: Any, inputs: list[np.ndarray]) -> list[np.ndarray]:
        """The results of one operation."""
        name, params = equation.primitive.name, equation.params
        shapes = [each.aval.shape for each in equation.outvars]
        if name == "platform_index":
            return [np.array(["cpu" in (each or ()) for each in params["platforms"]]).argmax()]
        if name == "cond" and inputs[0].dtype != object:
            return self._run(params["branches"][int(inputs[0])], inputs[1:])
        if name in INLINED:
            return self._run(params.get("jaxpr") or params["call_jaxpr"], inputs)
        if all(each.dtype != object for each in inputs):
            results = equation.primitive.bind(*inputs, **params)
            many = equation.primitive.multiple_results
            return [np.asarray(each) for each in (results if many else [results])]
        if name == "ffi_call":
            return [self._physics(params["target_name"], inputs[0], shapes[0])]
        if name in MOVES:
            return _moved(equation, inputs)
        if name == "convert_element_type":
            return [self._converted(inputs[0], np.dtype(params["new_dtype"]))]
        if name == "integer_pow":
            return [self._entrywise(f"Math.pow({{}}, {params['y']})", inputs, shapes[0])]
        if name in ENTRYWISE:
            return [self._entrywise(ENTRYWISE[name], inputs, shapes[0])]
        if name.startswith("reduce_") and name[7:] in REDUCED:
            form = ENTRYWISE[REDUCED[name[7:]]]
            axes = params["axes"]
            first = np.moveaxis(inputs[0], axes, range(len(axes))).reshape(-1, *shapes[0])
            each = [np.asarray(entry, object) for entry in first]
            return [reduce(lambda a, b: self._entrywise(form, [a, b], shapes[0]), each)]
        raise ValueError(f"{name}: has no equivalent in scripts/browser/javascript.py")

    def _entrywise(
        self, form: str, inputs: Sequence[np.ndarray], shape: tuple[int, ...]
    ) -> np.ndarray:
        """The names of statements, one for each entry of the result."""
        flat = [np.broadcast_to(_text(each), shape).ravel() for each in inputs]
        return _symbols(
            [self._statement(form.format(*each)) for each in zip(*flat, strict=True)], shape
        )

    def _converted(self, x: np.ndarray, dtype: np.dtype) -> np.ndarray:
        """`x` as numbers of another kind; true and false count as 1 and 0 in JavaScript, too."""
        form = {"b": "{} != 0", "f": "+{}"}.get(dtype.kind, "Math.trunc({})")
        return self._entrywise(form, [x], x.shape)

    def _physics(self, target: str, x: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
        """The state after MuJoCo's steps, and the fields of MjData that the call reads."""
        called = target.partition(native.NAME)[2].rsplit(":", 4)
        asset, _, steps, reads, fields = called if len(called) == 5 else ["", "", "", "", target]
        if fields:
            raise ValueError(f"{target}: is no step of a model of MuJoCo that stays as it is")
        names = [name for name in reads.split(",") if name]
        if mjcf.load(asset).nsensordata:
            if not names:
                raise ValueError(f"{asset}: has sensors, which the page does not read")
            names = ["sensordata", *names]
        self.assets[asset] = None
        inputs = [f"[{', '.join(_text(x))}]", steps]
        inputs += [json.dumps(names)] if names else []
        y = self._statement(f"physics({', '.join(inputs)})")
        return _symbols([f"{y}[{i}]" for i in range(shape[0])], shape)

    def _statement(self, expression: str) -> str:
        """The name of an expression's value."""
        self.lines.append(f"const t{len(self.lines)} = {expression};")
        return f"t{len(self.lines) - 1}"


def _symbols(names: Sequence[str] | np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Expressions as an array."""
    result = np.empty(len(names), object)
    result[:] = names
    return result.reshape(shape)


def _text(x: np.ndarray) -> np.ndarray:
    """Numbers as JavaScript's; expressions stay."""
    if x.dtype == object:
        return x
    special = {"inf": "Infinity", "-inf": "-Infinity", "nan": "NaN"}
    special |= {"True": "true", "False": "false"}
    words = [repr(number) for number in x.ravel().tolist()]
    # A negative number stands in brackets: - -1 would be read as --1 after another minus.
    words = [f"({word})" if word.startswith("-") else word for word in words]
    return _symbols([special.get(word.strip("()"), word) for word in words], x.shape)


def _moved(equation: Any, inputs: list[np.ndarray]) -> list[np.ndarray]:
    """The result of an operation that only moves entries: it is applied to their indices."""
    fixed = inputs[1:] if equation.primitive.name in INDEXED else []
    moving = [_text(each) for each in inputs[: len(inputs) - len(fixed)]]
    entries = np.concatenate([each.ravel() for each in moving])
    ends = np.cumsum([0, *(each.size for each in moving)])
    indices = [
        np.arange(begin, begin + each.size, dtype=np.int32).reshape(each.shape)
        for begin, each in zip(ends[:-1], moving, strict=True)
    ]
    results = equation.primitive.bind(
        *map(jax.numpy.asarray, [*indices, *fixed]), **equation.params
    )
    many = equation.primitive.multiple_results
    moved = map(np.asarray, results if many else [results])
    return [_symbols(entries[each.ravel()], each.shape) for each in moved]
