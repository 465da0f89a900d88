"""Labels of a teacher: a ring of observations and actions, and their sums.

`Queried` is what a learner that asks a teacher keeps in `Params.labels`.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.protocols import Controller, Model
from hybrid_rl.types import Params

RATE = 0.02  # of the running mean of the evidence; our choice


@struct.dataclass
class Labels:
    """What the teacher answered; `count` labels so far, of which the last C are kept."""

    obs: Array  # [C, o]
    action: Array  # [C, m]
    count: Array  # [] int32


@struct.dataclass
class Queried:
    """What targets that choose queries consult."""

    labels: Labels
    scale: Array  # [o] standard deviations of the first demonstration; 1 without one
    evidence: Any  # sum over the labels of what the target asked for; None: nothing


def empty(capacity: int, o: int, m: int) -> Labels:
    """No labels yet."""
    return Labels(jnp.zeros((capacity, o)), jnp.zeros((capacity, m)), jnp.zeros((), jnp.int32))


def add(labels: Labels, obs: Array, action: Array, when: Array) -> Labels:
    """The labels with obs [T, o] and action [T, m] if `when` []; T divides C."""
    slot = labels.count % len(labels.obs)

    def put(ring: Array, new: Array) -> Array:
        old = jax.lax.dynamic_slice_in_dim(ring, slot, len(new))
        return jax.lax.dynamic_update_slice_in_dim(ring, jnp.where(when, new, old), slot, 0)

    count = labels.count + jnp.where(when, len(obs), 0)
    return Labels(put(labels.obs, obs), put(labels.action, action), count)


def draw(labels: Labels, size: int, key: Array) -> tuple[Array, Array]:
    """obs [size, o] and action [size, m], drawn uniformly with replacement; needs a label."""
    filled = jnp.clip(labels.count, 1, len(labels.obs))
    drawn = jax.random.randint(key, (size,), 0, filled)
    return labels.obs[drawn], labels.action[drawn]


class Answer(NamedTuple):
    """Observations and the actions there."""

    obs: Array  # [T, o]
    action: Array  # [T, m]


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
