"""Learning rates that fall along a run, in every learner that has a schedule."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from small import load

from hybrid_rl.schedules.linear import LinearDecay
from hybrid_rl.settings.build import build

pytestmark = pytest.mark.turns(3)

METHODS = ("sac", "ddpg", "flash_sac", "hybrid_stochastic")  # the last one learns models, too


def weights(agent: Any, state: Any) -> list[np.ndarray]:
    """The matrices of all layers that learn."""
    leaves = jax.tree_util.tree_leaves_with_path(agent.params(state))
    return [np.asarray(leaf) for path, leaf in leaves if "kernel" in jax.tree_util.keystr(path)]


def test_the_factor_is_one_then_falls_to_zero():
    falling = jax.vmap(LinearDecay(decisions=100, share=0.4).factor)
    np.testing.assert_allclose(
        falling(jnp.array([0, 59, 60, 80, 99, 100, 120])), [1, 1, 1, 0.5, 0.025, 0, 0], atol=1e-6
    )


def test_without_a_length_it_is_refused():
    with pytest.raises(ValueError, match="decisions=null: must be those of the whole run"):
        LinearDecay()


def test_a_resumed_run_with_more_decisions_lowers_the_rates_at_its_own_end():
    made = load("hybrid_stochastic", "task=pendulum", "schedule=linear")
    for made.total_steps in (200, 300):  # as `train resume=DIR total_steps=300` does
        learners = build(made).agent.learners
        assert {each.schedule for each in learners.values()} == {LinearDecay(made.total_steps)}


@pytest.mark.parametrize("algo", METHODS)
def test_rates_are_whole_at_first_and_zero_at_the_end(algo):
    given = [algo, "task=pendulum"]  # the policy acts, as a planner compiles long
    given += ["controllers.full=${actor}"] if algo == "hybrid_stochastic" else []
    known, agent = (build(load(*given, *more)).agent for more in ([], ["schedule=linear"]))
    state = jax.jit(agent.init)(jax.random.key(0))
    plain, step = jax.jit(known.step), jax.jit(agent.step)
    for k in range(10):
        state = step(state, jnp.int32(k))[0]
    before = weights(agent, state)
    early, late, unscheduled = (
        weights(agent, decide(state, jnp.int32(k))[0])
        for decide, k in ((step, 10), (step, 200), (plain, 10))
    )
    assert len(before) > 2
    for old, one, plain, last in zip(before, early, unscheduled, late, strict=True):
        assert (one != old).any()
        np.testing.assert_array_equal(one, plain)
        np.testing.assert_allclose(last, old, rtol=1e-5)  # flash_sac normalises its weights
