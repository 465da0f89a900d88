"""A task's world with one fault, on purpose: what the doctor of runs is tried on.

    python -m hybrid_rl.train --config-dir scripts/broken task=faulty env.kind=lost

The first five kinds were found by an audit; the checks "reward's time", "action" and "regularity"
were written with them in view. The other five were written down before those checks, which do not
aim at them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from importlib import import_module
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.types import EnvState, Spec

AUDITED = {
    "late reward": "the reward of a decision is paid with the next one",
    "flipped": "the sign of all actions is drawn for each episode",
    "lost": "half of the commands are lost: the action is 0",
    "swapped": "the first two entries of the observation change places every other decision",
    "stale": "velocities are one decision old",
}
INVENTED = {
    "dead zone": "an action below 0.3 does nothing",
    "tired": "motors lose 0.9 of their strength over an episode",
    "offset": "the last entry of the observation has an offset N(0, 1) for each episode",
    "frozen": "with probability 0.3 the last observation is shown again",
    "random ends": "with probability 0.02 a decision terminates the episode",
}
KINDS = ["none", *AUDITED, *INVENTED]
MEMORY = "faulty"  # in `info`
FEW = 0.02  # probability of an end


@dataclass(frozen=True)
class Faulty:
    """The world `of` with its own settings, and the fault `kind`."""

    of: str  # its class
    kind: Any = "none"
    velocities: tuple[int, ...] = ()  # entries of the observation
    steps: int = 200  # of an episode
    own: Mapping[str, Any] = field(default_factory=dict)

    @property
    def world(self) -> Any:
        """The sound world."""
        module, name = self.of.rsplit(".", 1)
        return getattr(import_module(module), name)(**self.own)

    @property
    def spec(self) -> Spec:
        """The sizes of the world."""
        return self.world.spec

    def _has(self, kind: str) -> Any:
        """Whether the fault is this one; `kind` is a name, or its number [], perhaps traced."""
        return self.kind == kind if isinstance(self.kind, str) else self.kind == KINDS.index(kind)

    def reset(self, key: Array) -> EnvState:
        """The first state of an episode. The key is consumed."""
        key, own = jax.random.split(key)
        state = self.world.reset(key)
        sign, offset, own = jax.random.split(own, 3)
        memory = {
            "obs": state.obs,  # true, of this decision
            "shown": state.obs,
            "reward": jnp.zeros(()),
            "t": jnp.zeros((), jnp.int32),
            "sign": 2.0 * jax.random.bernoulli(sign) - 1.0,
            "offset": jax.random.normal(offset),
            "key": jax.random.key_data(own),
        }
        return self._seen(state, memory, state.obs)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision with action [m]."""
        memory: dict[str, Any] = dict(state.info[MEMORY])
        key, lost, frozen, ends = jax.random.split(jax.random.wrap_key_data(memory["key"]), 4)
        for kind, acts in {
            "flipped": memory["sign"] * action,
            "lost": action * jax.random.bernoulli(lost),
            "dead zone": jnp.where(abs(action) < 0.3, 0.0, action),
            "tired": action * jnp.maximum(1 - 0.9 * memory["t"] / self.steps, 0.1),
        }.items():
            action = jnp.where(self._has(kind), acts, action)
        now = self.world.step(state.replace(obs=memory["obs"]), action)
        late = jnp.where(self._has("late reward"), memory["reward"], now.reward)
        ended = self._has("random ends") & jax.random.bernoulli(ends, FEW)
        again = self._has("frozen") & jax.random.bernoulli(frozen, 0.3)
        memory = {
            **memory,
            "t": memory["t"] + 1,
            "key": jax.random.key_data(key),
            "reward": now.reward,
        }
        now = replace(now, reward=late, terminated=now.terminated | ended)
        return self._seen(now, memory, jnp.where(again, memory["shown"], now.obs))

    def _seen(self, now: EnvState, memory: dict[str, Array], shown: Array) -> EnvState:
        """`now`, with the observation `shown` and its fault."""
        obs, old = shown, jnp.array(self.velocities, jnp.int32)
        swaps = self._has("swapped") & (memory["t"] % 2 == 1)
        obs = jnp.where(swaps, obs.at[0].set(shown[1]).at[1].set(shown[0]), obs)
        obs = jnp.where(self._has("stale"), obs.at[old].set(memory["obs"][old]), obs)
        obs = jnp.where(self._has("offset"), obs.at[-1].add(memory["offset"]), obs)
        memory = {**memory, "obs": now.obs, "shown": shown}
        return replace(now, obs=obs, info={**now.info, MEMORY: memory})
