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
from gymnasium.spaces import Box, Dict, Discrete
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from hybrid_rl import config
from hybrid_rl.data.replay import unpack
from hybrid_rl.envs.adapters.external import External
from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv
from hybrid_rl.errors import UsageError, WorldError
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.host_loop import HostEvaluator, HostLoop, seed_of
from hybrid_rl.training.loop import Loop
from hybrid_rl.training.loops import loop_of
from hybrid_rl.types import EnvState, Spec

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


class Count(gymnasium.Env):
    """Shows the number of the episode and of the step; each ends after its own number of steps."""

    observation_space = Box(-np.inf, np.inf, (2,))
    action_space = Box(-2, 4, (1,))
    metadata: ClassVar = {"render_fps": 10}

    def __init__(self, fail: str = "") -> None:
        self.fail, self.episode, self.last = fail, 0, np.zeros(1)
        self.buffer = np.zeros(2)

    def reset(self, seed: int | None = None, options: dict | None = None) -> tuple:
        super().reset(seed=seed)
        self.episode, self.time = self.episode + 1, 0
        return self._seen(), {}

    def step(self, action: np.ndarray) -> tuple:
        self.time, self.last = self.time + 1, action
        fail = self.fail if self.time == 2 else ""  # the first step is tried before a run
        if fail == "error":
            raise ValueError("motor off")
        obs = self._seen()
        if fail == "nan":
            obs[1] = np.nan
        obs = np.zeros(3) if fail == "size" else obs
        reward = np.inf if fail == "reward" else float(action[0])
        return obs, reward, self.time >= self.episode + 1, self.fail == "both", {}

    def _seen(self) -> np.ndarray:
        """A buffer that the next step overwrites."""
        self.buffer[:] = self.episode, self.time
        return self.buffer


def counting(**kwargs: Any) -> External:
    return External(make=Count, kwargs=kwargs)


def agents(num_envs: int) -> tuple[Any, Any]:
    """SAC on the glider in one program, and through Gymnasium."""
    agent = config.build(small.load("sac", "task=point_mass", f"num_envs={num_envs}")).agent
    host = External(make=lambda: GymnasiumEnv(Glider(), 0))
    inside, outside = (Episode(env, STEPS) for env in (Glider(), host))
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
def filled(num_envs: int = 1, rounds: int = ROUNDS) -> tuple[Any, Any]:
    """A loop and its state after some decisions in `Count`."""
    agent = config.build(small.load("sac", "task=point_mass", f"num_envs={num_envs}")).agent
    loop = loop_of(replace(agent, episode=Episode(counting(), STEPS)), (0, 1), ROUNDS)
    state = loop.init()
    return loop, loop.compile(state)(state, jnp.int32(0), jnp.int32(rounds))[0]


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


def test_a_resumed_run_marks_where_its_episode_was_cut():
    loop, state = filled(rounds=3)
    count = np.array(state.memory.count)
    again = loop.compile(state)
    state, _ = again(state, jnp.int32(3), jnp.int32(1))
    rows = unpack(state.memory.rows[0, :4, 0], loop.agent.spec)
    assert (state.memory.count == count + 1).all()
    assert rows.truncated.tolist() == [0, 0, 1, 0]
    assert rows.obs[3].tolist() == [1, 0]  # a new copy of the environment, at its first step


@pytest.mark.parametrize(
    ("fail", "line"),
    [
        ("error", ": ValueError: motor off"),
        ("nan", "Count: step: entry 1 of obs is not finite"),
        ("size", "Count: step: "),
        ("reward", "Count: step: gives a reward that is not finite"),
    ],
)
def test_what_goes_wrong_in_an_environment_is_one_line(fail, line):
    copies = counting(fail=fail).copies([1, 2], STEPS)
    copies.reset()
    with pytest.raises(WorldError) as error:
        list(map(copies.step, np.zeros((3, 2, 1))))
    assert line in str(error.value)
    assert "\n" not in str(error.value)


def test_an_end_for_both_reasons_is_an_end_by_the_task():
    copies = counting(fail="both").copies([1], STEPS)
    copies.reset()
    ends = [copies.step(np.zeros((1, 1))) for _ in range(2)]
    assert [(e.terminated[0], e.truncated[0]) for e in ends] == [(False, True), (False, True)]
    copies = counting(fail="both").copies([1], 1)
    copies.reset()
    copies._vector.envs[0].episode = 0
    last = copies.step(np.zeros((1, 1)))
    assert (last.terminated[0], last.truncated[0]) == (True, False)


