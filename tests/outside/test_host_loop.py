"""Environments on the host: the same numbers as in one program, and what a memory then holds."""

from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any, ClassVar

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
import pytest
import small
from counting import Rising
from gymnasium.spaces import Dict, Discrete
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from hosted import Count, counting

import hybrid_rl
from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.data.replay import unpack
from hybrid_rl.envs.adapters.external import Copies, External
from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv
from hybrid_rl.errors import WorldError
from hybrid_rl.outside.host_loop import HostEvaluator, HostLoop, seed_of
from hybrid_rl.run import exported
from hybrid_rl.run.members import loop_of
from hybrid_rl.run.saved import Trained
from hybrid_rl.settings import build as config
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loop import Loop
from hybrid_rl.types import EnvState, Params, Spec

pytestmark = pytest.mark.turns(4)

STEPS, ROUNDS = 5, 12  # decisions of an episode, and of the run


@dataclass(frozen=True)
class Glider:
    """A point that starts at the same state in each episode."""

    spec: ClassVar = Spec(obs=2, act=1, dt=0.1)

    def reset(self, key: jax.Array) -> EnvState:
        return self._state(jnp.ones(2))

    def step(self, state: EnvState, action: jax.Array) -> EnvState:
        x, v = state.data
        return self._state(jnp.array([x + 0.1 * v, v + 0.1 * action[0]]))

    def _state(self, x: jax.Array) -> EnvState:
        return EnvState(x, x, -x @ x, x[0] > 1.3, jnp.zeros((), bool))


@dataclass(frozen=True)
class Below:
    """Violated where the second entry is below `least`."""

    least: float
    price: float = 0.5
    chance: float | None = None
    width: float = 0.1

    def excess(self, x: jax.Array, u: jax.Array, after: jax.Array) -> jax.Array:
        return self.least - after[1]


def agents(num_envs: int) -> tuple[Any, Any]:
    """SAC on the glider in one program, and through Gymnasium, both with a constraint."""
    agent = config.build(small.load("sac", "task=point_mass", f"num_envs={num_envs}")).agent
    host = External(make=lambda: GymnasiumEnv(Glider(), 0))
    inside, outside = (Episode(env, STEPS, constraint=Below(0.0)) for env in (Glider(), host))
    return replace(agent, episode=inside), replace(agent, episode=outside)


def test_both_doors_give_the_same_learners():
    """Rows of the memory, networks and metrics of two learners; the memory is not copied."""
    num_envs = 3
    got = []
    for agent in agents(num_envs):
        loop = loop_of(agent, (0, 1), ROUNDS)
        state = loop.init()
        program = loop.compile(state)
        state, metrics = program(state, jnp.int32(0), jnp.int32(ROUNDS))
        got.append(jax.tree.map(np.array, (state.memory, state.learners, metrics)))
        if isinstance(loop, HostLoop):
            address = state.memory.rows.unsafe_buffer_pointer()
            state, _ = program(state, jnp.int32(ROUNDS * num_envs), jnp.int32(3))
            assert state.memory.rows.unsafe_buffer_pointer() == address
    assert type(loop_of(agents(1)[0], (0,), 1)) is Loop
    jax.tree.map(lambda a, b: np.testing.assert_allclose(a, b, rtol=2e-4, atol=1e-5), *got)


@cache
def compiled(num_envs: int) -> tuple[Any, Any]:
    """A loop in `Count` and its program."""
    agent = config.build(small.load("sac", "task=point_mass", f"num_envs={num_envs}")).agent
    loop = loop_of(replace(agent, episode=Episode(counting(), STEPS)), (0, 1), ROUNDS)
    return loop, loop.compile(loop.init())


def filled(num_envs: int, rounds: int = ROUNDS) -> tuple[Any, Any]:
    """A loop and its state after some decisions."""
    loop, program = compiled(num_envs)
    program.copies = None  # new ones
    return loop, program(loop.init(), jnp.int32(0), jnp.int32(rounds))[0]


@pytest.mark.parametrize("num_envs", [1, 2])
def test_a_row_leads_to_the_next_step_of_its_episode(num_envs):
    """No row joins two episodes; ends by the task and by the time limit have flags of their own."""
    loop, state = filled(num_envs)
    rows = unpack(state.memory.rows[0, :ROUNDS], loop.agent.spec)
    assert (rows.next_obs[..., 0] == rows.obs[..., 0]).all()
    assert (rows.next_obs[..., 1] == rows.obs[..., 1] + 1).all()
    np.testing.assert_allclose(rows.reward, 1 + 3 * rows.action[..., 0], rtol=1e-5)
    time, episode = rows.next_obs[..., 1], rows.obs[..., 0]
    ended = time == episode + 1
    assert (rows.terminated == ended).all()
    assert (rows.truncated == (time == STEPS) & ~ended).all()
    following = rows.obs[1:, :, 0] - rows.obs[:-1, :, 0]
    assert (following == (rows.terminated + rows.truncated)[:-1]).all()


