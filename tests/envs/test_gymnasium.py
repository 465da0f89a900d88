"""Environments with the interface of Gymnasium."""

from functools import partial

import gymnasium
import jax
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv, GymnasiumVectorEnv
from hybrid_rl.envs.analytic.two_link import TwoLink
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.hopper import Hopper


@pytest.mark.filterwarnings("ignore:.*Box observation space (min|max)imum value is:UserWarning")
@pytest.mark.parametrize("name", ["HalfCheetah", "TwoLink"])
def test_gymnasium_accepts_an_environment(name, can_draw):
    """By its id, whose environment has a `spec`."""
    env = gymnasium.make(f"hybrid_rl/{name}", render_mode="rgb_array")
    check_env(env.unwrapped, skip_render_check=not can_draw)
    env.close()


def test_infos_are_those_of_single_environments():
    """Gymnasium's own vector environment, which steps one after the other, has the same keys."""
    world = TwoLink(success_distance=1.0)
    make = partial(GymnasiumEnv, world, 4)
    own = gymnasium.vector.SyncVectorEnv([make] * 2, autoreset_mode=AutoresetMode.SAME_STEP)
    ours = GymnasiumVectorEnv(world, 2, steps=4)
    for (*_, a), (*_, b) in zip(play(own, 0, 5), play(ours, 0, 5), strict=True):
        assert set(a) == set(b)
        assert a["success"].dtype == b["success"].dtype == bool
        np.testing.assert_array_equal(a["_distance"], b["_distance"])
        if "final_info" in b:
            assert set(a["final_info"]) == set(b["final_info"])
            distance = np.linalg.norm(b["final_obs"][:, [0, 2]] - b["final_obs"][:, 4:], axis=1)
            np.testing.assert_allclose(b["final_info"]["distance"], distance, rtol=1e-5)


def test_rendering_needs_no_display(draws):
    """Of two environments in turn; the image changes as the robot moves."""
    one, two = GymnasiumEnv(HalfCheetah("native")), GymnasiumEnv(Hopper("native"))
    for env in (one, two):
        env.reset(seed=0)
    first, other = one.render(), two.render()
    assert (first.shape, first.dtype) == ((480, 640, 3), np.uint8)

    def difference(one, two):
        return np.abs(one.astype(int) - two).max()

    assert difference(first, other) > 50
    assert difference(first, one.render()) < 5  # anti-aliasing
    for _ in range(5):
        one.step(np.ones(6, np.float32))
    assert difference(first, one.render()) > 50
    one.close()
    one.close()
    assert two.render().std() > 10


@pytest.mark.parametrize("env", [Hopper("native"), TwoLink(success_distance=2.0)], ids=["a", "b"])
def test_the_adapter_steps_the_environment(env):
    """By random actions, without resets; `info` has the metrics, and success as a bool."""
    adapter = GymnasiumEnv(env, steps=60)
    adapter.reset(seed=0)
    adapter.action_space.seed(0)
    state, step = adapter.state, jax.jit(env.step)
    for t in range(60):
        action = adapter.action_space.sample()
        obs, reward, terminated, truncated, info = adapter.step(action)
        state = step(state, action)
        np.testing.assert_allclose(obs, state.obs, rtol=1e-6)
        assert reward == pytest.approx(float(state.reward), rel=1e-5)
        assert info == {n: pytest.approx(float(x), rel=1e-5) for n, x in state.metrics.items()}
        assert type(info.get("success", True)) is bool
        assert terminated == bool(state.terminated)
        assert truncated == (t == 59 and not terminated)


def play(envs, seed, count):
    envs.reset(seed=seed)
    rng = np.random.default_rng(0)
    for _ in range(count):
        action = rng.uniform(-1, 1, envs.action_space.shape)
        yield envs.step(action)


def test_a_vector_environment_resets_in_the_same_step():
    envs = GymnasiumVectorEnv(Hopper("native"), 5, steps=12)
    assert envs.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    fell = stopped = 0
    for obs, reward, terminated, truncated, infos in play(envs, 0, 60):
        done = terminated | truncated
        assert reward.shape == (5,)
        assert not (terminated & truncated).any()
        # An initial state is at rest; a last one is not.
        assert (np.abs(obs[done, 5:]) <= 0.005).all()
        if done.any():
            np.testing.assert_array_equal(infos["_final_obs"], done)
            assert (np.abs(infos["final_obs"][done, 5:]) > 0.005).any(1).all()
        fell, stopped = fell + terminated.sum(), stopped + truncated.sum()
    assert fell > 0
    assert stopped > 0


def test_environment_i_has_seed_plus_i():
    """The same seed gives the same episodes, which Gymnasium's own wrapper counts."""

    def seen(seed):
        envs = GymnasiumVectorEnv(Hopper("native"), 3, steps=6)
        counted = gymnasium.wrappers.vector.RecordEpisodeStatistics(envs)
        steps = list(play(counted, seed, 12))
        lengths = [i["episode"]["l"][i["_episode"]] for *_, i in steps if "episode" in i]
        assert np.concatenate(lengths).tolist() == [6] * 6
        return [obs for obs, *_ in steps], envs.reset(seed=seed)[0]

    (path, first), (again, _), (other, second) = seen(4), seen(4), seen(5)
    np.testing.assert_array_equal(path, again)
    np.testing.assert_array_equal(first[1:], second[:2])
    assert (path[0] != other[0]).any()
