"""Replay memory: a ring of packed rows, sampled uniformly.

A transition is one row of float32 [width]; the next executed action is that of the row of the same
environment one decision later, so that it is stored once. The memory starts with the
demonstrations, if there are any.
"""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.protocols import Demonstrations
from hybrid_rl.types import Batch, Spec, Transition


@struct.dataclass
class Memory:
    """The ring. `rows` is overwritten in place where it is donated."""

    rows: Array  # [C, E, width] float32
    count: Array  # [] int32 decisions of each environment ever added


@dataclass(frozen=True)
class Replay:
    """A bounded memory of `capacity` decisions, over all environments of one learner.

    Raises:
        ValueError: for a capacity that is not a positive whole number, or too little for
            the demonstrations.
    """

    capacity: int = 1_000_000
    demonstrations: Demonstrations | None = None  # the initial contents

    def __post_init__(self) -> None:
        """Check the fields."""
        if not isinstance(self.capacity, int) or self.capacity < 1:
            raise ValueError(f"replay.capacity={self.capacity}: must be a whole number, 1 or more")
        if self.capacity < self.num_demonstrated(1):
            raise ValueError(
                f"replay.capacity={self.capacity}: the demonstrations alone have "
                f"{self.num_demonstrated(1)} decisions"
            )

    def num_demonstrated(self, worlds: int) -> int:
        """Decisions of each of `worlds` environments in the initial memory."""
        if self.demonstrations is None:
            return 0
        return len(self.demonstrations.load().reward) // worlds

    @staticmethod
    def width(spec: Spec) -> int:
        """Numbers in one row: obs, action, reward, two flags, next obs."""
        return 2 * spec.obs + spec.act + 3

    def nbytes(self, spec: Spec) -> int:
        """Bytes of one learner's memory."""
        return 4 * self.capacity * self.width(spec)

    def init(self, spec: Spec, worlds: int) -> Memory:
        """The memory for `worlds` environments: empty, or with the demonstrations.

        Demonstrations are divided among the environments, a stretch in order for each. A stretch
        that is cut inside an episode ends as truncated, since another episode follows it.
        """
        length = max(self.capacity // worlds, 2)
        rows = jnp.zeros((length, worlds, self.width(spec)))
        count = self.num_demonstrated(worlds)
        if self.demonstrations is not None and count:
            flat = _packed(Transition(*map(jnp.asarray, self.demonstrations.load())))
            stretches = flat[: count * worlds].reshape(worlds, count, -1).swapaxes(0, 1)
            terminated, truncated = spec.obs + spec.act + 1, spec.obs + spec.act + 2
            cut = 1 - stretches[-1, :, terminated]
            rows = rows.at[:count].set(stretches.at[-1, :, truncated].set(cut))
        return Memory(rows, jnp.full((), count, jnp.int32))

    def add(self, memory: Memory, new: Transition) -> Memory:
        """Memory with one decision of every environment; arrays of `new` lead with [E]."""
        slot = memory.count % memory.rows.shape[0]
        rows = jax.lax.dynamic_update_index_in_dim(memory.rows, _packed(new), slot, 0)
        return Memory(rows, memory.count + 1)

    def sample(self, memory: Memory, spec: Spec, batch_size: int, key: Array) -> Batch:
        """`batch_size` transitions, uniform among those whose successor is in the memory.

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
        later = flat[((time + 1) % length) * worlds + world]
        action = slice(spec.obs, spec.obs + spec.act)
        return Batch(*unpack(row, spec), next_action=later[:, action])


def unpack(rows: Array, spec: Spec) -> Transition:
    """The transitions [...] in rows [..., width] of a memory."""
    o, m = spec.obs, spec.act
    reward, terminated, truncated = (rows[..., o + m + i] for i in range(3))
    obs, action, after = rows[..., :o], rows[..., o : o + m], rows[..., o + m + 3 :]
    return Transition(obs, action, reward, terminated, truncated, after)


def as_batch(new: Transition) -> Batch:
    """Transitions [B, ...] as a batch, whose next actions are unknown."""
    terminated, truncated = (f.astype(jnp.float32) for f in (new.terminated, new.truncated))
    return Batch(new.obs, new.action, new.reward, terminated, truncated, new.next_obs)


def _packed(new: Transition) -> Array:
    """Rows [B, width] of transitions [B, ...]."""
    flags = [v.astype(jnp.float32)[:, None] for v in new[2:5]]
    return jnp.concatenate([new.obs, new.action, *flags, new.next_obs], axis=-1)
