"""Learning rates that fall along a run, in every learner that has a schedule."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from small import load

from hybrid_rl.schedules.linear import LinearDecay
from hybrid_rl.settings.build import build
from hybrid_rl.types import Batch

pytestmark = pytest.mark.turns(3)


def test_the_factor_is_one_then_falls_to_zero():
    falling = jax.vmap(LinearDecay(decisions=100, share=0.4).factor)
    np.testing.assert_allclose(
        falling(jnp.array([0, 59, 60, 80, 99, 100, 120])), [1, 1, 1, 0.5, 0.025, 0, 0], atol=1e-6
    )


def test_a_resumed_run_with_more_decisions_lowers_the_rates_at_its_own_end():
    made = load("hybrid_stochastic", "task=pendulum", "schedule=linear")
    for made.total_steps in (200, 300):  # as `train resume=DIR total_steps=300` does
        learners = build(made).agent.learners
        assert {each.schedule for each in learners.values()} == {LinearDecay(made.total_steps)}


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
    words = [algo, "task=pendulum"]
    known, agent = (build(load(*words, *more)).agent for more in ([], ["schedule=linear"]))
    state, params = jax.jit(lambda key: (s := agent.init(key), agent.params(s)))(jax.random.key(0))
    tested = {name for name, learner in agent.learners.items() if hasattr(learner, "schedule")}
    assert {"policy"} <= tested
    for name in tested:
        learner, plain = agent.learners[name], known.learners[name]
        rows = decisions(learner.batch_size * learner.batches, agent.spec)

        @partial(jax.jit, static_argnums=0)
        def updated(learner, k, rows=rows, name=name):
            now = params._replace(decisions=k)
            after = learner.update(state.learners[name], now, rows, jax.random.key(1))[0]
            return learner.params(after)

        before = weights(learner.params(state.learners[name]))
        early, late, unscheduled = (
            weights(updated(of, jnp.int32(k)))
            for of, k in ((learner, 10), (learner, 200), (plain, 10))
        )
        assert len(before) > 1
        for old, one, same, last in zip(before, early, unscheduled, late, strict=True):
            assert (one != old).any()
            np.testing.assert_array_equal(one, same)
            np.testing.assert_allclose(last, old, rtol=1e-5)  # flash_sac normalises its weights
