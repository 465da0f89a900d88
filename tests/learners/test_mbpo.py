"""Imagined data from a model whose every step is known."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from toys import begun

from hybrid_rl.learners.mbpo import MBPO
from hybrid_rl.types import Batch, Params, Spec

B = 10


@dataclass(frozen=True)
class Counting:
    """x' = x + 1 for any action; reward x; the episode ends above 2.5; the policy acts by -x."""

    def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
        return x + 1

    def outcome(self, params: Any, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """Reward and logit of the end."""
        return x[0], jnp.where(x[0] > 2.5, 20.0, -20.0)

    def sample(self, params: Any, x: Array, noise: Array) -> tuple[Array, Array]:
        return -x[:1], jnp.zeros(())


@dataclass(frozen=True)
class Keeping:
    """A learner that keeps its last batch."""

    batch_size: int = B
    updates: float = 1

    batches = 1
    during_random = False
    owns = ()

    def init(self, key: Array, spec: Spec) -> None:
        """Nothing."""

    def params(self, state: Any) -> dict[str, Any]:
        return {}

    def update(self, state: Any, params: Params, batch: Batch, key: Array) -> tuple[Any, dict]:
        return batch, {}


def imagined(start: float, **given: Any) -> Batch:
    """The learner's batch if all data are at `start`, with reward -7."""
    known: Any = Counting()
    learner = MBPO(Keeping(), known, known, known, **given)
    x, same = jnp.full((B, 1), start), jnp.full(B, -7.0)
    seen = Batch(x, x, same, 0 * same, 0 * same, 0 * x, x)
    state = begun(learner, Spec(obs=1, act=1, dt=0.1))
    return jax.jit(learner.update)(state, Params(), seen, jax.random.key(3))[0]


@pytest.mark.parametrize("fraction", [0.6, 0.0])
def test_a_fraction_is_imagined_and_the_rest_is_unchanged(fraction: float) -> None:
    """One step from the data: x -> x + 1, with the reward at x."""
    batch, n = imagined(0.0, imagined_fraction=fraction), round(fraction * B)
    assert batch.obs.shape == (B, 1)
    np.testing.assert_array_equal(batch.next_obs[:, 0], [1] * n + [0] * (B - n))
    np.testing.assert_array_equal(batch.reward, [0] * n + [-7] * (B - n))
    np.testing.assert_allclose(batch.terminated, 0, atol=1e-6)


def test_branches_have_every_length_and_restart_after_an_end() -> None:
    """From 1: steps 1 -> 2 -> 3, where the episode ends, and then from 1 again."""
    batch = imagined(1.0, imagined_fraction=1.0, steps=4)
    at = np.asarray(batch.obs[:, 0])
    assert set(at) == {1.0, 2.0, 3.0}
    np.testing.assert_array_equal(batch.reward, at)
    np.testing.assert_array_equal(batch.action[:, 0], -at)
    np.testing.assert_array_equal(batch.next_obs[:, 0], at + 1)
    np.testing.assert_allclose(batch.terminated, at > 2.5, atol=1e-6)