def test_a_learner_that_has_diverged_does_not_end_the_others():
    loop = loop_of(agents(1)[1], (0, 1), ROUNDS)
    begun = loop.init()
    spoiled = jax.tree.map(lambda leaf: leaf.at[1].set(jnp.nan), begun.learners["policy"].policy)
    policy = begun.learners["policy"].replace(policy=spoiled)
    program = loop.compile(begun)
    state = begun.replace(learners=begun.learners | {"policy": policy})
    state, _ = program(state, jnp.int32(1000), jnp.int32(ROUNDS))
    assert jnp.isfinite(state.env.obs).all()


def test_a_resumed_run_marks_where_its_episode_was_cut():
    loop, state = filled(1, rounds=3)
    count = np.array(state.memory.count)
    program = compiled(1)[1]
    program.copies = None
    state, _ = program(state, jnp.int32(3), jnp.int32(1))
    rows = unpack(state.memory.rows[0, :4, 0], loop.agent.spec)
    assert (state.memory.count == count + 1).all()
    assert rows.truncated.tolist() == [0, 0, 1, 0]
    assert rows.obs[3].tolist() == [1, 0]  # a new copy of the environment, at its first step


class Fragile(Count):
    """Fails once, `left` steps of all copies later."""

    left = 0

    def step(self, action: np.ndarray) -> tuple:
        Fragile.left -= 1
        return super().step(action if Fragile.left else None)


@pytest.mark.parametrize(
    ("algo", "left", "saved"),
    [("algo=sac", 8, 7), ("algo=sac", 24, 20), ("algo=ppo num_envs=2", 8, 6)],
)
def test_a_run_is_saved_where_its_environment_fails(tmp_path, algo, left, saved):
    """In training, in an evaluation, and where it learns from each decision at once."""
    assert External(make="test_host_loop:Fragile").known  # the check is made once
    Fragile.left, folder = left, tmp_path / "run"
    words = ["task=gymnasium", "env.make=test_host_loop:Fragile", "episode.steps=5", *algo.split()]
    words += ["eval_every=20", "total_steps=40", "random_steps=4", f"run_dir={folder}"]
    with pytest.raises(WorldError, match="NoneType"):
        hybrid_rl.train(words, progress=False)
    assert [each.name for each in (folder / "checkpoints").iterdir()] == [str(saved)]
    assert hybrid_rl.train([f"resume={folder}"], progress=False)["finished"]


def test_copies_step_as_in_gymnasiums_vector():
    """Bit by bit, where only the second episode is cut; of Pendulum-v1, whose starts are drawn."""
    copies = Copies(External(id="Pendulum-v1"), [1, 2], 3)
    one = partial(gymnasium.make, "Pendulum-v1", max_episode_steps=-1)
    vector = SyncVectorEnv([one, one], autoreset_mode=AutoresetMode.DISABLED)
    obs, _ = vector.reset(seed=[1, 2])
    np.testing.assert_array_equal(copies.reset(), obs)
    copies._vector.envs[1]._elapsed_steps = 1
    for u in np.float32(np.random.default_rng(0).integers(-4, 5, (4, 2, 1)) / 4):
        got, (obs, reward, *_) = copies.step(u), vector.step(2 * u)
        np.testing.assert_array_equal(got.obs, obs)
        np.testing.assert_array_equal(got.reward, reward.astype(np.float32))
        if got.truncated.any():
            obs, _ = vector.reset(options={"reset_mask": got.truncated.copy()})
        np.testing.assert_array_equal(got.following, obs)


class Drawn(Count):
    """The lengths of its episodes follow from the seed."""

    def reset(self, seed: int | None = None, options: dict | None = None) -> tuple:
        super().reset(seed=seed)
        self.episode = int(self.np_random.integers(1, 4))
        return self._seen(), {}

    def step(self, action: np.ndarray) -> tuple:
        *rest, info = super().step(action)
        return *rest, {**info, "is_success": np.float32(self.time == 3)}


class Later:
    def reward_of(self, x: jax.Array, u: jax.Array, after: jax.Array) -> jax.Array:
        return x[1] + 10 * u[0] + 100 * after[1]  # of the step of the episode


