"""The loop of training for an environment on the host, beside a compiled program.

    u = decide(state)                  in the program, which sends u and goes on
    learners = learn(learners, memory)     in the program     meanwhile
    outcome = copies.step(u)               on the host        meanwhile
    state = observe(state, outcome)    in the program of the next decision, or `close`

It has the interface of `Loop` and draws the same random numbers. `Replay.sample` draws no decision
without its successor in the memory, so what learns from samples needs no outcome of the newest
decision, and learns the same while the environment steps. A learner of `latest` data needs it:
then `close` ends each decision, and learns.

The programs donate the state: the replay memory is not copied. Metrics stay on the device until
the end of a call.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core.batching import where
from hybrid_rl.envs.adapters.external import Copies, External, Outcome
from hybrid_rl.errors import WorldError
from hybrid_rl.outside.acting import NONE, Acting, next_state
from hybrid_rl.outside.sending import Mailbox, send
from hybrid_rl.protocols import Controller
from hybrid_rl.training.agent import AgentState
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loop import METRICS, REPLICATED, SEEDS, Loop, put
from hybrid_rl.training.metrics import outcome
from hybrid_rl.training.wrappers import priced
from hybrid_rl.types import EnvState, Params, PyTree

RESUMED = "the environment begins a new episode, as its own state is in no checkpoint: the "
RESUMED += "decisions after this one differ from those of a run without the interruption"


@dataclass
class HostLoop(Loop):
    """Trains one learner per seed; all environments of all learners step side by side."""

    notes = (RESUMED,)
    early: bool = field(init=False)  # learning without the outcome of the newest decision
    rows: PyTree = field(default=None, init=False)  # shapes [stride, S, ...] of a call's metrics

    def __post_init__(self) -> None:
        """Find out whether all learners can learn early."""
        self.early = all(each.data == "uniform" for each in self.agent.learners.values())

    def trace(self, state: AgentState) -> list[Any]:
        """The traces of the program that decides, and of the one that ends a decision."""
        at, got = jnp.zeros(4, jnp.int32), outcome_like(state.env)
        u = np.zeros((*got.reward.shape, self.agent.spec.act), np.float32)
        self.rows = self.rows_of(jax.eval_shape(jax.vmap(self.step, (0, None)), state, at[0])[1])
        parts = (SEEDS, METRICS, SEEDS, SEEDS, REPLICATED), (SEEDS, METRICS)
        return [
            self.shard(each, *parts, donate_argnums=(0, 1)).trace(state, self.rows, u, got, at)
            for each in (self._act, self._close)
        ]

    def compile(self, state: AgentState) -> "HostProgram":
        """The program (state, first step, rounds) -> (state, metrics)."""
        return HostProgram(self, *map(self.compile_trace, self.trace(state)))

    def step(self, state: AgentState, step: Array) -> tuple[AgentState, dict[str, Array]]:
        """A round of one learner where nothing changes in the environment, for the shapes."""
        u, state, planned = self._decide(state, step)
        state, led = self._observed(state, u, outcome_like(state.env), 1)
        state, learned = self._learn(state, step)
        return state, {**planned, **learned, **led}

    def restarted(self, state: AgentState, obs: np.ndarray) -> AgentState:
        """`state` [S, ...] at the first observations [S, E, o] of new episodes."""

        def one(state: AgentState, obs: Array) -> AgentState:
            first = jax.vmap(self.agent.episode.reset)(jax.random.split(state.key, len(obs)))
            memory = self.agent.replay.interrupted(state.memory, self.agent.spec)
            state = state.replace(env=first.replace(obs=obs), memory=memory)
            return state.replace(control=self._of(state.numbers).first_control())

        return self.shard(jax.vmap(one), SEEDS, SEEDS, donate_argnums=0)(state, obs)

    def _act(self, state: Any, rows: Any, u: Array, got: Outcome, at: Array) -> tuple[Any, Any]:
        """All learners after a decision that is sent, and its metrics in a row of `rows`.

        u [S, E, m], got [S, E, ...]: of the decision before, if it is still to be observed. at:
        the row, the decision of the run, whether there is one before, and the ticket. If there is
        none, the last row of the call is written; its own decision replaces it later.
        """
        row, step, made, ticket = at
        if self.early:
            state, led = jax.vmap(self._observed, (0, 0, 0, None))(state, u, got, made)
            rows = put(rows, led, row - 1)
        u, state, metrics = jax.vmap(self._decide, (0, None))(state, step)
        state = jax.vmap(self._expecting)(state, send(u, ticket, *SEEDS))
        if self.early:
            state, learned = jax.vmap(self._learn, (0, None))(state, step)
            metrics |= learned
        return state, put(rows, metrics, row)

    def _close(self, state: Any, rows: Any, u: Array, got: Outcome, at: Array) -> tuple[Any, Any]:
        """All learners after u [S, E, m], the decision of `at`, led to `got` [S, E, ...]."""
        state, metrics = jax.vmap(self._observed, (0, 0, 0, None))(state, u, got, 1)
        if not self.early:
            state, learned = jax.vmap(self._learn, (0, None))(state, at[1])
            metrics |= learned
        return state, put(rows, metrics, at[0])

    def _decide(self, state: AgentState, step: Array) -> tuple[Array, AgentState, dict[str, Array]]:
        """`Agent.decide` of one learner."""
        return self._of(state.numbers).decide(state, step)

    def _learn(self, state: AgentState, step: Array) -> tuple[AgentState, dict[str, Array]]:
        """`Agent.learn` of one learner."""
        return self._of(state.numbers).learn(state, step)

    def _expecting(self, state: AgentState, u: Array) -> AgentState:
        """One learner whose memory has the actions u [E, m]."""
        return state.replace(memory=self.agent.replay.expecting(state.memory, state.env.obs, u))

    def _observed(
        self, state: AgentState, u: Array, got: Outcome, made: Array | int
    ) -> tuple[AgentState, dict[str, Array]]:
        """One learner after the newest actions u [E, m] had the outcome `got` [E, ...].

        made: 0 if there are none; then the next row of the memory is written, and replaced later.
        """
        (now, after), count = states(self.agent.episode, state.env, got), state.memory.count
        before = state.replace(memory=state.memory.replace(count=count - made))
        seen = self._of(state.numbers).observe(before, u, now, after)
        both = (seen.env, seen.control), (state.env, state.control)
        env, control = where(jnp.asarray(made) > 0, *both)
        memory = seen.memory.replace(count=count)
        return state.replace(env=env, control=control, memory=memory), outcome(u, now)


class HostProgram:
    """What trains: (state, first step, rounds) -> (state, metrics [stride, S, ...])."""

    def __init__(self, loop: HostLoop, act: Any, close: Any) -> None:
        """act, close: compiled."""
        self.loop, self.act, self.close = loop, act, close
        self.memory_analysis = act.memory_analysis
        self.copies: Copies | None = None  # made at the first call

    def __call__(self, state: AgentState, start: Array, rounds: Array) -> tuple[AgentState, Any]:
        """Train for some rounds, as the program of `Loop`; fewer where the environment fails."""
        loop, envs, first, made = self.loop, self.loop.agent.num_envs, int(start), False
        each, count = (len(loop.seeds), envs), int(rounds) * (loop.fault is None)
        if self.copies is None:
            seeds = [seed_of(seed, i) for seed in loop.seeds for i in range(envs)]
            self.copies = copies_of(loop.agent.episode, seeds)
            state = loop.restarted(state, self.copies.reset().reshape(*each, -1))
        rows = jax.tree.map(lambda row: np.zeros(row.shape, row.dtype), loop.rows)
        got = jax.tree.map(np.array, outcome_like(state.env))  # the state itself is donated
        u = np.zeros((*each, loop.agent.spec.act), np.float32)
        with Mailbox(loop.mesh.size) as sent:
            for i in range(count):
                at = np.array([i, first + i * envs, made, sent.ticket], np.int32)
                state, rows = self.act(state, rows, u, got, at)
                u = np.nan_to_num(sent.next(state.memory.count))  # one that diverged ends no others
                try:
                    stepped = self.copies.step(u)
                except WorldError as fault:
                    loop.fault, count = fault, i
                    state = state.replace(memory=state.memory.replace(count=state.memory.count - 1))
                    break
                got = Outcome(*(x.reshape(*each, *x.shape[1:]) for x in stepped))
                u, made = u.reshape(*each, -1), loop.early and i + 1 < count
                if not made:
                    state, rows = self.close(state, rows, u, got, at)
        return state, {name: row[:count] for name, row in jax.device_get(rows).items()}


def outcome_like(env: EnvState) -> Outcome:
    """An outcome with the shapes of those at `env`, where there is none yet."""
    return Outcome(env.obs, env.reward, env.reward, env.terminated, env.truncated, env.obs)


class HostEvaluator:
    """Episodes of every learner under `controller`, on environments that are not those of training.

    It compiles when it is made. params: [S, ...]; keys: [S, N], one per episode, which seed them;
    loop: whose numbers it has, None for none; mode: of the controller.
    """

    def __init__(
        self,
        episode: Episode,
        controller: Controller,
        params: Params,
        keys: Array,
        loop: Loop | None = None,
        mode: str = "full",
    ) -> None:
        """Compile one decision in all of them."""
        numbers = NONE if loop is None else loop.numbers
        self.episode = episode
        self._acting = Acting(episode.spec, controller, keys, numbers, mode)
        self._acting.compile(params)

    def __call__(
        self, params: Params, keys: Array, cut: Callable[[int], Any] = lambda made: False
    ) -> dict[str, np.ndarray] | None:
        """The `return` [S, N] of each episode; None once cut(made).

        Also `success`, if infos say so, and `violations` of a constraint.
        """
        seeds = [seed_of(*map(int, row)) for row in jax.random.key_data(keys).reshape(-1, 2)]
        copies = copies_of(self.episode, seeds)
        self._acting.begin(keys)
        obs, done, totals = copies.reset(), np.zeros(len(seeds), bool), np.zeros((2, len(seeds)))
        flagged, success, made = False, np.zeros(len(seeds)), 0
        while not done.all():
            if cut(made):
                copies.close()
                return None
            u, made = self._acting(params, obs.reshape(*keys.shape, -1)), made + 1
            got = copies.step(u.reshape(len(seeds), -1))
            totals += np.where(done, 0, [got.reward, got.violated])
            if copies.success is not None:
                flagged, success = True, np.where(done, success, copies.success)
            done, obs = done | got.terminated | got.truncated, got.following
        copies.close()
        found = {"return": totals[0]} | ({"success": success} if flagged else {})
        found |= {} if self.episode.constraint is None else {"violations": totals[1]}
        return {name: values.reshape(keys.shape) for name, values in found.items()}


def copies_of(episode: Episode, seeds: Sequence[int], render: str | None = None) -> Copies:
    """A copy of the episode's environment for each seed."""
    assert isinstance(episode.env, External)
    paid = episode.reward, episode.constraint
    return Copies(episode.env, seeds, episode.steps, episode.action_repeat, render, *paid)


def seed_of(*numbers: int) -> int:
    """A seed for Gymnasium that follows from whole numbers."""
    return int(np.random.SeedSequence(numbers).generate_state(1)[0])


def states(episode: Episode, env: EnvState, got: Outcome) -> tuple[EnvState, EnvState]:
    """The states [E] after a decision at `env` [E]: the outcome, and what the next one sees."""
    now = next_state(env, got.obs, got.reward, got.terminated, got.truncated)
    if episode.constraint is not None:
        now = priced(now, episode.constraint, env, jnp.asarray(got.violated))
    first = jax.tree.map(jnp.zeros_like, now)
    return now, where(now.done, first, now).replace(obs=got.following)
