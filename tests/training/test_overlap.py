"""An environment that steps while a thread learns: actions are chosen one update earlier."""

import threading
from dataclasses import replace
from functools import cache
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import small
from test_host_loop import ROUNDS, STEPS, Count

from hybrid_rl import config
from hybrid_rl.envs.adapters.copies import Outcome
from hybrid_rl.envs.adapters.external import External
from hybrid_rl.errors import WorldError
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loops import loop_of

pytestmark = pytest.mark.turns(3)

E = 2  # environments of each of the two learners


@cache
def compiled(overlap: bool, learns: bool, algo: str = "sac", fail: str = "") -> tuple[Any, Any]:
    """A loop in `Count`, and its program."""
    given = "task=point_mass", f"num_envs={E}", "random_steps=4"
    agent = config.build(small.load(algo, *given)).agent
    env = External(make=Count, kwargs={"fail": fail}, overlap=overlap)
    agent = replace(agent, episode=Episode(env, STEPS), first_update=0 if learns else 1000)
    loop = loop_of(agent, (0, 1), ROUNDS)
    return loop, loop.compile(loop.init())


def run(*given: Any, calls: tuple[int, ...] = (ROUNDS,), **options: Any) -> tuple[Any, Any]:
    """State and metrics [rounds, ...] after calls of so many rounds each."""
    loop, program = compiled(*given, **options)
    program.copies = program.ahead = None
    state, parts, step = loop.init(), [], 0
    for rounds in calls:
        state, metrics = program(state, jnp.int32(step), jnp.int32(rounds))
        parts.append(jax.tree.map(lambda m, n=rounds: m[:n], metrics))
        step += rounds * E
    return state, jax.tree.map(lambda *m: np.concatenate(m), *parts)


def numbers(tree: Any) -> list[np.ndarray]:
    """Its arrays, keys as numbers."""
    keys = jax.dtypes.prng_key
    return [
        np.array(jax.random.key_data(x) if jnp.issubdtype(x.dtype, keys) else x)
        for x in jax.tree.leaves(tree)
    ]


@pytest.mark.parametrize("algo", ["sac", "nn_mppi"])
def test_learners_that_do_not_change_decide_the_same(algo):
    """Memory, controllers, episodes, keys and metrics, where episodes end in between."""
    without, overlapping = (run(each, False, algo=algo) for each in (False, True))
    for a, b in zip(numbers(without), numbers(overlapping), strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-5, atol=1e-6)


def test_learners_that_change_decide_one_update_later():
    """As a loop in turn that keeps the learners of one decision before, and decides with them."""
    loop, _ = compiled(True, True)
    decide = jax.jit(jax.vmap(loop.agent.decide, (0, None)))
    follow = jax.jit(jax.vmap(loop._step, (0, None, 0, 0, None)))
    copies = loop.copies()
    state = loop.restarted(loop.init(), copies.reset().reshape(2, E, -1))
    older = state.learners
    for step in range(0, ROUNDS * E, E):
        u, after, _ = decide(state.replace(learners=older), step)
        older = state.learners
        got = copies.step(np.asarray(u).reshape(2 * E, -1))
        got = Outcome(*(x.reshape(2, E, *x.shape[1:]) for x in got))
        state = follow(state.replace(control=after.control), {}, u, got, step)[0]
    (late, _), (prompt, _) = run(True, True), run(False, True)
    for a, b in zip(numbers(state), numbers(late), strict=True):
        np.testing.assert_allclose(a, b, rtol=2e-4, atol=1e-5)
    assert np.abs(late.memory.rows - prompt.memory.rows).max() > 1e-4


def test_a_run_does_not_depend_on_where_its_calls_end():
    """Bit by bit, as the time that a call takes chooses its number of rounds."""
    whole, parts = run(True, True), run(True, True, calls=(1, 4, ROUNDS - 5))
    for a, b in zip(numbers(whole), numbers(parts), strict=True):
        np.testing.assert_array_equal(a, b)


def test_the_memory_is_not_copied():
    state, _ = run(True, True)
    address = state.memory.rows.unsafe_buffer_pointer()
    state, _ = compiled(True, True)[1](state, jnp.int32(ROUNDS * E), jnp.int32(3))
    assert state.memory.rows.unsafe_buffer_pointer() == address


def test_an_error_of_either_side_ends_the_call(monkeypatch):
    """And no thread stays behind."""
    threads = threading.active_count()
    with pytest.raises(WorldError, match="ValueError: motor off"):
        run(True, True, fail="error")

    def broken(*_: Any) -> None:
        raise ArithmeticError("of learning")

    monkeypatch.setattr(compiled(True, True)[1], "learn", broken)
    with pytest.raises(ArithmeticError, match="of learning"):
        run(True, True)
    assert threading.active_count() == threads
