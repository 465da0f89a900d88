"""Episodes of an environment: time limit, action repeat and resets."""

from dataclasses import dataclass
from functools import partial

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.branching import when_any
from hybrid_rl.protocols import Env
from hybrid_rl.types import EnvState, Spec

# Environments always compute in full precision, networks perhaps with less on an accelerator.
EXACT = partial(jax.default_matmul_precision, "highest")


@dataclass(frozen=True)
class Episode:
    """An environment with a time limit.

    `info["decision"]` and `info["return"]` count from the last reset. An action is repeated for
    `action_repeat` steps of the environment, whose rewards are added until it terminates.

    Raises:
        ValueError: for counts that are not positive whole numbers.
    """

    env: Env
    steps: int = 1000  # decisions until the time limit
    action_repeat: int = 1

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("steps", "action_repeat"):
            value = getattr(self, name)
            if not isinstance(value, int) or value < 1:
                raise ValueError(f"episode.{name}={value}: must be a whole number, 1 or more")

    @property
    def spec(self) -> Spec:
        """Sizes of the environment, and the time between decisions."""
        return self.env.spec._replace(dt=self.env.spec.dt * self.action_repeat)

    def reset(self, key: Array) -> EnvState:
        """The first state of an episode. The key is consumed."""
        with EXACT():
            state = self.env.reset(key)
        clock = {"decision": jnp.zeros((), jnp.int32), "return": jnp.zeros(())}
        return state.replace(info={**state.info, **clock})

    def step(self, state: EnvState, action: Array) -> EnvState:
        """One decision with action [m]."""
        now = self._substep(state, action)

        def repeat(_: int, now: EnvState) -> EnvState:
            after = self._substep(now, action)
            after = after.replace(reward=now.reward + after.reward)
            return jax.tree.map(lambda a, b: jnp.where(now.terminated, a, b), now, after)

        if self.action_repeat > 1:
            now = jax.lax.fori_loop(1, self.action_repeat, repeat, now)
        decision = state.info["decision"] + 1
        return now.replace(
            truncated=(decision >= self.steps) & ~now.terminated,
            info={
                **now.info,
                "decision": decision,
                "return": state.info["return"] + now.reward,
            },
        )

    def _substep(self, state: EnvState, action: Array) -> EnvState:
        with EXACT():
            return self.env.step(state, action)

    def auto_reset(self, state: EnvState, key: Array) -> EnvState:
        """`state`, or the first state of a new episode if it is done. The key is consumed.

        Under `vmap` the reset is computed only if some environment is done.
        """

        def reset_done(state: EnvState, key: Array) -> EnvState:
            fresh = self.reset(key)
            return jax.tree.map(lambda a, b: jnp.where(state.done, a, b), fresh, state)

        return when_any(lambda state: state.done, reset_done)(state, key)
