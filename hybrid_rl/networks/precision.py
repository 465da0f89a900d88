"""Floating-point precision of networks; everything else computes in float32.

    float32  as everything else
    tf32     products in TF32 on a GPU: factors rounded to 10 bits, sums in float32
    bf16     also the hidden layers of a multilayer perceptron in bfloat16: products, layer norm and
             activations of 7 bits. Weights, their gradients' steps, the last layer and all that
             follows it are float32, so checkpoints do not depend on it.
    mixed    bf16 on a GPU, float32 on a CPU
    auto     tf32 on a GPU, float32 on a CPU

A program has the precision in which it was traced: `choose` sets it for a run, `using` for a block.
"""

import jax
from jax.lax import Precision

OF_DEVICE = {"auto": {"gpu": "tf32"}, "mixed": {"gpu": "bf16"}}  # by kind of device, else float32
PRECISIONS = ("auto", "mixed", "bf16", "tf32", "float32")
using = jax.make_user_context("auto")  # a part of JAX's keys of traced programs
using.__doc__ = "`with using(NAME)`: networks traced in the block compute in one of PRECISIONS."


def choose(name: str) -> None:
    """Networks compute in one of PRECISIONS from now on, in every thread."""
    using.set_global(name)


def current() -> str:
    """The precision of networks in this process: bf16, tf32 or float32."""
    name = using.value
    return OF_DEVICE[name].get(jax.default_backend(), "float32") if name in OF_DEVICE else name


def of_products() -> Precision:
    """The precision of a network's products of float32 matrices."""
    return Precision.HIGHEST if current() == "float32" else Precision.DEFAULT
