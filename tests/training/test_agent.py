"""Decisions, observations and updates of an agent, whole and by its parts; pretraining."""

from dataclasses import dataclass, replace
from typing import Any, ClassVar

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import small
from jax import Array
from tiny import TINY, demonstrate

from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.data.replay import Replay, unpack
from hybrid_rl.settings import build as config
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.metrics import outcome
from hybrid_rl.types import Batch, EnvState, Params, Spec

LENGTH, NUM_ENVS, DECISIONS = 4, 3, 10


@dataclass(frozen=True)
class Clock:
    """Counts its decisions from a random start; the reward is the action."""

    spec: Spec = Spec(obs=1, act=1, dt=0.1)

    def reset(self, key: Array) -> EnvState:
        start = jax.random.uniform(key, (1,))
        return EnvState(start, start, jnp.zeros(()))

    def step(self, state: EnvState, action: Array) -> EnvState:
        x = state.data + 1
        return state.replace(data=x, obs=x, reward=action[0])


@dataclass(frozen=True)
class Recorder:
    """A learner that keeps the batch of every update, and a number from its key."""

    every: int = 1
    data: ClassVar[str] = "latest"
    owns: ClassVar[tuple[str, ...]] = ("belief",)

    def init(self, key: Array, spec: Spec) -> dict:
        empty = jnp.full((DECISIONS, NUM_ENVS, 1), jnp.nan)
        flags = empty[..., 0]
        batch = Batch(empty, empty, flags, flags, flags, empty)
        return {"batch": batch, "count": jnp.int32(0), "drawn": jax.random.uniform(key)}

    def params(self, state: dict) -> dict:
        return {"belief": state}

    def update(self, state: dict, params: Params, batch: Batch, key: Array) -> tuple:
        all_ = jax.tree.map(lambda a, b: a.at[state["count"]].set(b), state["batch"], batch)
        after = {"batch": all_, "count": state["count"] + 1, "drawn": jax.random.uniform(key)}
        return after, {"belief/count": state["count"]}


def agent(every: int = 1) -> Agent:
    """Three environments, whose first six decisions are random."""
    parts = {"recorder": Recorder(every)}
    episode, still = Episode(Clock(), LENGTH), ConstantController(0.5)
    return Agent(episode, still, parts, Replay(30), NUM_ENVS, random_steps=6)


def states(agent: Agent) -> tuple[Any, dict[str, Array]]:
    """States after each decision [T, ...], metrics [T] and observations before it [T, ...]."""

    def run(key: Array) -> Any:
        def one(state: Any, t: Array) -> tuple:
            after, metrics = agent.step(state, t)
            return after, (after, metrics, state.env.obs)

        steps = NUM_ENVS * jnp.arange(DECISIONS)
        return jax.lax.scan(one, agent.init(key), steps)[1]

    return jax.jit(run)(jax.random.key(0))


def test_each_decision_comes_once_with_its_true_successor() -> None:
    """Also random decisions and ends of episodes; without delay."""
    after, _, before = states(agent())
    batches = jax.tree.map(np.asarray, after.learners["recorder"]["batch"])
    assert (np.asarray(after.learners["recorder"]["count"]) == np.arange(1, DECISIONS + 1)).all()
    batch = jax.tree.map(lambda each: each[-1], batches)
    np.testing.assert_array_equal(batch.obs, before)
    np.testing.assert_allclose(batch.next_obs, before + 1)  # also where the episode ended
    assert (batch.action[2:] == 0.5).all()
    assert (batch.action[:2] != 0.5).all()
    np.testing.assert_array_equal(batch.reward, batch.action[..., 0])
    ends = (np.arange(1, DECISIONS + 1) % LENGTH == 0)[:, None] * np.ones(NUM_ENVS)
    np.testing.assert_array_equal(batch.truncated, ends)
    for t in range(DECISIONS):
        assert (batches.obs[t, : t + 1] == batch.obs[: t + 1]).all()
        assert np.isnan(batches.obs[t, t + 1 :]).all()


