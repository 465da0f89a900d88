"""From observations to planning states; without a model they are the same."""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import Model
from hybrid_rl.types import Batch, EnvState, Params, PyTree, Spec


class Known:
    """What models share of which nothing is learned."""

    def init(self, key: Array, spec: Spec) -> tuple[()]:
        """No parameters."""
        return ()

    def lift(self, params: Any, obs: Array) -> Array:
        """The observation [o] itself."""
        return obs


def lift(model: Model | None, params: PyTree, obs: Array) -> Array:
    """The planning state x [n] of an observation [o]."""
    return obs if model is None else model.lift(params, obs)


def is_identity(model: Model | None, params: PyTree, size: int) -> bool:
    """Whether the planning state of an observation [size] is the observation."""
    obs = jnp.arange(1.0, size + 1)
    lifted = lift(model, params, obs)
    return lifted.shape == obs.shape and bool((lifted == obs).all())


def is_world(model: Any) -> bool:
    """Whether a model is the world itself, whose planning states are the world's."""
    return callable(getattr(model, "start", None))


def start(model: Any, params: Params, obs: Array) -> Any:
    """The planning state from which to plan at obs [o]; of a world model, the world's state."""
    return model.start(params) if is_world(model) else model.lift(params.model, obs)


def policy_input(x: Array | EnvState) -> Array:
    """What policies and critics get of a planning state: the observation of a world's."""
    return x.obs if isinstance(x, EnvState) else x


def lifted_batch(model: Model | None, params: PyTree, batch: Batch) -> Batch:
    """`batch` with planning states [B, n] instead of its observations [B, o]."""
    if model is None:
        return batch
    each = jax.vmap(lambda obs: model.lift(params, obs))
    return batch._replace(obs=each(batch.obs), next_obs=each(batch.next_obs))


def lifted_spec(model: Model | None, spec: Spec) -> Spec:
    """`spec` with the size n of the model's planning state."""
    if model is None:
        return spec
    key, obs = jax.random.key(0), jnp.zeros(spec.obs)
    x = jax.eval_shape(lambda key: model.lift(model.init(key, spec), obs), key)
    return spec._replace(state=x.size)


def select(obs: Array, coordinates: tuple[int, ...] | None) -> Array:
    """These coordinates [c] of an observation [o]; None: all."""
    return obs if coordinates is None else obs[jnp.array(coordinates)]


def check_coordinates(name: str, coordinates: tuple[int, ...] | None, size: int) -> None:
    """Raise ValueError unless an observation [size] has `coordinates`, a field `name`."""
    if coordinates and not (min(coordinates) >= 0 and max(coordinates) < size):
        raise ValueError(f"{name}={list(coordinates)}: must be some of the entries 0 to {size - 1}")