def test_copies_step_as_in_gymnasiums_vector():
    """Bit by bit, where only the second episode is cut; of Pendulum-v1, whose starts are drawn."""
    copies = External(id="Pendulum-v1").copies([1, 2], 3)
    one = partial(gymnasium.make, "Pendulum-v1", max_episode_steps=-1)
    vector = SyncVectorEnv([one, one], autoreset_mode=AutoresetMode.DISABLED)
    obs, _ = vector.reset(seed=[1, 2])
    np.testing.assert_array_equal(copies.reset(), obs)
    copies.decisions[1] = 1
    for u in np.float32(np.random.default_rng(0).integers(-4, 5, (4, 2, 1)) / 4):
        got, (obs, reward, *_) = copies.step(u), vector.step(2 * u)
        np.testing.assert_array_equal(got.obs, obs)
        np.testing.assert_array_equal(got.reward, reward.astype(np.float32))
        if got.truncated.any():
            obs, _ = vector.reset(options={"reset_mask": got.truncated.copy()})
        np.testing.assert_array_equal(got.following, obs)


class Odd(gymnasium.Env):
    """Spaces that have to be flattened, or refused."""

    observation_space = Dict({"b": Discrete(3), "a": Box(0, 1, (2, 2))})
    metadata: ClassVar = {"render_fps": 50}

    def __init__(self, actions: Any = None, obs: Any = None) -> None:
        self.action_space = Box(-1, 1, (2, 1)) if actions is None else actions
        if obs is not None:
            self.observation_space = obs

    def reset(self, seed: int | None = None, options: dict | None = None) -> tuple:
        return self.observation_space.sample(), {}

    def step(self, action: np.ndarray) -> tuple:
        return self.observation_space.sample(), 0.0, False, False, {}


def test_spaces_of_any_form_are_flattened():
    assert External(make=Odd).spec == Spec(obs=7, act=2, dt=0.02)


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({}, "give an id of Gymnasium, or env.make=MODULE:CLASS"),
        ({"id": "Hoper-v5"}, "env.id=Hoper-v5: NameNotFound: Environment `Hoper` doesn't exist"),
        ({"id": "CartPole-v1"}, "CartPole-v1: has actions Discrete(2)"),
        ({"make": Odd, "kwargs": {"actions": Box(-np.inf, 1, (1,))}}, "finite bounds"),
        ({"make": Odd, "kwargs": {"obs": Box(0, 255, (300, 400, 3))}}, "must be numbers"),
        ({"make": "nowhere:Env"}, "env.make=nowhere:Env: cannot be imported (No module named"),
        ({"make": "./reach.py:Reach"}, "cannot be imported (a module has no .py: reach:Reach)"),
        ({"make": "json:loads"}, "env.make=json:loads: TypeError"),
        ({"id": "Pendulum-v1", "timeout_s": 1.0}, "with env.processes=true"),
    ],
)
def test_what_is_no_usable_environment_is_one_line(given, line):
    with pytest.raises(UsageError) as error:
        External(**given)
    assert line in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("method", "returned", "line"),
    [
        ("step", (np.ones(2), 0.0, False, {}), "returns 4 things; it must return obs, reward,"),
        ("step", (np.ones(3), 0.0, False, False, {}), "obs has the shape [3]; its space says [2]"),
        ("step", (np.ones(2), np.zeros(1), False, False, {}), "reward has the shape [1]; it must"),
        ("step", (np.ones(2), np.nan, False, False, {}), "reward is not finite"),
        ("step", (np.array([0, np.nan]), 0.0, False, False, {}), "entry 1 of obs is not finite"),
        ("reset", np.ones(2), "returns ndarray; it must return obs, info"),
    ],
)
def test_what_the_first_step_returns_is_checked_before_a_run(method, returned, line):
    kind = type("Wrong", (Count,), {method: lambda self, *_, **options: returned})
    with pytest.raises(WorldError) as error:
        External(make=kind)
    assert str(error.value).startswith(f"Wrong: {method}: {line}")


def test_an_environment_without_a_time_step_is_shown_where_to_write_it():
    with pytest.raises(UsageError, match=r"add env.dt=0.05, .* or metadata = .* to its class"):
        External(make=type("Timeless", (Count,), {"metadata": {}}))


def test_a_video_of_an_environment_that_takes_no_render_mode_says_what_it_needs():
    copies = counting().copies([1], STEPS, render_mode="rgb_array")
    with pytest.raises(WorldError, match="Count: for a video, give it `def __init__"):
        copies.reset()


@pytest.mark.parametrize(
    ("render", "line"),
    [
        (gymnasium.Env.render, "Wrong: for a video, give it `def __init__"),
        (lambda self: None, "Wrong: render: returns NoneType; for a video, give it `def __init__"),
    ],
)
def test_a_video_of_an_environment_without_a_picture_says_what_it_needs(render, line):
    kind = type("Wrong", (Count,), {"render": render})
    copies = External(make=kind).copies([1], STEPS)
    copies.reset()
    with pytest.raises(WorldError) as error:
        copies.picture()
    assert str(error.value).startswith(line)


def test_planning_on_the_environment_itself_is_refused():
    env = counting()
    with pytest.raises(UsageError, match="steps on the host"):
        env.step(env.reset(jax.random.key(0)), jnp.zeros(1))


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
    assert evaluator(params, keys, lambda: True) is None
    assert len({seed_of(s, i) for s in range(9) for i in range(9)}) == 81
