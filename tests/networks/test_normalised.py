"""Residual networks that are normalised by their batches."""

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.networks import normalised
from hybrid_rl.networks.normalised import NormalisedNet


def test_in_a_batch_the_network_is_normalised_by_it() -> None:
    """Written again in NumPy; the running statistics move by a hundredth of the way."""
    net = NormalisedNet(width=4, blocks=1, out=3)
    params = jax.jit(lambda key: normalised.init(net, key, 2))(jax.random.key(0))
    x = np.random.default_rng(1).normal(3, 2, (16, 2))
    kernels = [np.asarray(params["weights"][f"Dense_{i}"]["kernel"], float) for i in range(3)]

    def normal(v):
        return (v - v.mean(0)) / np.sqrt(v.var(0) + 1e-5)

    h = normal(x) @ kernels[0]
    h = h + np.maximum(normal(np.maximum(normal(h @ kernels[1]), 0) @ kernels[2]), 0)
    h = h / np.sqrt((h**2).mean(1, keepdims=True) + 1e-6)
    expected = h @ np.asarray(params["weights"]["head"]["kernel"], float)
    y, after = jax.jit(normalised.apply_in_batch, static_argnums=0)(net, params, jnp.float32(x))
    np.testing.assert_allclose(y, expected, atol=1e-4)
    first = after["statistics"]["BatchNorm_0"]
    np.testing.assert_allclose(first["mean"], 0.01 * x.mean(0), rtol=1e-4)
    np.testing.assert_allclose(first["var"], 0.99 + 0.01 * x.var(0), rtol=1e-4)
