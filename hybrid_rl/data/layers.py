"""A multilayer perceptron as a file that runs elsewhere: NumPy, ONNX, or a C header.

Each holds u = squash(W_L a(... a(W_1 (x - mean) / scale + b_1) ...) + b_L) with its numbers, or
middle + half u where the world's actions have other bounds than -1 and 1.
"""

import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.data import archive
from hybrid_rl.files.atomic import replacing
from hybrid_rl.networks import Perceptron
from hybrid_rl.types import Spec

OPSET, IR = 17, 8  # of ONNX: runtimes refuse files that are newer than they are
FUNCTIONS = {  # activation or squashing of z -> NumPy's, C's of a double, ONNX' operator
    "relu": ("np.maximum({}, 0)", "z > 0 ? z : 0", "Relu"),
    "sin": ("np.sin({})", "sin(z)", "Sin"),
    "tanh": ("np.tanh({})", "tanh(z)", "Tanh"),
    "silu": ("silu({})", "z / (1 + exp(-z))", ""),
    "elu": ("elu({})", "z > 0 ? z : expm1(z)", "Elu"),
    "clip": ("np.clip({}, -1, 1)", "z < -1 ? -1 : z > 1 ? 1 : z", ""),
}
DEFINED = {  # those that NumPy lacks
    "silu": "def silu(z):\n    return z / (1 + np.exp(-z))\n\n\n",
    "elu": "def elu(z):\n    return np.where(z > 0, z, np.expm1(np.minimum(z, 0)))\n\n\n",
}
SCRIPT = '''"""The policy of {task}: obs [{o}] -> action [{m}] {within}, every {dt:g} s."""

from pathlib import Path

import numpy as np

P = dict(np.load(Path(__file__).with_suffix(".npz")))


{defined}def act(obs):
    """The action [{m}] at obs [{o}]; or [N, {m}] at [N, {o}]."""
    x = (np.asarray(obs, np.float32) - P["mean"]) / P["scale"]
    if not np.isfinite(x).all():
        raise ValueError("obs: an entry is not finite")
    for i in range(1, {last}):
        x = {activation}
    return {squash}
'''
HEADER = """/* The policy of {task}: observation [{o}] -> action [{m}] {within}, every {dt:g} s.

   C99; link with -lm. No memory is allocated. */
#ifndef {guard}
#define {guard}
#include <math.h>

#define {guard}_OBS {o}
#define {guard}_ACT {m}

{arrays}

/* Returns 0; or 1 and leaves u alone if an entry of x is not finite. */
static int {name}_act(const float x[{o}], float u[{m}])
{{
    double a[{widest}], b[{widest}];
    int i, j;
    for (i = 0; i < {o}; i++) {{
        if (!isfinite(x[i]))
            return 1;
        a[i] = ((double)x[i] - {name}_mean[i]) / {name}_scale[i];
    }}
{layers}
    for (i = 0; i < {m}; i++)
        u[i] = (float)({action});
    return 0;
}}
#endif
"""
LAYER = """    for (j = 0; j < {outputs}; j++) {{
        double z = {name}_b{number}[j];
        for (i = 0; i < {inputs}; i++)
            z += a[i] * {name}_W{number}[i * {outputs} + j];
        b[j] = {function};
    }}
    for (j = 0; j < {outputs}; j++)
        a[j] = b[j];"""


def save_numpy(out: Path, task: str, spec: Spec, net: Perceptron) -> Path:
    """Write OUT.npz and OUT.py, which has a function `act` of NumPy; returns the latter.

    The code holds numbers, and of words only the name of the task, which `archive.write` checked.
    """
    archive.write(out, task, spec, dict(_arrays(net)))
    last, layer = len(net.weights), 'x @ P[f"W{i}"] + P[f"b{i}"]'
    squash = FUNCTIONS[net.squash][0].format(f'x @ P["W{last}"] + P["b{last}"]')
    code = SCRIPT.format(
        **_about(repr(task), spec, net),
        last=last,
        defined=DEFINED.get(net.activation, ""),
        activation=FUNCTIONS[net.activation][0].format(layer),
        squash=squash if net.span is None else f'P["middle"] + P["half"] * {squash}',
    )
    script = out.with_suffix(".py")
    with replacing(script) as draft:
        draft.write_text(code, encoding="utf-8")
    return script


def save_c(out: Path, task: str, spec: Spec, net: Perceptron) -> str:
    """Write OUT, a C header; returns the name of its function.

    Sums are of doubles: those of floats differ from the policy's by 1e-5 and more.
    """
    name = re.sub(r"\W", "_", f"policy_{task}").lower()
    lines = [
        f"static const float {name}_{key}[{value.size}] = {{{_floats(value)}}};"
        for key, value in _arrays(net)
    ]
    names = [*[net.activation] * (len(net.weights) - 1), net.squash]
    functions = [FUNCTIONS[each][1] for each in names]
    layers = [
        LAYER.format(number=i, name=name, inputs=len(W), outputs=W.shape[1], function=function)
        for i, (W, function) in enumerate(zip(net.weights, functions, strict=True), 1)
    ]
    text = HEADER.format(
        **_about(task, spec, net),
        guard=name.upper(),
        name=name,
        action="a[i]" if net.span is None else f"{name}_middle[i] + {name}_half[i] * a[i]",
        widest=max(max(W.shape) for W in net.weights),
        arrays="\n".join(lines),
        layers="\n".join(layers),
    )
    with replacing(out) as draft:
        draft.write_text(text, encoding="utf-8")
    return f"{name}_act"


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
    return node(FUNCTIONS[function][2], [z], out)


def _arrays(net: Perceptron) -> Iterator[tuple[str, np.ndarray]]:
    """The arrays of a perceptron by name: mean, scale, W1, b1, ..."""
    yield "mean", net.mean
    yield "scale", net.scale
    for i, (weights, bias) in enumerate(zip(net.weights, net.biases, strict=True), 1):
        yield f"W{i}", weights
        yield f"b{i}", bias
    if net.span is not None:
        yield from zip(("middle", "half"), net.span, strict=True)


def _about(task: str, spec: Spec, net: Perceptron) -> dict[str, Any]:
    """The task, its sizes and time step, and where an action lies, in words."""
    within = "in [-1, 1]"
    if net.span is not None:
        middle, half = net.span
        low, high = (", ".join(f"{x:g}" for x in ends) for ends in (middle - half, middle + half))
        within = f"from [{low}] to [{high}]"
    return {
        "task": task,
        "o": int(spec.obs),
        "m": int(spec.act),
        "dt": float(spec.dt),
        "within": within,
    }


def _floats(values: np.ndarray) -> str:
    """Literals of C, of which each float is read back exactly; C99 ends a line at 4,095 signs."""
    each = [f"{float(value):#.9g}f" for value in np.ravel(values)]
    return ",\n    ".join(", ".join(each[i : i + 6]) for i in range(0, len(each), 6))
