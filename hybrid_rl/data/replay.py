"""Replay memory: a ring of packed rows, uniform sampling.

A transition is one row of float32 [width]; the row of the same world one decision later gives
the action that was executed next, so that it is stored once. What was demonstrated stands
in it before the first decision, where it was given any.
"""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.types import Batch, Spec, Transition


@struct.dataclass
class Memory:
    """The ring. `rows` is overwritten in place where it is donated."""

    rows: Array  # [C, E, width] float32
    count: Array  # [] int32 decisions of each world ever added


@dataclass(frozen=True)
class Replay:
    """A bounded memory of `capacity` decisions, over all worlds of one learner.

    Raises:
        ValueError: for a capacity that is not a positive whole number, or too little for
            the demonstrations.
    """

    capacity: int = 1_000_000
    demonstrations: Any = None  # offers `recall`: what the memory holds at first

    def __post_init__(self) -> None:
        """Check the fields."""
        if not isinstance(self.capacity, int) or self.capacity < 1:
            raise ValueError(f"replay.capacity={self.capacity}: must be a whole number, 1 or more")
        if self.capacity < self.given(1):
            raise ValueError(
                f"replay.capacity={self.capacity}: the demonstrations alone are {self.given(1)}"
            )

    def given(self, worlds: int) -> int:
        """Decisions of each of `worlds` worlds that the memory holds at first."""
        return 0 if self.demonstrations is None else len(self.demonstrations.recall()[2]) // worlds

    @staticmethod
    def width(spec: Spec) -> int:
        """Numbers in one row: obs, action, reward, two flags, next obs."""
        return 2 * spec.obs + spec.act + 3

    def nbytes(self, spec: Spec) -> int:
        """Bytes of one learner's memory."""
        return 4 * self.capacity * self.width(spec)

    def init(self, spec: Spec, worlds: int) -> Memory:
        """The first memory for `worlds` worlds: empty, or with what was demonstrated.

        Demonstrations are dealt out over the worlds, each a stretch in order; a stretch that
        was cut off inside an episode ends as truncated, since what follows is of another.
        """
        length = max(self.capacity // worlds, 2)
        rows = jnp.zeros((length, worlds, self.width(spec)))
        given = self.given(worlds)
        if given:
            flat = _packed(Transition(*map(jnp.asarray, self.demonstrations.recall())))
            stretches = flat[: given * worlds].reshape(worlds, given, -1).swapaxes(0, 1)
            terminated, truncated = spec.obs + spec.act + 1, spec.obs + spec.act + 2
            cut = 1 - stretches[-1, :, terminated]
            rows = rows.at[:given].set(stretches.at[-1, :, truncated].set(cut))
        return Memory(rows, jnp.full((), given, jnp.int32))

    def add(self, memory: Memory, new: Transition) -> Memory:
        """Memory with one decision of every world; arrays of `new` lead with [E]."""
        row = _packed(new)
        at = memory.count % memory.rows.shape[0]
        rows = jax.lax.dynamic_update_index_in_dim(memory.rows, row, at, 0)
        return Memory(rows, memory.count + 1)

    def sample(self, memory: Memory, spec: Spec, batch_size: int, key: Array) -> Batch:
        """`batch_size` transitions drawn alike among those whose successor is known.

        The key is consumed.
        """
        length, worlds, width = memory.rows.shape
        filled = jnp.minimum(memory.count, length)
        oldest = memory.count - filled
        known = jnp.maximum(filled - 1, 1) * worlds
        bits = jax.random.bits(key, (batch_size,))  # one draw where randint makes three
        draw = (bits % known.astype(bits.dtype)).astype(known.dtype)
        time, world = oldest + draw // worlds, draw % worlds
        flat = memory.rows.reshape(-1, width)
        row = flat[(time % length) * worlds + world]
        o, m = spec.obs, spec.act
        later = flat[((time + 1) % length) * worlds + world, o : o + m]
        reward, terminated, truncated = row[:, o + m], row[:, o + m + 1], row[:, o + m + 2]
        return Batch(
            row[:, :o], row[:, o : o + m], reward, terminated, truncated, row[:, o + m + 3 :], later
        )


def _packed(new: Transition) -> Array:
    """Rows [B, width] of transitions that lead with [B]."""
    flags = [v.astype(jnp.float32)[:, None] for v in new[2:5]]
    return jnp.concatenate([new.obs, new.action, *flags, new.next_obs], axis=-1)
