"""Which actions acted, and how late, from times alone."""

import jax.numpy as jnp
import numpy as np
import pytest
from counting import Counting

from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.models.exact import Exact
from hybrid_rl.outside import lag as lags
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.run.saved import Trained, with_lag
from hybrid_rl.training.ahead import ahead
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Params

DT, KEPT = 0.05, 5  # [s] of a decision; actions that are remembered


def test_shares_are_those_of_the_interval():
    """The own action 30 ms after the observation, the one before 60 ms earlier, one more."""
    times, interval = np.array([0.01, -0.05, -0.09]), np.array(0.05)
    for late, want in ((0.0, [0.8, 0.2, 0]), (0.02, [0.4, 0.6, 0]), (0.06, [0, 0.8, 0.2])):
        np.testing.assert_allclose(lags.shares(times, interval, late), want, atol=1e-9)
    np.testing.assert_allclose(lags.shares(times, interval, 9.0), [0, 0, 1], atol=1e-9)
    sent = np.array([[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]])
    np.testing.assert_allclose(lags.acted(sent, times, interval, 0.06), [0.1, 0.9], atol=1e-9)


def moved(late: float, jitter: float, decisions: int = 1000) -> tuple:
    """An oscillator with two motors, in steps of 1 ms, whose decisions take 50 ms or so."""
    rng = np.random.default_rng(0)
    period = np.maximum(DT + jitter * rng.uniform(-1, 1, decisions), 0.01)
    begins = np.concatenate([[0.0], np.cumsum(period)])
    u = rng.uniform(-1, 1, (decisions, 2))
    x, obs, now = np.zeros(4), [], 0
    arrives = begins[:-1] + 0.004 + late * DT
    for t in np.arange(0, begins[-1] + 1e-3, 1e-3):
        while now <= decisions and t >= begins[now] - 1e-9:
            obs.append(x.copy())
            now += 1
        k = np.searchsorted(arrives, t + 1e-9) - 1
        force = 8 * (u[k] if k >= 0 else np.zeros(2)) - 9 * x[:2] - 0.4 * x[2:]
        x = x + 1e-3 * np.concatenate([x[2:], force])
    obs = np.array(obs[: decisions + 1]) + 1e-3 * rng.normal(size=(decisions + 1, 4))
    rows = np.arange(KEPT, decisions)
    sent = np.stack([u[rows - i] for i in range(KEPT)], axis=1)
    times = np.stack([begins[rows - i] + 0.004 - begins[rows] for i in range(KEPT)], axis=1)
    return obs[rows], obs[rows + 1], sent, times, period[rows]


@pytest.mark.parametrize("jitter", [0.0, 0.02])
@pytest.mark.parametrize("late", [0.0, 0.3, 1.0, 1.45, 2.3])
def test_the_lag_is_found_within_a_tenth(late, jitter):
    found = lags.estimated(*moved(late, jitter)) / DT
    assert found == pytest.approx(late, rel=0.1, abs=0.05)


@pytest.mark.parametrize("late", [0.0, 0.3, 1.45, 2.3])
@pytest.mark.parametrize("before", [0.0, 0.05])
def test_a_lag_that_changes_is_followed_by_a_model(late, before):
    """The model is linear, of decisions that were not late; a useless one changes nothing."""
    obs, after, sent, times, interval = moved(0.0, 0.0)
    inputs = np.column_stack([obs, lags.acted(sent, times, interval, 0.0)])
    solved = np.linalg.lstsq(inputs, after, rcond=None)[0]
    names = ("obs", "next_obs", "sent", "times", "interval")
    newest = (each[-lags.FOLLOWED :] for each in moved(late, 0.0))
    rows = dict(zip(names, newest, strict=True))
    found = lags.followed(lambda x, u: jnp.asarray(np.c_[x, u] @ solved), rows, before)
    assert found / DT == pytest.approx(late, rel=0.1, abs=0.06)
    assert lags.followed(lambda x, u: x, rows, before) == before


@pytest.mark.parametrize(("lag", "decisions"), [(None, 0), (0.0002, 0), (0.005, 2)])
def test_a_robots_controllers_act_at_the_lag_that_was_found_last(tmp_path, lag, decisions):
    """Rounded up to whole decisions of 4 ms; on time they are plain policies, as ONNX needs."""
    env, policy = Robot(make=Counting), PolicyController(TanhGaussian((8,)), Exact(Pendulum()))
    (tmp_path / "robot").mkdir()
    if lag is not None:
        lags.publish(tmp_path / "robot", lag)
    episode = Episode(env, steps=5)
    acting = {"policy": ahead(policy, env.spec, 0.0, most=9)}
    trained = Trained("robot", episode, acting, Params(), (0,), 0, ())
    found = with_lag(trained, tmp_path).controllers["policy"]
    assert found == (ahead(policy, episode.spec, 2.0) if decisions else policy)
