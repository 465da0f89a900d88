"""What an evaluation tells of episodes."""

from dataclasses import dataclass, replace

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.training.episode import Episode
from hybrid_rl.training.evaluate import outcomes
from hybrid_rl.types import EnvState, Params, Spec


@dataclass(frozen=True)
class Walk:
    """Adds the action up; ends, a success, at a sum of 3 or more."""

    told: bool = True
    spec: Spec = Spec(obs=1, act=1, dt=0.1)

    def reset(self, key: Array) -> EnvState:
        """At 0."""
        return self._state(jnp.zeros(()))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """One more."""
        return self._state(state.data + action[0])

    def _state(self, at: Array) -> EnvState:
        metrics = {"success": (at >= 3).astype(jnp.float32)} if self.told else {}
        return EnvState(at, at[None], at, at >= 3, jnp.zeros((), bool), metrics, {})


class Draws:
    """Takes steps of 1 or of 0, drawn once an episode."""

    def init(self, spec: Spec) -> Array:
        """Not drawn yet."""
        return jnp.float32(-1)

    def act(
        self, params: Params, state: Array, obs: Array, key: Array
    ) -> tuple[Array, Array, dict]:
        """The step [1]."""
        drawn = jax.random.bernoulli(key).astype(jnp.float32)
        state = jnp.where(state < 0, drawn, state)
        return state[None], state, {}


def test_returns_and_successes_by_hand() -> None:
    keys = jax.random.split(jax.random.key(0), 16)
    got = outcomes(Episode(Walk(), steps=5), Draws(), Params(), keys)
    success = np.asarray(got["success"])
    assert set(success) == {0.0, 1.0}
    np.testing.assert_array_equal(got["return"], 6 * success)  # 1 + 2 + 3, and nothing after


def test_a_task_without_successes_tells_none() -> None:
    keys = jax.random.split(jax.random.key(0), 4)
    got = outcomes(Episode(replace(Walk(), told=False), steps=5), Draws(), Params(), keys)
    assert list(got) == ["return"]
