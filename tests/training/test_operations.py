"""Operations counted in a trace: closed forms, and XLA's count of a compiled program."""

from typing import Any

import jax
import jax.numpy as jnp
import pytest

from hybrid_rl.networks import MLP
from hybrid_rl.training.operations import operations

A, B, C = jnp.zeros((3, 5)), jnp.zeros((5, 7)), jnp.zeros((7, 7))


def product(x, y):
    return 2 * x.shape[0] * x.shape[1] * y.shape[1]


def count(f, *inputs):
    return operations(jax.jit(f).trace(*inputs).jaxpr)


def test_a_scan_counts_each_of_its_steps_and_a_batch_each_of_its_products():
    def scanned(a):
        return jax.lax.scan(lambda x, _: (x @ C, None), a @ B, None, length=11)[0]

    one = product(A, B) + 11 * product(A @ B, C)
    assert count(scanned, A) == one
    assert count(jax.vmap(scanned), jnp.stack([A] * 4)) == 4 * one


def test_a_conditional_counts_its_most_expensive_branch_and_a_loop_once():
    def chosen(flag, x):
        return jax.lax.cond(flag, lambda x: x, lambda x: x @ C @ C, x)

    def looped(times, x):
        return jax.lax.fori_loop(0, times, lambda _, x: x @ C, x)

    assert count(chosen, True, C) == 2 * product(C, C)
    assert count(looped, jnp.int32(9), C) == product(C, C)


def test_a_gradient_counts_as_xla_counts_it():
    net: Any = MLP((64, 64), 3)
    x = jnp.zeros((128, 17))
    params = net.init(jax.random.key(0), x)
    gradient = jax.jit(jax.grad(lambda params, x: jnp.square(net.apply(params, x)).mean()))
    analysis: Any = gradient.lower(params, x).compile().cost_analysis()
    assert count(gradient, params, x) == pytest.approx(analysis["flops"], rel=0.05)