@pytest.mark.parametrize("processes", [False, True])
def test_an_evaluation_pays_each_episode_until_its_own_end(processes):
    """By a goal, also where the others of the call go on; a violation costs no return."""
    env = External(make=Drawn, processes=processes)
    episode = Episode(env, 9, reward=Later(), constraint=Below(2.5))
    keys = jax.random.split(jax.random.key(2), (2, 4))
    evaluator = HostEvaluator(episode, ConstantController(0.5), Params(), keys)
    seeds = [seed_of(*map(int, row)) for row in jax.random.key_data(keys).reshape(-1, 2)]
    lengths = [1 + Drawn().reset(seed=seed)[0][0] for seed in seeds]
    assert {3} < set(lengths)
    found = {name: values.ravel() for name, values in evaluator(Params(), keys).items()}
    np.testing.assert_allclose(found["return"], [{2: 311, 3: 618, 4: 1026}[n] for n in lengths])
    assert found["success"].tolist() == [length == 3 for length in lengths]
    assert found["violations"].tolist() == [2] * len(lengths)
    assert replace(episode, action_repeat=2).relabels


@pytest.mark.parametrize("processes", [False, True])
def test_repeats_of_an_action_end_with_the_episode_of_their_own_copy(processes):
    """A copy beside others, whose episodes end between its repeats, makes all of its own."""
    env, seeds, u = External(make=Drawn, processes=processes), [1, 2], np.zeros((2, 1))
    whole, each = Copies(env, seeds, 9, 3), [Copies(External(make=Drawn), [s], 9, 3) for s in seeds]
    np.testing.assert_array_equal(whole.reset(), np.concatenate([one.reset() for one in each]))
    rewards = []
    for _ in range(3):
        got, apart = whole.step(u), [one.step(u[:1]) for one in each]
        jax.tree.map(lambda a, *b: np.testing.assert_array_equal(a, np.concatenate(b)), got, *apart)
        rewards.append(got.reward)
    whole.close()
    assert set(np.ravel(rewards)) == {1, 2, 3}


class Parts(Count):
    """Count, whose observation is a dictionary."""

    observation_space = Dict({"y": Count.observation_space, "x": Discrete(3)})

    def _seen(self) -> Any:
        return {"y": super()._seen(), "x": 1}


def test_evaluations_have_environments_and_seeds_of_their_own():
    """The returns of equal keys are equal; of Pendulum-v1, whose starts are drawn."""
    agent = config.build(small.load("sac", "task=gymnasium", "env.id=Pendulum-v1")).agent
    episode = replace(agent.episode, steps=STEPS)
    state = jax.vmap(agent.init)(jax.random.split(jax.random.key(1), 2))
    params, keys = jax.vmap(agent.params)(state), jax.random.split(jax.random.key(0), (2, 3))
    evaluator = HostEvaluator(episode, agent.controller.greedy(), params, keys)
    first, second = (evaluator(params, keys)["return"] for _ in range(2))
    assert first.shape == (2, 3)
    assert len(np.unique(first)) == 6
    np.testing.assert_allclose(first, second)
    assert evaluator(params, keys, lambda made: True) is None
    assert len({seed_of(s, i) for s in range(9) for i in range(9)}) == 81


def test_a_trained_policy_acts_in_the_units_of_its_environment():
    """What `step` of the user's loop gets from it, or from its program, is what a run gave it."""
    episode, modes = Episode(counting(), STEPS), {"full": Rising(0.5, 1.0)}  # beyond the bounds
    trained = Trained("count", episode, modes, Params(), (0,), 0, ())
    policy, copies = trained.policy(), Copies(episode.env, [0], STEPS)
    copies.reset()
    made = exported.program(episode.spec, modes["full"], Params(), span=trained.span)
    state, key = np.zeros(made.in_avals[1].shape, np.uint32), np.zeros(2, np.uint32)
    for u, physical in ((0.5, 2.5), (1.5, 4.0)):
        assert policy(np.ones(2)) == physical
        assert copies.step(np.float32([[u]])).reward == physical  # it pays the action
        action, state = made.call(np.ones(2, np.float32), state, key)
        assert action == physical
    of_parts = replace(trained, episode=Episode(External(make=Parts), STEPS))
    assert of_parts.policy()({"y": np.ones(2) / 2, "x": 2}) == 2.5  # a dictionary is flattened


def test_an_end_for_both_reasons_is_an_end_by_the_task():
    for steps, begun, wanted in ((STEPS, 1, [(False, True)] * 2), (1, 0, [(True, False)])):
        copies = Copies(counting(fail="both"), [1], steps)
        copies.reset()
        copies._vector.envs[0].unwrapped.episode = begun
        ends = [copies.step(np.zeros((1, 1))) for _ in wanted]
        assert [(e.terminated[0], e.truncated[0]) for e in ends] == wanted
