"""Policies and planners as programs of JAX, and policies as plain layers."""

from collections.abc import Callable, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.flatten_util import ravel_pytree

from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.core.lifting import is_identity
from hybrid_rl.errors import UsageError
from hybrid_rl.networks import Perceptron, precision
from hybrid_rl.protocols import Controller
from hybrid_rl.types import Params, Spec


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
    words = _words((jnp.zeros((), jnp.uint32), first))

    def decide(obs: Array, state: Array, key: Array) -> tuple[Array, Array]:
        count, now = _tree(state, (jnp.zeros((), jnp.uint32), first))
        now = jax.tree.map(lambda begin, later: jnp.where(count == 0, begin, later), first, now)
        u, now, _ = controller.act(params, now, obs, jax.random.wrap_key_data(key))
        return scaled(u), _words((count + 1, now))

    two = jax.ShapeDtypeStruct((2,), jnp.uint32)
    state = jax.ShapeDtypeStruct(words.shape, jnp.uint32)
    return _exported(decide, platforms, obs, state, two)


def _exported(f: Callable[..., Any], platforms: Sequence[str], *given: Any) -> jax.export.Exported:
    """`f` of arrays of these shapes, in float32 whatever it was trained in."""
    with precision.using("float32"):
        return jax.export.export(jax.jit(f), platforms=platforms)(*given)


def _bits(leaf: Any) -> Array:
    """A number of 32 bits or bool as uint32."""
    leaf = jnp.asarray(leaf)
    leaf = leaf.astype(jnp.uint32) if leaf.dtype == bool else leaf
    return jax.lax.bitcast_convert_type(leaf, jnp.uint32)


def _words(tree: Any) -> Array:
    """The leaves of 32 bits or bool, one after the other, as uint32 [w]."""
    return ravel_pytree(jax.tree.map(_bits, tree))[0]


def _tree(words: Array, like: Any) -> Any:
    """The inverse of `_words`, for a tree like `like`."""

    def one(bits: Array, leaf: Any) -> Array:
        leaf = jnp.asarray(leaf)
        same = leaf.dtype != bool
        return jax.lax.bitcast_convert_type(bits, leaf.dtype) if same else bits != 0

    return jax.tree.map(one, ravel_pytree(jax.tree.map(_bits, like))[1](words), like)


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
