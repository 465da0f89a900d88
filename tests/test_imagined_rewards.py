"""Rewards that a model imagines, against those of the episode."""

from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp

from scripts import imagined_rewards as study
from scripts.hidden_velocities import Lived


def test_a_true_model_is_right_and_a_wrong_one_less_so():
    """o' = o + u, paid 2 o' of one number; a bias of 1 a decision grows."""
    u = jax.random.normal(jax.random.key(0), (3, 250, 1))
    obs = jnp.cumsum(u, 1) - u
    data = Lived(obs, u, obs[..., 0], 2 * (obs + u)[..., 0])
    found = []
    for bias in (0.0, 1.0):
        own: Any = SimpleNamespace(
            params=lambda state: {},
            model=SimpleNamespace(
                lift=lambda params, s: s, step=lambda params, x, u, bias=bias: x + u + bias
            ),
            reward=SimpleNamespace(outcome=lambda params, x, u, after: (2 * after[0], 0.0)),
        )
        found.append(study.right(own, None, obs, data))
    right, biased = found
    assert right == [1.0] * len(study.AFTER)
    wrong = [1 - r2 for r2 in biased]
    assert 0 < wrong[0] < 0.05
    assert wrong[-1] > 20 * wrong[0]
