"""What a controller saw and did lately, in episodes, in the memory and in models."""

from dataclasses import dataclass, replace
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import TINY
from toys import begun

from hybrid_rl.core import history
from hybrid_rl.data.replay import Replay
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.errors import UsageError
from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.exact import Exact
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.settings import build as config
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.ahead import AheadController
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.history import HistoryController, acting, informed
from hybrid_rl.types import Spec

ENV, K, KEY = Pendulum(), 3, jax.random.key(0)
close = partial(np.testing.assert_allclose, rtol=1e-4, atol=1e-5)
NOT = ["reward_model.ends=null", "model_learner.reward=null"]


def stacks(obs: np.ndarray, u: np.ndarray, k: int) -> np.ndarray:
    """s_t [T, n] of one episode, written out from its observations [T, o] and actions [T, m]."""
    rows = []
    for t in range(len(obs)):
        parts = [obs[t]]
        for j in range(1, k):
            rate = (obs[max(t - j + 1, 0)] - obs[max(t - j, 0)]) / ENV.spec.dt
            parts += [rate, u[t - j] if t >= j else 0 * u[0]]
        rows.append(np.concatenate(parts))
    return np.array(rows)


def alone(controller, episode):
    """The controller as it acts in these episodes."""
    return acting(episode, {"full": controller})[1]["full"]


@dataclass(frozen=True)
class Telling:
    """Random actions; its state is what it saw."""

    def init(self, spec):
        return jnp.zeros(spec.obs)

    def act(self, params, state, obs, key):
        return jax.random.uniform(key, (1,), minval=-1, maxval=1), obs, {}

    def greedy(self):
        return self


def test_controllers_and_the_memory_have_the_history_of_each_episode():
    """In two environments, the first three decisions at random."""
    episode = Episode(ENV, steps=5, history=K, observe=(0, 1))
    agent = Agent(episode, alone(Telling(), episode), {}, Replay(100), 2, random_steps=2 * 3)
    step = jax.jit(lambda state, i: agent.step(state, i)[0])
    state, saw = agent.init(KEY), []
    for i in range(12):
        state = step(state, jnp.int32(2 * i))
        saw.append(state.control.inner)
    made = Replay(100).sample(state.memory, agent.spec, 500, KEY, K)
    rows = state.memory.rows[:12]
    for world in range(2):
        obs, u, after = rows[:, world, :2], rows[:, world, 2:3], rows[:, world, 6:]
        want = np.concatenate([stacks(obs[i : i + 5], u[i : i + 5], K) for i in (0, 5, 10)])
        acted = [i for i in range(3, 12) if i % 5 != 4]  # at the end of an episode it forgot
        close(np.array(saw)[acted, world], want[acted])
        for s, v, then in zip(made.obs, made.action, made.next_obs, strict=True):
            at = np.flatnonzero((np.asarray(obs) == np.asarray(s[:2])).all(1))
            if len(at):
                rate = (after[at[0]] - obs[at[0]]) / ENV.spec.dt
                close(s, want[at[0]])
                close(then, np.concatenate((after[at[0]], rate, v, s[2:5])))
    close(Replay(100).newest(state.memory, agent.spec, K).obs[1], want[11])


@pytest.mark.parametrize("input_noise", [0.0, 0.5])
def test_models_learn_the_newest_observation_and_shift_the_rest(input_noise):
    model = Ensemble(Gaussian((8,), state_noise=True, input_noise=input_noise), 2)
    spec = history.seen(Spec(obs=2, act=1, dt=0.1), K)
    params, rng = begun(model, spec), np.random.default_rng(0)
    x, u, noise = (jnp.asarray(rng.normal(size=n), jnp.float32) for n in (8, 1, 8))
    after = history.shifted(x, u, jnp.array([3.0, 4.0]), spec.dt)
    params = model.observe(params, jnp.stack((x, 2 * x)), jnp.stack((after, 3 * after)))
    drawn = model.draw(params, x[None], u[None], noise[None], KEY)[0]
    for then in (model.step(params, x, u), *model.predictions(params, x, u)[2], drawn):
        close(then[2:], np.concatenate(((then[:2] - x[:2]) / 0.1, u, x[2:5])))
    close(params["change"].mean, (2 * after - 1.5 * x)[:2])  # of the newest observation alone
    assert model.disagreement(params, x, u).size == 2
    each = [(x[None], u[None], after[None].at[0, i].add(1.0)) for i in (0, 1, 2, 7)]
    losses = [
        model.loss(params, *(jnp.tile(row, (2, 1)) for row in rows), KEY)
        for rows in [(x[None], u[None], after[None]), *each]
    ]
    assert losses[0] not in losses[1:3]
    assert losses[3:] == [losses[0]] * 2  # what only shifts is not learned


def test_one_observation_is_the_program_of_before():
    controller, episode = Telling(), Episode(ENV)
    assert alone(controller, episode) is controller
    assert alone(alone(controller, replace(episode, history=2)), episode) is controller
    assert history.seen(ENV.spec, 1) is ENV.spec


@pytest.mark.parametrize(
    ("inner", "u"), [(Telling(), 0.3), (AheadController(Telling(), Exact(ENV), ENV.spec), 0.2)]
)
def test_a_robot_says_what_it_sent(inner, u):
    """That is the last action; where a lag of one decision is known, the one before."""
    state = HistoryController(inner, K).init(ENV.spec)
    state = informed(state, jnp.array([[0.1], [0.2], [0.3]]), jnp.float32(1))
    assert state.u == pytest.approx(u)


def test_the_world_has_all_of_the_observation():
    """A reward of another decision's observation, with and without what it pays for."""
    paid = []
    for observe in (None, (1,)):
        episode, state = Episode(ENV, reward=ENV, observe=observe), None
        for _ in range(3):
            state = episode.reset(KEY) if state is None else episode.step(state, jnp.ones(1))
            assert state.obs.size == episode.spec.obs
        paid.append(state.reward)
    np.testing.assert_array_equal(*paid)


def test_what_needs_all_of_the_observation_does_not_get_a_part():
    """A rule of ends is learned instead, a known reward is refused."""
    hopper = [*TINY, "task=hopper", "reward_model.rule=${env}"]
    rules = [
        config.build(config.load([*hopper, *more])).agent.learners["model"].reward
        for more in ([], ["episode.observe=5"])
    ]
    assert [rule._known for rule in rules] == [True, False]
    known = [*TINY, "task=pendulum", "algo=nn_mppi", "reward_model=known", *NOT]
    config.build(config.load(known))
    with pytest.raises(UsageError, match="needs an environment with a known reward"):
        config.build(config.load([*known, "episode.observe=2"]))
    with pytest.raises(UsageError, match=r"episode.observe=\[3\]: must be some of the entries"):
        config.build(config.load([*TINY, "task=pendulum", "episode.observe=[3]"]))
