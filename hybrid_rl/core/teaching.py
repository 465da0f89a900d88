"""Answers of a teacher: its actions at an observation, or along a path that begins there."""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import Controller, Model
from hybrid_rl.types import Params, Spec


class Answer(NamedTuple):
    """Observations and the actions there."""

    obs: Array  # [T, o]
    action: Array  # [T, m]


def require(teacher: Controller | None) -> Controller:
    """The teacher; raises ValueError if there is none."""
    if teacher is None:
        raise ValueError(
            "expert=null: this task has no expert that teaches; give expert=NAME of conf/expert"
        )
    return teacher


def begin(teacher: Controller, spec: Spec) -> Any:
    """The state of `teacher` before an answer."""
    kind, sizes = type(teacher).__name__, f"{spec.obs} observed numbers to {spec.act}"

    def act() -> Array:
        key, obs = jax.random.key(0), jnp.zeros(spec.obs)
        return teacher.act(Params(), teacher.init(spec), obs, key)[0]

    try:
        shape = jax.eval_shape(act).shape
    except (TypeError, IndexError, ValueError) as error:
        line = str(error).partition("\n")[0]
        raise ValueError(f"expert={kind}: does not map {sizes}: {line}") from error
    if shape != (spec.act,):
        raise ValueError(f"expert={kind}: decides {list(shape)}, and must map {sizes}")
    return teacher.init(spec)


def answer(
    teacher: Controller,
    model: Model | None,
    params: Params,
    rest: Any,
    obs: Array,
    length: int,
    key: Array,
) -> Answer:
    """`length` decisions of `teacher` from obs [o] and its state `rest`; paths follow `model`.

    The observation is the first part of the model's planning state. The key is consumed.
    """

    def decide(carry: tuple[Array, Any], key: Array) -> tuple[tuple[Array, Any], Answer]:
        x, held = carry
        u, held, _ = teacher.act(params, held, x, key)
        after = x
        if model is not None and length > 1:
            after = model.step(params.model, model.lift(params.model, x), u)[: x.size]
        return (after, held), Answer(x, u)

    return jax.lax.scan(decide, (obs, rest), jax.random.split(key, length))[1]
