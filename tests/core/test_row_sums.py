"""Sums over rows by products: values and derivatives are those of plain sums."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.lax import Precision

from hybrid_rl import networks
from hybrid_rl.core.row_sums import repeated, summed


def wave(v, x):
    """Rows and v [d] mixed by our own repetition."""
    return jnp.sin(x * repeated(v, len(x), Precision.HIGHEST)).sum()


def plain(v, x):
    """The same by NumPy's rules."""
    return jnp.sin(x * v[None]).sum()


@pytest.mark.parametrize("rows", [1, 16, 37, 300])
def test_a_sum_over_rows_is_that_of_numpy(rows):
    x = np.random.default_rng(0).normal(size=(2, rows, 5)).astype(np.float32)
    got = summed(jnp.array(x), Precision.HIGHEST)
    np.testing.assert_allclose(got, x.sum(1), rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("of", [jax.grad, lambda f: jax.hessian(f), lambda f: jax.jacfwd(f)])
@pytest.mark.parametrize("axes", [(0, 0), (None, 0), (0, None)])
def test_derivatives_are_those_of_a_plain_product(of, axes):
    keys = jax.random.split(jax.random.key(0))
    v = jax.random.normal(keys[0], (3, 5) if axes[0] == 0 else (5,))
    x = jax.random.normal(keys[1], (3, 70, 5) if axes[1] == 0 else (70, 5))
    got, right = (jax.jit(jax.vmap(of(f), axes))(v, x) for f in (wave, plain))
    np.testing.assert_allclose(got, right, rtol=1e-4, atol=1e-4)


def test_gradients_of_bfloat16_rows_are_summed_in_float32():
    x = jnp.ones((4096, 1), jnp.bfloat16)  # in bfloat16 the sum would stop at 256
    slope = jax.grad(lambda v: repeated(v, len(x), Precision.DEFAULT).sum())(x[0])
    assert slope[0] == 4096


@pytest.mark.parametrize("layer_norm", networks.LAYER_NORMS)
@pytest.mark.parametrize("rows", [(), (3,), (200,), (5, 40)])
def test_networks_of_a_gpu_are_those_of_a_cpu(monkeypatch, layer_norm, rows):
    net = networks.MLP([8, 7], 2, layer_norm=layer_norm)
    x = jax.random.normal(jax.random.key(1), (*rows, 4))

    def values(params):
        return (net.apply(params, x) ** 2).sum()

    params = jax.jit(net.init)(jax.random.key(0), x)
    right = jax.jit(jax.value_and_grad(values))(params)
    monkeypatch.setattr(jax, "default_backend", lambda: "gpu")
    on_gpu = jax.eval_shape(lambda: net.init(jax.random.key(0), x))
    assert jax.tree.structure(on_gpu) == jax.tree.structure(params)
    with networks.precision.using("float32"):
        got = jax.jit(jax.value_and_grad(lambda params: values(params)))(params)
    jax.tree.map(lambda a, b: np.testing.assert_allclose(a, b, rtol=1e-4, atol=1e-5), got, right)
