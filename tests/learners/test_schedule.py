"""Learning rates that fall along a run, in every learner that has a schedule."""

from dataclasses import replace
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from small import load
from toys import begun

from hybrid_rl.schedules.linear import LinearDecay
from hybrid_rl.settings.build import build
from hybrid_rl.types import Batch, Params


def test_the_factor_is_one_then_falls_to_zero():
    falling = jax.vmap(LinearDecay(decisions=100, share=0.4).factor)
    np.testing.assert_allclose(
        falling(jnp.array([0, 59, 60, 80, 99, 100, 120])), [1, 1, 1, 0.5, 0.025, 0, 0], atol=1e-6
    )


def weights(params: Any) -> list[np.ndarray]:
    """The matrices of all layers."""
    leaves = jax.tree_util.tree_leaves_with_path(params)
    return [np.asarray(leaf) for path, leaf in leaves if "kernel" in jax.tree_util.keystr(path)]


def decisions(count: int, spec: Any) -> Batch:
    """Random ones."""
    rng = np.random.default_rng(0)
    sizes = {"obs": (spec.obs,), "next_obs": (spec.obs,), "action": (spec.act,)}
    sizes["next_action"] = sizes["action"]
    rows = {name: rng.uniform(-1, 1, (count, *sizes.get(name, ()))) for name in Batch._fields}
    return Batch(**{name: jnp.float32(row) for name, row in rows.items()})


@pytest.mark.parametrize("algo", ["sac", "ddpg", "flash_sac", "hybrid_stochastic"])
def test_rates_are_whole_at_first_and_zero_at_the_end(algo):
    """Of the learner of a policy, and of that of a model in the last of the methods."""
    agent = build(load(algo, "task=pendulum", "schedule=linear")).agent
    states = {name: begun(learner, agent.spec) for name, learner in agent.learners.items()}
    owned = [learner.params(states[name]) for name, learner in agent.learners.items()]
    params = Params(**{role: value for each in owned for role, value in each.items()})
    scheduled = {name: of for name, of in agent.learners.items() if hasattr(of, "schedule")}
    assert "policy" in scheduled
    for name, learner in scheduled.items():
        rows = decisions(learner.batch_size * learner.batches, agent.spec)

        @partial(jax.jit, static_argnums=0)
        def updated(learner, k, state, rows=rows):
            now = params._replace(decisions=k)
            return learner.update(state, now, rows, jax.random.key(1))[0]

        state = states[name]
        for k in range(3):  # so that branches are there to learn from
            state = updated(learner, jnp.int32(k), state)
        given = (learner, 10), (learner, 200), (replace(learner, schedule=None), 10)
        before, early, late, unscheduled = (
            weights(learner.params(after))
            for after in (state, *(updated(of, jnp.int32(k), state) for of, k in given))
        )
        assert len(before) > 1
        for old, one, same, last in zip(before, early, unscheduled, late, strict=True):
            assert (one != old).any()
            np.testing.assert_array_equal(one, same)
            np.testing.assert_allclose(last, old, rtol=1e-5)  # flash_sac normalises its weights
