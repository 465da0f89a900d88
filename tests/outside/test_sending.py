"""Learners that learn while the environment steps: what they learn, and what others wait for."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache, partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import small
from hosted import counting
from test_host_loop import ROUNDS, STEPS, agents

from hybrid_rl.errors import WorldError
from hybrid_rl.learners.return_scale import ReturnScale
from hybrid_rl.outside import sending
from hybrid_rl.outside.sending import Mailbox, send
from hybrid_rl.run.members import loop_of
from hybrid_rl.settings import build as config
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loop import REPLICATED, SEEDS

E = 2  # environments of each of the two learners


@cache
def compiled(algo: str, early: bool, latest: bool) -> tuple[Any, Any, Any]:
    """A loop in `Count` with a memory of five rounds, its first state and its program.

    latest: with one more learner, of the latest decision.
    """
    agent = config.build(small.load(algo, "task=point_mass", f"num_envs={E}")).agent
    if latest:
        agent = replace(agent, learners={"scale": ReturnScale(num_envs=E), **agent.learners})
    replay, episode = replace(agent.replay, capacity=5 * E), Episode(counting(), STEPS)
    loop = loop_of(replace(agent, replay=replay, episode=episode), (0, 1), ROUNDS)
    loop.early &= early
    first = loop.init()
    return loop, first, loop.compile(first)


def run(
    algo: str,
    fail: str = "",
    early: bool = True,
    latest: bool = False,
    calls: tuple[int, ...] = (ROUNDS,),
) -> tuple[Any, Any]:
    """State and metrics [rounds, ...] after calls of so many rounds each."""
    loop, first, program = compiled(algo, early, latest)
    loop.agent = replace(loop.agent, episode=Episode(counting(fail=fail), STEPS))
    program.copies = None  # new ones
    state, parts, step = jax.jit(partial(jax.tree.map, jnp.copy))(first), [], 0  # it is donated
    for rounds in calls:
        state, metrics = program(state, jnp.int32(step), jnp.int32(rounds))
        parts.append(jax.tree.map(lambda m, n=rounds: m[:n], metrics))
        step += rounds * E
    return state, jax.tree.map(lambda *m: np.concatenate(m), *parts)


def numbers(*leaves: Any) -> Iterator[Any]:
    """Keys as numbers."""
    for x in leaves:
        yield jax.random.key_data(x) if jnp.issubdtype(x.dtype, jax.dtypes.prng_key) else x


@pytest.mark.parametrize(("algo", "loss"), [("sac", "sac/critic_loss"), ("nn_mppi", "model/loss")])
def test_it_learns_what_it_learns_after_the_step(algo, loss):
    """From the first update on, with its metrics; the NaN of what is not known yet would spread."""
    assert compiled(algo, True, False)[0].early
    early, late = (run(algo, early=each) for each in (True, False))
    for a, b in zip(*map(jax.tree.leaves, (early, late)), strict=True):
        np.testing.assert_allclose(*numbers(a, b), rtol=1e-5, atol=1e-6)
    assert np.isfinite(early[1][loss][2:]).all()


@pytest.mark.parametrize(("latest", "closed"), [(False, 1), (True, 3)])
def test_only_a_learner_of_the_latest_decision_waits_for_it(latest, closed, monkeypatch):
    """After each of three decisions; the scale of returns, as flash_sac has it, is one."""
    program, calls = compiled("sac", True, latest)[2], []
    close = program.close
    monkeypatch.setattr(program, "close", lambda *given: (calls.append(1), close(*given))[1])
    run("sac", latest=latest, calls=(3,))
    assert len(calls) == closed


def test_a_run_does_not_depend_on_where_its_calls_end(monkeypatch):
    """Bit by bit, as the time that a call takes chooses its number of rounds; nor on waiting."""
    monkeypatch.setattr(sending, "POLL_S", 1e-5)
    whole, parts = run("sac"), run("sac", calls=(1, 4, ROUNDS - 5))
    for a, b in zip(*map(jax.tree.leaves, (whole, parts)), strict=True):
        np.testing.assert_array_equal(*numbers(a, b))
    assert np.isfinite(whole[0].memory.rows).all()


def test_an_error_in_the_environment_ends_the_call(monkeypatch):
    loop = compiled("sac", True, False)[0]
    monkeypatch.setattr(loop, "fault", None)
    state, metrics = run("sac", fail="error", calls=(ROUNDS, 1))
    with pytest.raises(WorldError, match="ValueError: motor off"):
        raise loop.fault
    assert state.memory.count.tolist() == [1, 1]  # without the decision that failed
    assert len(metrics["episode/done"]) == 1
    assert not sending._boxes


@pytest.mark.parametrize(
    ("raised", "line"), [(ArithmeticError("of deciding"), "of deciding"), (None, "without sending")]
)
def test_nothing_is_awaited_from_a_program_that_ended(raised, line, monkeypatch):
    """Before it sent; the first time it is asked, it still runs."""

    class Result:
        asked = 0

        def is_ready(self) -> bool:
            self.asked += 1
            return self.asked > 1

        def block_until_ready(self) -> None:
            if raised:
                raise raised

    monkeypatch.setattr(sending, "POLL_S", 0.01)
    with pytest.raises((ArithmeticError, RuntimeError), match=line), sending.Mailbox(1) as sent:
        sent.next(Result())


@pytest.mark.parametrize("backend", ["cpu", "gpu"])
def test_the_host_gets_what_a_program_sends_once(backend, monkeypatch):
    """By either way of sending; what an accelerator sends also if the program does not use it."""
    monkeypatch.setattr(jax, "default_backend", lambda: backend)
    loop = loop_of(agents(1)[1], (0,), ROUNDS)
    u = np.arange(6, dtype=np.float32).reshape(1, 3, 2)

    def program(u, ticket):
        sent = send(u, ticket, *SEEDS)
        return 2 * (sent if backend == "cpu" else u)

    compiled = loop.shard(program, (SEEDS, REPLICATED), SEEDS)
    with Mailbox(1) as sent:
        for _ in range(3):
            result = compiled(u, np.int32(sent.ticket))
            np.testing.assert_array_equal(sent.next(result), u[0])
            np.testing.assert_array_equal(result, 2 * u)
        assert sent._box.empty()
