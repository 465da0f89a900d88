"""The loop of training for an environment on the host, between two compiled programs.

    u = decide(state)        on the device
    outcome = copies.step(u)         on the host
    state = learn(state, outcome)    on the device

It has the interface of `Loop` and draws the same random numbers. Both programs donate the state:
the replay memory is not copied. Metrics stay on the device until the end of a call.

With `overlap` of the environment a thread learns while the environment steps. Actions are then
chosen before the learning from the decision before them begins; `decide` gets that one's outcome,
and donates nothing.

    u' = decide(state, outcome)
    state = learn(state, outcome)    in a thread, meanwhile on the host
    outcome' = copies.step(u')
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from time import perf_counter
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core.branching import where
from hybrid_rl.envs.adapters.copies import Copies, Outcome
from hybrid_rl.envs.adapters.external import External
from hybrid_rl.protocols import Controller
from hybrid_rl.training.agent import AgentState
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.keys import Keys
from hybrid_rl.training.loop import METRICS, REPLICATED, SEEDS, Loop
from hybrid_rl.training.metrics import outcome
from hybrid_rl.training.rollout import act
from hybrid_rl.types import EnvState, Params

RESUMED = "the environment begins a new episode, as its own state is in no checkpoint: the "
RESUMED += "decisions after this one differ from those of a run without the interruption"


@dataclass
class HostLoop(Loop):
    """Trains one learner per seed; all environments of all learners step side by side."""

    deciding: Any = field(default=None, init=False)  # the trace of the first program
    rows: Any = field(default=None, init=False)  # shapes [stride, S, ...] of the metrics of a call

    @property
    def overlap(self) -> bool:
        """Whether a thread learns while the environment steps."""
        return getattr(self.agent.episode.env, "overlap", False)

    @property
    def notes(self) -> tuple[str, ...]:
        """What a resumed run says about its environments."""
        return (RESUMED,)

    def trace(self, state: AgentState) -> Any:
        """The trace of the program that learns; that of the other one is kept."""
        began, zero = perf_counter(), jnp.zeros((), jnp.int32)
        got, axes = _standing(state.env), (0, 0, 0, 0, None)
        given: tuple = (*_read(state), zero)
        if self.overlap:
            axes, given = (*axes, 0, None), (*given, got, jnp.zeros((), bool))
        decide = jax.vmap(self._decide, axes)
        parts = tuple(REPLICATED if axis is None else SEEDS for axis in axes), SEEDS
        donated = () if self.overlap else 1  # the learning that follows gets all of the state
        self.deciding = self.shard(decide, *parts, donate_argnums=donated).trace(*given)
        u, _, planned = jax.eval_shape(decide, *given)
        parts = (SEEDS, METRICS, SEEDS, SEEDS, SEEDS, REPLICATED, REPLICATED), (SEEDS, METRICS)
        self.rows = jax.eval_shape(self._rows, state, planned, u, got, zero)
        learn = self.shard(self._learn, *parts, donate_argnums=(0, 1))
        traced = learn.trace(state, self.rows, planned, u, got, zero, zero)
        self.compile_s += perf_counter() - began
        return traced

    def compile(self, state: AgentState, traced: Any = None) -> "HostProgram":
        """The program (state, first step, rounds) -> (state, metrics)."""
        learn = super().compile(state, self.trace(state) if traced is None else traced)
        return HostProgram(self, super().compile(state, self.deciding), learn)

    def copies(self) -> Copies:
        """The environments [S * E] of training, each with a seed of its own."""
        seeds = [seed_of(seed, i) for seed in self.seeds for i in range(self.agent.num_envs)]
        return copies_of(self.agent.episode, seeds)

    def restarted(self, state: AgentState, obs: np.ndarray) -> AgentState:
        """`state` [S, ...] at the first observations [S, E, o] of new episodes."""

        def one(state: AgentState, obs: Array) -> AgentState:
            first = jax.vmap(self.agent.episode.reset)(jax.random.split(state.key, len(obs)))
            memory = self.agent.replay.interrupted(state.memory, self.agent.spec)
            state = state.replace(env=first.replace(obs=obs), memory=memory)
            return state.replace(control=self.agent.first_control())

        return self.shard(jax.vmap(one), SEEDS, SEEDS, donate_argnums=0)(state, obs)

    def _decide(
        self,
        learners: Any,
        control: Any,
        env: Any,
        key: Any,
        step: Any,
        got: Any = None,
        *made: Any,
    ) -> tuple[Array, Any, dict[str, Array]]:
        """Actions [E, m] of one learner, the states of its controllers, and metrics.

        got: with overlap, the outcome [E, ...] of a decision at `env`, if one was `made` [].
        """
        if got is not None:
            now, after = states(env, got)
            begun = where(now.done, self.agent.first_control(), control)
            following = begun, after, Keys.of(key, self.agent.num_envs).next
            control, env, key = where(made[0], following, (control, env, key))
        memory: Any = None
        state = AgentState(env, control, memory, learners, key)
        u, after, planned = self.agent.decide(state, step)
        return u, after.control, planned

    def _step(
        self, state: AgentState, planned: Any, u: Array, got: Outcome, step: Array
    ) -> tuple[AgentState, dict[str, Array]]:
        """One learner after its actions u [E, m] had the outcome `got` [E, ...]."""
        now, after = states(state.env, got)
        state, learned = self.agent.learn(self.agent.observe(state, u, now, after), step)
        return state, {**planned, **learned, **outcome(u, now)}

    def _learn(
        self, state: Any, rows: Any, planned: Any, u: Array, got: Outcome, i: Array, step: Array
    ) -> tuple[Any, Any]:
        """All learners, and their metrics in row i of `rows` [stride, S, ...]."""
        state, metrics = jax.vmap(self._step, (0, 0, 0, 0, None))(state, planned, u, got, step)
        put = partial(jax.lax.dynamic_update_index_in_dim, index=i, axis=0)
        return state, jax.tree.map(lambda row, m: put(row, m), rows, metrics)

    def _rows(self, *arguments: Any) -> Any:
        """Rows [stride, S, ...] of zeros for the metrics of one call; arguments: of `_step`."""
        shapes = jax.eval_shape(jax.vmap(self._step, (0, 0, 0, 0, None)), *arguments)[1]
        return jax.tree.map(lambda m: jnp.zeros((self.stride, *m.shape), m.dtype), shapes)


class HostProgram:
    """What trains: (state, first step, rounds) -> (state, metrics [stride, S, ...])."""

    def __init__(self, loop: HostLoop, decide: Any, learn: Any) -> None:
        """decide, learn: the compiled halves."""
        self.loop, self.decide, self.learn = loop, decide, learn
        self.memory_analysis = learn.memory_analysis
        self.copies: Copies | None = None  # made at the first call
        self.ahead: Any = None  # with overlap, what was decided for the next call

    def __call__(self, state: AgentState, start: Array, rounds: Array) -> tuple[AgentState, Any]:
        """As the program of `Loop`.

        Raises:
            WorldError: if an environment raises an error, gives NaN, or takes too long.
        """
        loop, envs, first = self.loop, self.loop.agent.num_envs, int(start)
        each = (len(loop.seeds), envs)
        if self.copies is None:
            self.copies = loop.copies()
            state = loop.restarted(state, self.copies.reset().reshape(*each, -1))
        rows = jax.tree.map(lambda row: np.zeros(row.shape, row.dtype), loop.rows)
        steps = [np.int32(first + i * envs) for i in range(int(rounds))]
        state, rows = (self._overlapping if loop.overlap else self._in_turn)(state, rows, steps)
        return state, jax.device_get(rows)

    def _in_turn(self, state: AgentState, rows: Any, steps: list[np.int32]) -> tuple[Any, Any]:
        """Learning from each decision ends before the next one."""
        for i, step in enumerate(steps):
            u, control, planned = self.decide(*_read(state), step)
            state = state.replace(control=control)
            state, rows = self.learn(state, rows, planned, u, self._outcome(u), np.int32(i), step)
        return state, rows

    def _overlapping(self, state: AgentState, rows: Any, steps: list[np.int32]) -> tuple[Any, Any]:
        """Learning from a decision runs while the environment makes the next one.

        That one, also the first of the next call, was chosen before, so that a run does not depend
        on where its calls end.
        """

        def learn() -> tuple[Any, Any]:
            return state, rows

        with ThreadPoolExecutor(1) as thread:
            for i, step in enumerate(steps):
                u, control, planned = self.ahead or self._ahead(state, step)
                learning = thread.submit(learn)
                got = self._outcome(u)
                state, rows = learning.result()
                state = state.replace(control=control)
                self.ahead = self._ahead(state, step + np.int32(self.loop.agent.num_envs), got)
                learn = partial(self.learn, state, rows, planned, u, got, np.int32(i), step)
        return learn()

    def _ahead(self, state: AgentState, step: np.int32, got: Outcome | None = None) -> tuple:
        """Decision `step`, after one at `state` that had the outcome `got`, if any.

        It waits for the actions, as learning is then given what was read.
        """
        after = (got or _standing(state.env), np.bool_(got is not None))
        u, *rest = self.decide(*_read(state), step, *after)
        return np.asarray(u), *rest

    def _outcome(self, u: Any) -> Outcome:
        """What the actions u [S, E, m] lead to, [S, E, ...]."""
        assert self.copies is not None
        got = self.copies.step(np.asarray(u).reshape(-1, u.shape[-1]))
        return Outcome(*(value.reshape(*u.shape[:2], *value.shape[1:]) for value in got))


def _standing(env: EnvState) -> Outcome:
    """An outcome of the shapes of one at `env`, for a decision that has none before it."""
    return Outcome(env.obs, env.reward, env.terminated, env.truncated, env.obs)


def _read(state: AgentState) -> tuple:
    """What deciding reads of the state; not the memory, as each array of a call takes time."""
    return state.learners, state.control, state.env, state.key


class HostEvaluator:
    """Episodes of every learner under `controller`, on environments that are not those of training.

    It compiles when it is made. params: [S, ...]; keys: [S, N], one per episode, which seed them.
    """

    def __init__(
        self, episode: Episode, controller: Controller, params: Params, keys: Array
    ) -> None:
        """Compile one decision in all of them."""
        self.episode, rest, shape = episode, controller.init(episode.spec), keys.shape
        self.control = jax.tree.map(lambda x: jnp.broadcast_to(x, (*shape, *x.shape)), rest)
        empty = episode.reset(jax.random.key(0))

        def decide(params: Params, control: Any, obs: Array, keys: Array) -> tuple:
            env = jax.tree.map(lambda x: jnp.broadcast_to(x, (len(obs), *x.shape)), empty)
            keys, now = jnp.moveaxis(jax.vmap(jax.random.split)(keys), 1, 0)
            u, control, _ = act(controller, params, control, env.replace(obs=obs), now)
            return u, control, keys

        obs = np.zeros((*shape, episode.spec.obs), np.float32)
        program = jax.jit(jax.vmap(decide), donate_argnums=1)
        self._decide = program.lower(params, self.control, obs, keys).compile()

    def __call__(
        self, params: Params, keys: Array, cut: Callable[[], bool] = lambda: False
    ) -> dict[str, np.ndarray] | None:
        """The `return` [S, N] of each episode; None once `cut` is true."""
        shape, control = keys.shape, jax.tree.map(jnp.copy, self.control)
        seeds = [seed_of(*map(int, row)) for row in jax.random.key_data(keys).reshape(-1, 2)]
        copies = copies_of(self.episode, seeds)
        obs, done, returns = copies.reset(), np.zeros(len(seeds), bool), np.zeros(len(seeds))
        while not done.all():
            if cut():
                copies.close()
                return None
            u, control, keys = self._decide(params, control, obs.reshape(*shape, -1), keys)
            got = copies.step(np.asarray(u).reshape(len(seeds), -1))
            returns += np.where(done, 0, got.reward)
            done, obs = done | got.terminated | got.truncated, got.following
        copies.close()
        return {"return": returns.reshape(shape)}


def copies_of(episode: Episode, seeds: Sequence[int]) -> Copies:
    """A copy of the episode's environment for each seed."""
    assert isinstance(episode.env, External)
    return episode.env.copies(seeds, episode.steps, episode.action_repeat)


def seed_of(*numbers: int) -> int:
    """A seed for Gymnasium that follows from whole numbers."""
    return int(np.random.SeedSequence(numbers).generate_state(1)[0])


def states(env: EnvState, got: Outcome) -> tuple[EnvState, EnvState]:
    """The states [E] after a decision at `env` [E]: the outcome, and what the next one sees."""
    clock = {"decision": env.info["decision"] + 1, "return": env.info["return"] + got.reward}
    now = env.replace(
        obs=got.obs,
        reward=got.reward,
        terminated=got.terminated,
        truncated=got.truncated,
        info={**env.info, **clock},
    )
    first = jax.tree.map(jnp.zeros_like, now)
    return now, where(now.done, first, now).replace(obs=got.following)
