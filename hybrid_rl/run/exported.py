"""Policies and planners as programs of JAX, and policies as plain layers or as a model of ONNX.

ONNX holds u = squash(W_L a(... a(W_1 (x - mean) / scale + b_1) ...) + b_L) with its numbers, or
middle + half u where the world's actions have other bounds than -1 and 1.
"""

from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.core.batching import of_words, words
from hybrid_rl.core.lifting import is_identity
from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import replacing
from hybrid_rl.networks import Perceptron, precision
from hybrid_rl.protocols import Controller
from hybrid_rl.types import Params, Spec

OPSET, IR = 17, 8  # of ONNX: runtimes refuse files that are newer than they are
FUNCTIONS = {  # lines of ONNX from z to a: those of an activation or a squashing
    **{name.lower(): f"{{a}} = {name} ({{z}})" for name in ("Relu", "Sin", "Tanh", "Elu")},
    "silu": "{a}_gate = Sigmoid ({z}) {a} = Mul ({z}, {a}_gate)",
    "clip": "{a} = Clip ({z}, low, high)",
}


def program(
    spec: Spec,
    controller: Controller,
    params: Params,
    platforms: Sequence[str] = ("cpu",),
    span: tuple[np.ndarray, np.ndarray] | None = None,
) -> jax.export.Exported:
    """The controller with `params` as a program of the form that hybrid_rl.export gives.

    span: middle [m] and half the width [m] of the actions' bounds; None: they are -1 and 1.
    """

    def scaled(u: Array) -> Array:
        return u if span is None else span[0] + span[1] * jnp.clip(u, -1.0, 1.0)

    obs = jax.ShapeDtypeStruct((spec.obs,), jnp.float32)
    if isinstance(controller, PolicyController):

        def act(obs: Array) -> Array:
            return scaled(controller.act(params, (), obs, jax.random.key(0))[0])

        return _exported(act, platforms, obs)
    first = controller.init(spec)
    packed = words((jnp.zeros((), jnp.uint32), first))

    def decide(obs: Array, state: Array, key: Array) -> tuple[Array, Array]:
        count, now = of_words(state, (jnp.zeros((), jnp.uint32), first))
        now = jax.tree.map(lambda begin, later: jnp.where(count == 0, begin, later), first, now)
        u, now, _ = controller.act(params, now, obs, jax.random.wrap_key_data(key))
        return scaled(u), words((count + 1, now))

    two = jax.ShapeDtypeStruct((2,), jnp.uint32)
    state = jax.ShapeDtypeStruct(packed.shape, jnp.uint32)
    return _exported(decide, platforms, obs, state, two)


def _exported(f: Callable[..., Any], platforms: Sequence[str], *given: Any) -> jax.export.Exported:
    """`f` of arrays of these shapes, in float32 whatever it was trained in."""
    with precision.using("float32"):
        return jax.export.export(jax.jit(f), platforms=platforms)(*given)


def layers(spec: Spec, controller: Controller, params: Params) -> Perceptron:
    """The policy that acts as plain arrays."""
    name, made = type(controller).__name__, None
    if isinstance(controller, PolicyController):
        policy: Any = controller.policy
        name, made = type(policy).__name__, getattr(policy, "perceptron", None)
        if not is_identity(controller.model, params.model, spec.obs):
            name, made = "a policy of features", None
    if made is None:
        line = f"the file holds a multilayer perceptron of observations, this is {name}"
        raise UsageError(f"out: {line}; choose out=FILE.stablehlo")
    return made(params.policy, spec)


def save_onnx(out: Path, task: str, spec: Spec, net: Perceptron) -> None:
    """Write OUT, a model of ONNX: obs [N, o] -> action [N, m], float32."""
    onnx: Any = import_module("onnx")
    arrays = {"mean": net.mean, "scale": net.scale, "low": -1, "high": 1}
    lines, x = ["centred = Sub (obs, mean)", "scaled = Div (centred, scale)"], "scaled"
    for i, (weights, bias) in enumerate(zip(net.weights, net.biases, strict=True), 1):
        arrays |= {f"W{i}": weights, f"b{i}": bias}
        lines.append(f"z{i} = Gemm ({x}, W{i}, b{i})")
        last = i == len(net.weights)
        x = "action" if last and net.span is None else f"a{i}"
        function = net.squash if last else net.activation
        lines.append(FUNCTIONS[function].format(z=f"z{i}", a=x))
    if net.span is not None:
        arrays |= dict(zip(("middle", "half"), net.span, strict=True))
        lines += [f"swing = Mul ({x}, half)", "action = Add (swing, middle)"]
    ends = f"(float[N, {int(spec.obs)}] obs) => (float[N, {int(spec.act)}] action)"
    graph = onnx.parser.parse_graph(f"policy {ends} {{ {' '.join(lines)} }}")
    used = {name for node in graph.node for name in node.input}
    graph.initializer.extend(
        onnx.numpy_helper.from_array(np.asarray(value, np.float32), name)
        for name, value in arrays.items()
        if name in used
    )
    opset = [onnx.helper.make_opsetid("", OPSET)]
    model = onnx.helper.make_model(
        graph, ir_version=IR, opset_imports=opset, producer_name="hybrid_rl"
    )
    onnx.helper.set_model_props(model, {"task": task, "dt": f"{float(spec.dt):g}"})
    onnx.checker.check_model(model, full_check=True)
    with replacing(out) as draft:
        draft.write_bytes(model.SerializeToString())
