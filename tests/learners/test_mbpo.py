"""Imagined data from a model whose every step is known."""

from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.learners.mbpo import MBPO
from hybrid_rl.types import Batch, Params, Spec

B = 10


@dataclass(frozen=True)
class Counting:
    """x' = x + 1 for any action; reward x; the episode ends above 2.5."""

    def init(self, key: Array, spec: Spec) -> None:
        """Nothing."""

    def lift(self, params: Any, obs: Array) -> Array:
        """The observation."""
        return obs

    def draw(self, params: Any, x: Array, u: Array, noise: Array, key: Array) -> Array:
        """One more."""
        return x + 1

    def outcome(self, params: Any, x: Array, u: Array, after: Array) -> tuple[Array, Array]:
        """Reward and logit of the end."""
        return x[0], jnp.where(x[0] > 2.5, 20.0, -20.0)

    def mean(self, params: Any, x: Array) -> Array:
        """The action of `sample`."""
        return -x[:1]

    def sample(self, params: Any, x: Array, noise: Array) -> tuple[Array, Array]:
        """The action -x, without noise."""
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
        """Nothing."""
        return {}

    def update(self, state: Any, params: Params, batch: Batch, key: Array) -> tuple[Any, dict]:
        """The batch."""
        return batch, {}


def imagined(start: Array, **given: Any) -> Batch:
    """The learner's batch if all data are at `start` [B] with reward -7."""
    known: Any = Counting()
    learner = MBPO(Keeping(), known, known, known, **given)
    x, same = start[:, None], jnp.full(B, -7.0)
    seen = Batch(x, x, same, 0 * same, 0 * same, 0 * x, x)
    state = learner.init(jax.random.key(0), Spec(obs=1, act=1, dt=0.1))
    return jax.jit(learner.update)(state, Params(), seen, jax.random.key(3))[0]


def test_a_fraction_is_imagined_and_the_rest_is_unchanged() -> None:
    """One step from the data: x -> x + 1, with the reward at x."""
    batch = imagined(jnp.zeros(B), imagined_fraction=0.6)
    assert batch.obs.shape == (B, 1)
    np.testing.assert_array_equal(batch.next_obs[:, 0], [1] * 6 + [0] * 4)
    np.testing.assert_array_equal(batch.reward, [0] * 6 + [-7] * 4)
    np.testing.assert_allclose(batch.terminated, 0, atol=1e-6)


def test_branches_have_every_length_and_restart_after_an_end() -> None:
    """From 1: steps 1 -> 2 -> 3, where the episode ends, and then from 1 again."""
    batch = imagined(jnp.ones(B), imagined_fraction=1.0, steps=4)
    at = np.asarray(batch.obs[:, 0])
    assert set(at) == {1.0, 2.0, 3.0}
    np.testing.assert_array_equal(batch.reward, at)
    np.testing.assert_array_equal(batch.action[:, 0], -at)
    np.testing.assert_array_equal(batch.next_obs[:, 0], at + 1)
    np.testing.assert_allclose(batch.terminated, at > 2.5, atol=1e-6)


def test_a_fraction_of_zero_passes_the_batch_on() -> None:
    """The learner gets the batch itself."""
    np.testing.assert_array_equal(imagined(jnp.ones(B), imagined_fraction=0.0).reward, -7)


def test_bad_fields() -> None:
    """One line that names the field."""
    known: Any = Counting()
    with pytest.raises(ValueError, match=r"imagined_fraction=2"):
        MBPO(Keeping(), known, known, known, imagined_fraction=2)
    with pytest.raises(ValueError, match=r"steps=0"):
        MBPO(Keeping(), known, known, known, steps=0)
