"""Replay memory: a ring of packed rows.

A transition is one row of float32 [width]; its next executed action is in the row of the same
environment one decision later, and is not stored twice; nor is its history (`core.history`), which
is in the rows before. The memory starts with the demonstrations, if there are any.
"""

from dataclasses import replace

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core import history
from hybrid_rl.fields import Count, FieldError, part
from hybrid_rl.protocols import Demonstrations, Goal
from hybrid_rl.types import Batch, Spec, Transition


@struct.dataclass
class Memory:
    """The ring; `rows` is updated in place if it is donated."""

    rows: Array  # [C, E, width] float32
    count: Array  # [] int32 decisions of each environment added so far


@part
class Replay:
    """A memory of `capacity` decisions, over all environments of one learner."""

    capacity: Count = 1_000_000
    demonstrations: Demonstrations | None = None  # the initial contents

    def __post_init__(self) -> None:
        if self.capacity < self.num_demonstrated(1):
            words = f"the demonstrations alone have {self.num_demonstrated(1)} decisions"
            raise FieldError(self, "capacity", words)

    def num_demonstrated(self, num_envs: int) -> int:
        """Demonstrated decisions of each of `num_envs` environments in the initial memory."""
        if self.demonstrations is None:
            return 0
        return len(self.demonstrations.load().reward) // num_envs

    def within(self, rounds: int, num_envs: int) -> "Replay":
        """This memory, no larger than what `rounds` decisions of each environment fill."""
        demonstrated = self.num_demonstrated(num_envs)
        longest = max((rounds + demonstrated) * num_envs, self.num_demonstrated(1))
        return replace(self, capacity=min(self.capacity, longest))

    @staticmethod
    def width(spec: Spec) -> int:
        """The size of a row: obs, action, reward, two flags, next obs."""
        return 2 * spec.obs + spec.act + 3

    def nbytes(self, spec: Spec) -> int:
        """Bytes of one learner's memory."""
        return 4 * self.capacity * self.width(spec)

    def init(self, spec: Spec, num_envs: int, goal: Goal | None = None) -> Memory:
        """The memory of `num_envs` environments: empty, or with the demonstrations.

        goal: what pays for them; None: their rewards are those of the file.

        Each environment gets a stretch of successive demonstrations. A stretch that ends within an
        episode is marked as truncated there, since another episode follows it.
        """
        length = max(self.capacity // num_envs, 2)
        rows = jnp.zeros((length, num_envs, self.width(spec)))
        count = self.num_demonstrated(num_envs)
        if self.demonstrations is not None and count:
            flat = _packed(Transition(*map(jnp.asarray, self.demonstrations.load())))
            stretches = flat[: count * num_envs].reshape(num_envs, count, -1).swapaxes(0, 1)
            terminated, truncated = spec.obs + spec.act + 1, spec.obs + spec.act + 2
            cut = 1 - stretches[-1, :, terminated]
            rows = rows.at[:count].set(stretches.at[-1, :, truncated].set(cut))
        memory = Memory(rows, jnp.full((), count, jnp.int32))
        return self.relabelled(memory, spec, goal) if count and goal is not None else memory

    def add(self, memory: Memory, new: Transition) -> Memory:
        """The memory with one more decision of every environment, `new` [E, ...]."""
        slot = memory.count % memory.rows.shape[0]
        rows = jax.lax.dynamic_update_index_in_dim(memory.rows, _packed(new), slot, 0)
        return Memory(rows, memory.count + 1)

    def expecting(self, memory: Memory, obs: Array, action: Array) -> Memory:
        """The memory with the actions [E, m] at obs [E, o] of a decision whose outcome is to come.

        `sample` never draws the newest decision; it reads the actions, as the next ones.
        """
        late, after = jnp.full(len(obs), jnp.nan), jnp.full_like(obs, jnp.nan)
        return self.add(memory, Transition(obs, action, late, late, late, after))

    def newest(self, memory: Memory, spec: Spec, k: int = 1) -> Transition:
        """The last decision [E, ...] of every environment; flags are 0 or 1; k: as of `sample`."""
        slot = (memory.count - 1) % memory.rows.shape[0]
        new = unpack(jax.lax.dynamic_index_in_dim(memory.rows, slot, keepdims=False), spec)
        env = jnp.arange(memory.rows.shape[1])
        return _recalled(new, memory, spec, jnp.full_like(env, memory.count - 1), env, k)

    def interrupted(self, memory: Memory, spec: Spec) -> Memory:
        """The memory with its newest decisions marked as truncated, unless they are terminal.

        What follows them is another episode.
        """
        slot, flag = (memory.count - 1) % memory.rows.shape[0], spec.obs + spec.act + 1
        ended = memory.rows[slot, :, flag]
        cut = jnp.where(memory.count > 0, 1 - ended, 0.0)
        return memory.replace(rows=memory.rows.at[slot, :, flag + 1].set(cut))

    def resized(self, memory: Memory) -> Memory:
        """As many of the newest decisions in a `memory` of another size as fit; not for `jit`."""
        (length, *each), count = memory.rows.shape, int(memory.count)
        size = max(self.capacity // each[0], 2)
        kept = min(count, length, size)
        newest = memory.rows[(count - kept + jnp.arange(kept)) % length]
        rows = jnp.zeros((size, *each)).at[:kept].set(newest)
        return Memory(rows, jnp.full((), kept, jnp.int32))

    def relabelled(self, memory: Memory, spec: Spec, goal: Goal) -> Memory:
        """The memory with the rewards that `goal` pays for its decisions."""
        kept = unpack(memory.rows, spec)
        pay = jax.vmap(jax.vmap(goal.reward_of))
        reward = pay(kept.obs, jnp.clip(kept.action, -1.0, 1.0), kept.next_obs)
        filled = (jnp.arange(len(reward)) < memory.count)[:, None]
        at = spec.obs + spec.act
        rows = memory.rows.at[..., at].set(jnp.where(filled, reward, kept.reward))
        return memory.replace(rows=rows)

    def sample(
        self, memory: Memory, spec: Spec, batch_size: int, key: Array, k: int = 1, given: int = 0
    ) -> Batch:
        """`batch_size` transitions, uniform among those whose successor is in the memory.

        Of a memory that began with `given` decisions of each environment half of them are later
        ones, as soon as there is a batch of these (Ball et al. 2023, symmetric sampling).
        k: observations in the history that stands for an observation. The key is consumed.
        """
        length, num_envs, width = memory.rows.shape
        filled = jnp.minimum(memory.count, length)
        first = memory.count - filled
        if given:
            enough = jnp.maximum(memory.count - given - 1, 0) * num_envs >= batch_size
            own = enough & (jnp.arange(batch_size) % 2 == 0)
            first = jnp.where(own, jnp.maximum(given, first), first)
        known = jnp.maximum(memory.count - first - 1, 1) * num_envs
        bits = jax.random.bits(key, (batch_size,))  # one draw where randint makes three
        draw = (bits % known.astype(bits.dtype)).astype(known.dtype)
        time, env = first + draw // num_envs, draw % num_envs
        flat = memory.rows.reshape(-1, width)
        row = flat[(time % length) * num_envs + env]
        later = flat[((time + 1) % length) * num_envs + env]
        action = slice(spec.obs, spec.obs + spec.act)
        now = _recalled(unpack(row, spec), memory, spec, time, env, k)
        return Batch(*now, next_action=later[:, action])


def unpack(rows: Array, spec: Spec) -> Transition:
    """The transitions [...] in rows [..., width] of a memory."""
    o, m = spec.obs, spec.act
    reward, terminated, truncated = (rows[..., o + m + i] for i in range(3))
    obs, action, after = rows[..., :o], rows[..., o : o + m], rows[..., o + m + 3 :]
    return Transition(obs, action, reward, terminated, truncated, after)


def _recalled(
    now: Transition, memory: Memory, spec: Spec, time: Array, env: Array, k: int
) -> Transition:
    """Transitions [B] with histories of k observations; time, env: where they are [B].

    An episode that is older than the memory begins with the oldest row.
    """
    if k == 1:
        return now
    length, oldest = len(memory.rows), memory.count - jnp.minimum(memory.count, len(memory.rows))
    parts, later, begun = [now.obs], now.obs, jnp.ones((len(time), 1), bool)
    for j in range(1, k):
        before = unpack(memory.rows[(time - j) % length, env], spec)
        ended = before.terminated + before.truncated > 0
        begun = begun & ((time - j >= oldest) & ~ended)[:, None]
        rate, later = (later - before.obs) / spec.dt, before.obs
        parts += [jnp.where(begun, each, 0) for each in (rate, before.action)]
    s = jnp.concatenate(parts, axis=1)
    shifted = jax.vmap(history.shifted, (0, 0, 0, None))
    after = shifted(s, now.action, now.next_obs, spec.dt)
    return now._replace(obs=s, next_obs=after)


def _packed(new: Transition) -> Array:
    """The rows [B, width] of transitions [B, ...]."""
    flags = [v.astype(jnp.float32)[:, None] for v in new[2:5]]
    return jnp.concatenate([new.obs, new.action, *flags, new.next_obs], axis=-1)
