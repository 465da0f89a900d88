"""The learner of the how-tos, TD3, in one state with known values and as a method of its folder."""

import os
import sys
from functools import partial
from importlib import import_module
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from test_extend import HOWTO, blocks

from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.policies.deterministic import Deterministic
from hybrid_rl.types import Batch, Params, Spec

CODE, METHOD = blocks("A learner of your own", HOWTO)


@pytest.fixture
def kind(tmp_path, monkeypatch) -> Any:
    """The class, in a folder of the user's."""
    (tmp_path / "td3.py").write_text(CODE)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.delitem(sys.modules, "td3", raising=False)
    return import_module("td3").TD3


def batch(key) -> Batch:
    """64 uniform actions in one state where the episode ends; reward 1 - (u - 0.5)^2."""
    u = jax.random.uniform(key, (64, 1), minval=-1, maxval=1)
    x, one = jnp.zeros((64, 1)), jnp.ones(64)
    return Batch(x, u, 1 - (u[:, 0] - 0.5) ** 2, one, 0 * one, x, u)


def test_it_finds_the_best_action_and_its_policy_waits(kind) -> None:
    """The policy changes in every third update, the first among them, and its target with it."""
    critic = EnsembleQ(hidden=(32, 32))
    learner = kind(Deterministic(hidden=(32,)), critic, learning_rate=3e-3, tau=0.05, delay=3)
    update = partial(learner.update, params=Params())

    def one(state, key):
        after = update(state, batch=batch(key), key=key)[0]
        return after, jax.tree.leaves((after.policy[0], after.policy[1], after.critic[0]))

    begin = learner.init(jax.random.key(0), Spec(obs=1, act=1, dt=1.0))
    keys = jax.random.split(jax.random.key(1), 1500)
    state, seen = jax.jit(lambda s: jax.lax.scan(one, s, keys))(begin)
    pi, target, Q = state.policy[0], state.policy[1], state.critic[0]
    np.testing.assert_allclose(learner.policy.mean(pi, jnp.zeros(1)), 0.5, atol=0.1)
    np.testing.assert_allclose(learner.policy.mean(target, jnp.zeros(1)), 0.5, atol=0.1)
    np.testing.assert_allclose(critic.all(Q, jnp.zeros(1), jnp.zeros(1)), 0.75, atol=0.1)
    n = len(jax.tree.leaves((pi, target)))
    moved = np.array([(np.diff(a, axis=0)[:9] != 0).reshape(9, -1).any(1) for a in seen])
    assert (moved[:n].any(0) == [False, False, True] * 3).all()
    assert moved[n:].any(0).all()
