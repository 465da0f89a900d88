"""The loop of training for an environment on the host, between three compiled programs.

    u = decide(state)                      on the device
    learners = learn(learners, memory)     on the device, meanwhile
    outcome = copies.step(u)                   on the host
    state = observe(state, outcome)        on the device

It has the interface of `Loop` and draws the same random numbers. `Replay.sample` draws no decision
without its successor in the memory, so what learns from samples needs no outcome of the newest
decision: it learns bit for bit the same while the environment steps. A learner of `latest` data
does need it, and then learning comes last.

The programs run one after another in the order of their calls, which do not wait for them, and
donate what they change: the replay memory is not copied. Metrics stay on the device until the end
of a call.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from time import perf_counter
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core.branching import where
from hybrid_rl.data.replay import Memory
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

    sides: Any = field(default=None, init=False)  # the traces of `decide` and `observe`
    rows: Any = field(default=None, init=False)  # [stride, S, ...] of the metrics of each program

    @property
    def notes(self) -> tuple[str, ...]:
        """What a resumed run says about its environments."""
        return (RESUMED,)

    def trace(self, state: AgentState) -> Any:
        """The trace of the program that learns; those of the others are kept."""
        began, at = perf_counter(), jnp.zeros(2, jnp.int32)
        acting, learned = _parts(state)
        u = jax.eval_shape(jax.vmap(self.agent.decide, (0, None)), state, at[1])[0]

        def traced(f: Callable[..., Any], *given: Any, outs: int) -> tuple[Any, Any]:
            """Of f(*given, step) -> (*outs, metrics), whose first argument is donated."""
            batched = jax.vmap(f, (*[0] * len(given), None))
            rows = jax.tree.map(self._row, jax.eval_shape(batched, *given, at[1])[-1])

            def program(*given: Any) -> Any:
                *given, rows, at = given
                *found, metrics = batched(*given, at[1])
                put = partial(jax.lax.dynamic_update_index_in_dim, index=at[0], axis=0)
                return *found, jax.tree.map(lambda row, m: put(row, m), rows, metrics)

            parts = (*[SEEDS] * len(given), METRICS, REPLICATED), (*[SEEDS] * outs, METRICS)
            sharded = self.shard(program, *parts, donate_argnums=(0, len(given)))
            return sharded.trace(*given, rows, at), rows

        decide = traced(self._decide, acting, learned, outs=2)
        observe = traced(self._observe, acting, u, _standing(state.env), outs=1)
        learn = traced(self._learn, learned, state.memory, outs=1)
        self.sides, self.rows = (decide[0], observe[0]), (decide[1], observe[1], learn[1])
        self.compile_s += perf_counter() - began
        return learn[0]

    def compile(self, state: AgentState, traced: Any = None) -> "HostProgram":
        """The program (state, first step, rounds) -> (state, metrics)."""
        learn = super().compile(state, self.trace(state) if traced is None else traced)
        decide, observe = (super(HostLoop, self).compile(state, side) for side in self.sides)
        return HostProgram(self, decide, observe, learn)

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
        self, acting: "Acting", learned: "Learned", step: Array
    ) -> tuple[Array, "Acting", dict[str, Array]]:
        """Actions [E, m] of one learner, which its memory has now, and metrics."""
        u, state, planned = self.agent.decide(_joined(acting, learned), step)
        memory = self.agent.replay.expecting(acting.memory, acting.env.obs, u)
        return u, Acting(acting.env, state.control, memory), planned

    def _observe(
        self, acting: "Acting", u: Array, got: Outcome, _: Array
    ) -> tuple["Acting", dict[str, Array]]:
        """One learner after its actions u [E, m] had the outcome `got` [E, ...]."""
        now, after = states(acting.env, got)
        memory = acting.memory.replace(count=acting.memory.count - 1)  # the row is written again
        state = _joined(acting._replace(memory=memory), Learned({}, jax.random.key(0)))
        return _parts(self.agent.observe(state, u, now, after))[0], outcome(u, now)

    def _learn(
        self, learned: "Learned", memory: Memory, step: Array
    ) -> tuple["Learned", dict[str, Array]]:
        """One learner after the updates of a decision."""
        state = _joined(Acting(None, None, memory), learned)
        state, metrics = self.agent.learn(state, step)
        return _parts(state)[1], metrics

    def _row(self, metric: Any) -> jax.ShapeDtypeStruct:
        """Of a metric [S, ...] in each round of a call, [stride, S, ...]."""
        return jax.ShapeDtypeStruct((self.stride, *metric.shape), metric.dtype)


class Acting(NamedTuple):
    """What deciding and observing change of an agent's state."""

    env: Any
    control: Any
    memory: Memory


class Learned(NamedTuple):
    """What learning changes of it."""

    learners: Any
    key: Array


class HostProgram:
    """What trains: (state, first step, rounds) -> (state, metrics [stride, S, ...])."""

    def __init__(self, loop: HostLoop, decide: Any, observe: Any, learn: Any) -> None:
        """decide, observe, learn: compiled."""
        self.loop, self.decide, self.observe, self.learn = loop, decide, observe, learn
        self.memory_analysis = learn.memory_analysis
        self.early = all(each.data == "uniform" for each in loop.agent.learners.values())
        self.copies: Copies | None = None  # made at the first call

    def __call__(self, state: AgentState, start: Array, rounds: Array) -> tuple[AgentState, Any]:
        """As the program of `Loop`.

        Raises:
            WorldError: if an environment raises an error, gives NaN, or takes too long.
        """
        loop, count = self.loop, np.arange(int(rounds), dtype=np.int32)
        envs = loop.agent.num_envs
        if self.copies is None:
            self.copies = loop.copies()
            obs = self.copies.reset().reshape(len(loop.seeds), envs, -1)
            state = loop.restarted(state, obs)
        acting, learned = _parts(state)
        planned, led, metrics = jax.tree.map(lambda row: np.zeros(row.shape, row.dtype), loop.rows)
        for at in np.stack((count, int(start) + count * envs), 1):  # row, decision of the run
            u, acting, planned = self.decide(acting, learned, planned, at)
            if self.early:
                learned, metrics = self.learn(learned, acting.memory, metrics, at)
            acting, led = self.observe(acting, u, self._outcome(u), led, at)
            if not self.early:
                learned, metrics = self.learn(learned, acting.memory, metrics, at)
        return _joined(acting, learned), jax.device_get({**planned, **metrics, **led})

    def _outcome(self, u: Any) -> Outcome:
        """What the actions u [S, E, m] lead to, [S, E, ...]."""
        assert self.copies is not None
        got = self.copies.step(np.asarray(u).reshape(-1, u.shape[-1]))
        return Outcome(*(value.reshape(*u.shape[:2], *value.shape[1:]) for value in got))


def _standing(env: EnvState) -> Outcome:
    """An outcome of the shapes of one at `env`."""
    return Outcome(env.obs, env.reward, env.terminated, env.truncated, env.obs)


def _parts(state: AgentState) -> tuple[Acting, Learned]:
    """The two parts of a state."""
    return Acting(state.env, state.control, state.memory), Learned(state.learners, state.key)


def _joined(acting: Acting, learned: Learned) -> AgentState:
    """The state of the two parts."""
    return AgentState(*acting, *learned)


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
