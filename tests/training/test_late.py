"""Actions that arrive late, in simulation: what acts when, and what the transitions say of it."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import TINY

from hybrid_rl.data.replay import unpack
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.cartpole import Cartpole
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.settings import build as config
from hybrid_rl.training.ahead import acting_ahead
from hybrid_rl.training.episode import Episode

KEY = jax.random.key(0)
LATE = 2.5 * Pendulum().spec.dt  # [s], which is held back to three decisions


def actions(env, decisions: int) -> np.ndarray:
    """Random actions [T, m]."""
    return np.random.default_rng(0).uniform(-1, 1, (decisions, env.spec.act)).astype(np.float32)


def moved(episode: Episode, u: np.ndarray, key=KEY):
    """The states [T, ...] of an episode under the actions u [T, m]."""

    def one(state, action):
        after = episode.step(state, action)
        return after, after

    return jax.jit(lambda: jax.lax.scan(one, episode.reset(key), jnp.asarray(u))[1])()


@pytest.mark.parametrize("env", [Pendulum(), HalfCheetah("native")])
def test_whole_decisions_are_actions_of_before(env):
    """Those of the undelayed episode, bit for bit, with 0 first."""
    u, late = actions(env, 8), Episode(env, delay=2 * env.spec.dt)
    before = np.concatenate((np.zeros_like(u[:2]), u[:-2]))
    got, want = moved(late, u), moved(Episode(env), before)
    np.testing.assert_array_equal(got.obs, want.obs)
    np.testing.assert_array_equal(got.reward, want.reward)
    np.testing.assert_array_equal(got.clock.sent.acted, before)


def test_without_delay_the_program_is_that_of_the_world():
    env = HalfCheetah("native")
    state = Episode(env).reset(KEY)
    assert state.data.held is None
    text = str(jax.make_jaxpr(Episode(env).step)(state, jnp.zeros(6)))
    assert "while" not in text
    assert text.count("ffi_call") == 1


@pytest.mark.parametrize(
    ("env", "repeat", "held"), [(HalfCheetah("native"), 1, 2), (Cartpole("native"), 5, 2)]
)
def test_a_fraction_is_steps_of_the_physics(env, repeat, held):
    """2.4 decisions: two of five steps with the action of three decisions before."""
    late = Episode(env, action_repeat=repeat, delay=2.4 * env.spec.dt * repeat, lag=0.0)
    u, body = actions(env, 8), env._body
    got, data = moved(late, u), late.reset(KEY).data.replace(held=None)
    before = np.concatenate((np.zeros_like(u[:3]), u))
    for t in range(len(u)):
        for step in range(5):
            data = body.step(data, before[t if step < held else t + 1], 1)
        np.testing.assert_allclose(got.data.qpos[t], data.qpos, rtol=1e-5, atol=1e-5)
    acted = 0.4 * before[: len(u)] + 0.6 * before[1 : len(u) + 1]
    np.testing.assert_allclose(got.clock.sent.acted, acted, rtol=1e-5, atol=1e-6)


def test_a_world_of_one_step_gets_the_mean():
    env = Pendulum()
    u = actions(env, 8)
    before = np.concatenate((np.zeros_like(u[:1]), u))
    got = moved(Episode(env, delay=0.3 * env.spec.dt, lag=0.0), u)
    want = moved(Episode(env), 0.3 * before[:-1] + 0.7 * u)
    np.testing.assert_allclose(got.obs, want.obs, rtol=1e-4, atol=1e-5)


def test_jitter_and_loss_have_their_statistics():
    """A ramp says which action acts, and when it arrived."""
    env, T = Pendulum(), 4000
    ramp = np.arange(T, dtype=np.float32)[:, None]
    dt = env.spec.dt
    late = Episode(env, 10 * T, delay=1.3 * dt, jitter=0.5 * dt, lag=0.0)
    acted = moved(late, ramp).clock.sent.acted
    lag = ramp[5:, 0] - acted[5:, 0]
    assert (np.diff(acted[:, 0]) >= 0).all()  # none overtakes another
    assert lag.min() >= 1.3 - 1e-3
    assert lag.max() <= 1.8 + 1e-3
    assert lag.mean() == pytest.approx(1.55, abs=0.02)
    got = moved(Episode(env, 10 * T, loss=0.3, lag=0.0), ramp).clock.sent
    assert (got.acted[:, 0] != ramp[:, 0]).mean() == pytest.approx(0.3, abs=0.03)
    other = moved(Episode(env, 10 * T, loss=0.3, lag=0.0), ramp, jax.random.key(1)).clock.sent
    assert (got.acted != other.acted).any()


def test_an_action_that_is_held_back_does_not_jitter():
    """A robot releases it at a fixed time; one that arrives later acts when it arrives."""
    env, T = Pendulum(), 400
    ramp, dt = np.arange(T, dtype=np.float32)[:, None], env.spec.dt
    for lag, soonest, latest in ((None, 2, 2), (0.9 * dt, 1, 1.5)):
        late = Episode(env, 10 * T, delay=0.8 * dt, jitter=0.7 * dt, lag=lag)
        past = ramp[5:, 0] - moved(late, ramp).clock.sent.acted[5:, 0]
        assert past.min() == pytest.approx(soonest, abs=1e-3)
        assert past.max() == pytest.approx(latest, abs=0.02)


@pytest.mark.parametrize(
    ("algo", "given"),
    [
        ("sac", {}),
        ("nn_mppi", {"lag": 0.0}),
        ("nn_mppi", {}),
        ("nn_mppi", {"delay": 0.0, "lag": LATE}),
    ],
)
def test_transitions_hold_what_acted(algo, given):
    """Three decisions before; or what was sent, if there is no model or no lag is known.

    A world that is late by itself holds nothing back: there it is the nearest whole lag.
    """
    env, T = Pendulum(), 12
    words = [*TINY, "task=pendulum", f"algo={algo}", "random_steps=100"]
    agent = config.build(config.load(words)).agent
    late = Episode(env, 9, **({"delay": LATE} | given))
    episode, acting = acting_ahead(late, {"full": agent.controller})
    agent = replace(agent, episode=episode, controller=acting["full"])

    def one(state, t):
        after, metrics = agent.step(state, t)
        return after, (metrics["world/action"], metrics["episode/done"][0])

    state, (u, done) = jax.jit(lambda key: jax.lax.scan(one, agent.init(key), jnp.arange(T)))(KEY)
    rows = unpack(state.memory.rows[:T, 0], agent.spec)
    u, acted, k = np.asarray(u), np.zeros(T + 3), int(agent.episode.known_lag)
    np.testing.assert_array_equal(np.flatnonzero(done), [8])
    assert k == (0 if algo == "sac" or given.get("lag") == 0 else 2 if given else 3)
    for begin, end in ((0, 9), (9, T)):  # nothing was sent before an episode
        acted[begin + k : end + k], acted[begin : begin + k] = u[begin:end], 0
        want = acted[begin:end]
        np.testing.assert_allclose(rows.action[begin:end, 0], want, rtol=1e-5, atol=1e-6)
        paid = jax.vmap(env.reward_of)(rows.obs, rows.action, rows.next_obs)[begin:end]
        if algo == "nn_mppi" and not given:
            np.testing.assert_allclose(rows.reward[begin:end], paid, rtol=1e-4, atol=1e-5)