def test_every_third_decision_can_be_taken() -> None:
    """The first, the fourth, ...; metrics are NaN between them."""
    after, metrics, before = states(agent(every=3))
    assert int(after.learners["recorder"]["count"][-1]) == 4
    batch = jax.tree.map(lambda each: np.asarray(each[-1]), after.learners["recorder"]["batch"])
    np.testing.assert_array_equal(batch.obs[:4], before[::3])
    applies = ~np.isnan(np.asarray(metrics["belief/count"]))
    np.testing.assert_array_equal(applies, np.arange(DECISIONS) % 3 == 0)


@pytest.mark.parametrize("every", [1, 3])
def test_recorded_decisions_teach_the_same_again(every: int) -> None:
    """With the same random numbers, without controller and world."""
    one = agent(every)
    after, _, _ = states(one)
    last = jax.tree.map(lambda each: each[-1], after)
    made = unpack(last.memory.rows[:DECISIONS], one.spec)

    def again(key: Array) -> Any:
        def learn(state: Any, given: tuple[Any, Array]) -> tuple[Any, Array]:
            new, step = given
            seen = state.replace(memory=one.replay.add(state.memory, new))
            state, _ = one.learn(seen, step)
            return state, state.learners["recorder"]["drawn"]

        steps = NUM_ENVS * jnp.arange(DECISIONS)
        return jax.lax.scan(learn, one.init(key), (made, steps))

    state, drawn = jax.jit(again)(jax.random.key(0))
    np.testing.assert_array_equal(drawn, after.learners["recorder"]["drawn"])
    assert len(np.unique(drawn)) == -(-DECISIONS // every)
    got, kept = (each.learners["recorder"]["batch"] for each in (state, last))
    jax.tree.map(np.testing.assert_array_equal, got, kept)
    np.testing.assert_array_equal(state.memory.rows, last.memory.rows)


@dataclass(frozen=True)
class Counting:
    """A learner of the memory that counts its updates, one a round."""

    field: str
    during_random: bool
    data: ClassVar[str] = "uniform"
    batch_size, batches, updates = 1, 1, 1 / NUM_ENVS

    @property
    def owns(self) -> tuple[str, ...]:
        return (self.field,)

    def init(self, key: Array, spec: Spec) -> Array:
        return jnp.int32(0)

    def params(self, state: Array) -> dict:
        return {self.field: state}

    def update(self, state: Array, params: Params, batch: Batch, key: Array) -> tuple:
        return state + 1, {}


def test_learners_of_the_memory_begin_with_two_rows_or_after_the_random_decisions() -> None:
    parts = {"early": Counting("belief", True), "late": Counting("policy", False)}
    learned = states(replace(agent(), learners=parts, random_steps=4 * NUM_ENVS))[0].learners
    np.testing.assert_array_equal(learned["early"], [0, 0, 1, 2, 3, 4, 5, 6, 7, 8])
    np.testing.assert_array_equal(learned["late"], [0, 0, 0, 0, 1, 2, 3, 4, 5, 6])


def test_two_learners_of_one_field_are_refused() -> None:
    with pytest.raises(ValueError, match=r"one and two both learn params\.belief; keep one"):
        replace(agent(), learners={"one": Recorder(), "two": Recorder()})


def test_a_seed_starts_in_the_same_state_whatever_the_method() -> None:
    """With no, one and two learners, whose keys are split from the same key."""
    line = ["task=quadcopter_se3", "algo=koopman_direct", "env.twist=2.0"]
    agent, first = config.build(config.load(line)).agent, []
    names = tuple(agent.learners)
    assert len(names) == 2
    for count in range(3):
        some = {name: agent.learners[name] for name in names[:count]}
        with_some = replace(agent, learners=some)
        first.append(jax.jit(with_some.init)(jax.random.key(3)).env.obs)
    np.testing.assert_array_equal(first[0], first[2])
    np.testing.assert_array_equal(first[1], first[2])


def same(one: Any, other: Any) -> None:
    """All leaves of two trees are equal, numbers but for rounding."""
    one, other = (jax.tree.map(_numbers, each) for each in (one, other))
    jax.tree.map(lambda a, b: np.testing.assert_allclose(a, b, rtol=1e-5, atol=1e-6), one, other)


def _numbers(leaf: Any) -> np.ndarray:
    is_key = jnp.issubdtype(leaf.dtype, jax.dtypes.prng_key)
    return np.asarray(jax.random.key_data(leaf) if is_key else leaf)


@pytest.mark.parametrize(
    ("algo", "resets_itself"),
    [("sac", True), ("hybrid_deterministic", False), ("koopman_active", False)],
)
def test_by_hand_they_are_a_step(algo: str, resets_itself: bool) -> None:
    """Three programs, with the world on the host between them, for two environments."""
    given = "task=point_mass", "num_envs=2", "episode.steps=3"
    agent = config.build(small.load(algo, *given)).agent
    world: Any = jax.jit(jax.vmap(agent.episode.step))
    parts = agent.decide, agent.observe, agent.learn, agent.step
    decide, observe, learn, step = map(jax.jit, parts)
    state = jax.jit(agent.init)(jax.random.key(0))
    for i in jnp.arange(0, 16, 2):
        wanted, row = step(state, i)
        u, state, planned = decide(state, i)
        now: Any = jax.device_get(world(jax.device_get(state.env), np.asarray(u)))
        state = observe(state, u, now, wanted.env if resets_itself else None)
        state, learned = learn(state, i)
        same(state, wanted)
        same({**planned, **learned, **outcome(u, now)}, row)
    assert int(state.memory.count) == 8


KEY = jax.random.key(3)


@pytest.fixture(scope="module")
def imitating(tmp_path_factory) -> Agent:
    """Hybrid learning from demonstrations on the pendulum, pretrained for 3 steps."""
    line = [*TINY, "algo=hybrid_bc", "pretrain=3", "cloning_learner.batch_size=16"]
    line += ["cloning_learner.updates=1", "random_steps=0"]
    folder = tmp_path_factory.mktemp("demonstrations")
    return config.build(config.load([*line, demonstrate(folder, config.load(line))])).agent


def test_pretraining_is_gradient_steps_on_demonstrations(imitating):
    """The policy is that of a plain loop over the learner's updates."""
    learners = {"cloning": imitating.learners["cloning"]}
    alone = replace(imitating, learners=learners, pretrain=3)
    both = alone, replace(alone, pretrain=0)
    ahead, still = (jax.jit(agent.init)(KEY).learners["cloning"] for agent in both)
    count = ahead.optimiser[0].count
    assert (int(count), int(still.optimiser[0].count)) == (3, 0)
    state, cloning = still, learners["cloning"]
    update = jax.jit(lambda state, key: cloning.update(state, Params(), None, key)[0])
    for key in jax.random.split(jax.random.split(KEY, 4)[3], 3):
        ((_, updating),) = jax.random.split(key, (1, 2))
        state = update(state, updating)
    jax.tree.map(lambda a, b: np.testing.assert_allclose(a, b, atol=1e-6), ahead, state)


def test_no_key_of_pretraining_is_reused(imitating, monkeypatch):
    """Its keys differ from those of the initial state and of the first decision."""
    received = []
    monkeypatch.setattr(Agent, "pretrained", lambda _, state, key: received.append(key) or state)
    state = imitating.init(KEY)
    first = jax.random.split(KEY, 2 + len(imitating.learners))
    decision = jax.random.split(state.key, 3 + 2 * imitating.num_envs)
    steps = jax.random.split(received[0], imitating.pretrain)
    keys = jnp.concatenate([received[0][None], steps, first, decision])
    assert len(np.unique(jax.random.key_data(keys), axis=0)) == len(keys)


def test_pretraining_needs_a_memory(imitating):
    bare = replace(imitating.replay, demonstrations=None)
    with pytest.raises(ValueError, match="pretrain=3: the memory is empty"):
        replace(imitating, replay=bare)
