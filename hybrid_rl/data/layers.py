"""A multilayer perceptron as a model of ONNX, which runs elsewhere.

It holds u = squash(W_L a(... a(W_1 (x - mean) / scale + b_1) ...) + b_L) with its numbers, or
middle + half u where the world's actions have other bounds than -1 and 1.
"""

from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.files.atomic import replacing
from hybrid_rl.networks import Perceptron
from hybrid_rl.types import Spec

OPSET, IR = 17, 8  # of ONNX: runtimes refuse files that are newer than they are
OPERATORS = {"relu": "Relu", "sin": "Sin", "tanh": "Tanh", "elu": "Elu"}  # of an activation


def save_onnx(out: Path, task: str, spec: Spec, net: Perceptron) -> None:
    """Write OUT, a model of ONNX: obs [N, o] -> action [N, m], float32."""
    onnx: Any = import_module("onnx")
    helper, nodes = onnx.helper, []

    def node(kind: str, inputs: list[str], output: str, **options: Any) -> str:
        nodes.append(helper.make_node(kind, inputs, [output], **options))
        return output

    node("Sub", ["obs", "mean"], "centred")
    x = node("Div", ["centred", "scale"], "scaled")
    for i in range(1, len(net.weights) + 1):
        x = node("Gemm", [x, f"W{i}", f"b{i}"], f"z{i}")
        function = net.squash if i == len(net.weights) else net.activation
        last = i == len(net.weights)
        x = _function(node, function, x, "action" if last and net.span is None else f"a{i}")
    if net.span is not None:
        node("Add", [node("Mul", [x, "half"], "swing"), "middle"], "action")
    arrays = {**dict(_arrays(net)), "low": np.float32(-1), "high": np.float32(1)}
    used = {name for each in nodes for name in each.input}
    kept = [
        onnx.numpy_helper.from_array(np.asarray(value, np.float32), name)
        for name, value in arrays.items()
        if name in used
    ]
    ends = [
        [helper.make_tensor_value_info(name, onnx.TensorProto.FLOAT, ["N", size])]
        for name, size in (("obs", int(spec.obs)), ("action", int(spec.act)))
    ]
    graph = helper.make_graph(nodes, "policy", *ends, kept)
    opset = [helper.make_opsetid("", OPSET)]
    model = helper.make_model(graph, ir_version=IR, opset_imports=opset, producer_name="hybrid_rl")
    helper.set_model_props(model, {"task": task, "dt": f"{float(spec.dt):g}"})
    onnx.checker.check_model(model, full_check=True)
    with replacing(out) as draft:
        draft.write_bytes(model.SerializeToString())


def _function(node: Any, function: str, z: str, out: str) -> str:
    """The nodes of an activation or a squashing of z."""
    if function == "silu":
        return node("Mul", [z, node("Sigmoid", [z], f"{out}_gate")], out)
    if function == "clip":
        return node("Clip", [z, "low", "high"], out)
    return node(OPERATORS[function], [z], out)


def _arrays(net: Perceptron) -> Iterator[tuple[str, np.ndarray]]:
    """The arrays of a perceptron by name: mean, scale, W1, b1, ..."""
    yield "mean", net.mean
    yield "scale", net.scale
    for i, (weights, bias) in enumerate(zip(net.weights, net.biases, strict=True), 1):
        yield f"W{i}", weights
        yield f"b{i}", bias
    if net.span is not None:
        yield from zip(("middle", "half"), net.span, strict=True)
