"""Learners that learn while the environment steps: what they learn, and what others wait for."""

import threading
from dataclasses import replace
from functools import cache
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import small
from test_host_loop import ROUNDS, STEPS, counting

from hybrid_rl import config
from hybrid_rl.errors import WorldError
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loops import loop_of

pytestmark = pytest.mark.turns(3)

E = 2  # environments of each of the two learners


@cache
def compiled(algo: str, fail: str = "") -> tuple[Any, Any]:
    """A loop in `Count`, and its program."""
    given = "task=point_mass", f"algo={algo}", f"num_envs={E}"
    agent = config.build(small.load(algo, *given)).agent
    loop = loop_of(replace(agent, episode=Episode(counting(fail=fail), STEPS)), (0, 1), ROUNDS)
    return loop, loop.compile(loop.init())


def run(*of: str, calls: tuple[int, ...] = (ROUNDS,)) -> tuple[Any, Any]:
    """State and metrics [rounds, ...] after calls of so many rounds each."""
    loop, program = compiled(*of)
    program.copies = None
    state, parts, step = loop.init(), [], 0
    for rounds in calls:
        state, metrics = program(state, jnp.int32(step), jnp.int32(rounds))
        parts.append(jax.tree.map(lambda m, n=rounds: m[:n], metrics))
        step += rounds * E
    return state, jax.tree.map(lambda *m: np.concatenate(m), *parts)


def equal(*trees: Any) -> None:
    """Bit by bit; keys as numbers."""
    keys = jax.dtypes.prng_key
    for pair in zip(*map(jax.tree.leaves, trees), strict=True):
        np.testing.assert_array_equal(
            *(jax.random.key_data(x) if jnp.issubdtype(x.dtype, keys) else x for x in pair)
        )


@pytest.mark.parametrize("algo", ["sac", "hybrid_stochastic"])
def test_it_learns_bit_by_bit_what_it_learns_after_the_step(algo, monkeypatch):
    """Also in the first update; what is not known yet is NaN in the memory, which would spread."""
    program = compiled(algo)[1]
    assert program.early
    early = run(algo)
    monkeypatch.setattr(program, "early", False)
    equal(early, run(algo))
    assert np.isfinite(early[1]["sac/critic_loss"][2:]).all()
    assert not any(np.isnan(leaf).any() for leaf in jax.tree.leaves(early[0].learners))


@pytest.mark.parametrize(("algo", "first"), [("sac", "learn"), ("flash_sac", "step")])
def test_only_a_learner_of_the_latest_decision_waits_for_it(algo, first, monkeypatch):
    """The scale of returns of flash_sac is one."""
    loop, program = compiled(algo)
    run(algo, calls=(1,))
    order = []

    def noted(name: str, of: Any, method: str) -> None:
        call = getattr(of, method)
        monkeypatch.setattr(of, method, lambda *given: (order.append(name), call(*given))[1])

    noted("learn", program, "learn")
    noted("step", program, "_outcome")
    run(algo, calls=(2,))
    assert order == 2 * [first, *{"learn", "step"} - {first}]


def test_a_run_does_not_depend_on_where_its_calls_end():
    """Bit by bit, as the time that a call takes chooses its number of rounds."""
    equal(run("sac"), run("sac", calls=(1, 4, ROUNDS - 5)))


def test_an_error_of_either_side_ends_the_call(monkeypatch):
    """And no thread stays behind."""
    threads = threading.active_count()
    with pytest.raises(WorldError, match="ValueError: motor off"):
        run("sac", "error")

    def broken(*_: Any) -> None:
        raise ArithmeticError("of learning")

    monkeypatch.setattr(compiled("sac")[1], "learn", broken)
    with pytest.raises(ArithmeticError, match="of learning"):
        run("sac")
    assert threading.active_count() == threads
