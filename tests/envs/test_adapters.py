"""Environments with the interfaces of Gymnasium and Brax."""

import re
import sys
import textwrap
from functools import partial
from types import SimpleNamespace

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv, GymnasiumVectorEnv
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.hopper import Hopper
from hybrid_rl.envs.mujoco import offscreen


def can_draw():
    """Whether this machine can render."""
    try:
        offscreen.backend()
    except offscreen.NoGraphicsError:
        return False
    return True


@pytest.mark.filterwarnings("ignore:.*Not able to test alternative render modes:UserWarning")
@pytest.mark.filterwarnings("ignore:.*Box observation space (min|max)imum value is:UserWarning")
def test_gymnasium_accepts_an_environment():
    env = GymnasiumEnv(Hopper("native"), steps=20, render_mode="rgb_array")
    check_env(env, skip_render_check=not can_draw())


def test_rendering_needs_no_display():
    """Of two environments in turn; the image changes as the robot moves."""
    if not can_draw():
        return
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


def test_without_a_backend_rendering_raises_one_line(monkeypatch):
    """MuJoCo's own renderer would end the process."""
    monkeypatch.setattr(offscreen, "TRIAL", "raise SystemExit(1)")
    monkeypatch.setattr(sys, "platform", "linux")
    offscreen.chosen.cache_clear()
    env = GymnasiumEnv(Hopper("native"))
    env.reset(seed=0)
    with pytest.raises(offscreen.NoGraphicsError, match="install libegl1 or libosmesa6"):
        env.render()
    offscreen.chosen.cache_clear()
    env.close()


def test_an_environment_without_a_scene_cannot_be_rendered():
    bare = SimpleNamespace(spec=Hopper("native").spec, reset=Hopper("native").reset, step=None)
    with pytest.raises(ValueError, match="has no `scene` and no `pose`"):
        GymnasiumEnv(bare).render()


def test_the_adapter_steps_the_environment():
    env = HalfCheetah("native")
    adapter = GymnasiumEnv(env, steps=5)
    adapter.reset(seed=0)
    state, step = adapter._state, jax.jit(env.step)
    for t in range(5):
        action = adapter.action_space.sample()
        obs, reward, terminated, truncated, _ = adapter.step(action)
        state = step(state, action)
        np.testing.assert_allclose(obs, state.obs, rtol=1e-6)
        assert reward == pytest.approx(float(state.reward), rel=1e-5)
        assert (terminated, truncated) == (False, t == 4)


def test_a_seed_repeats_the_initial_state():
    env = GymnasiumEnv(Hopper("native"))
    first, again, other = (env.reset(seed=s)[0] for s in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert (first != other).any()
    assert (env.reset()[0] != other).any()


def _play(envs, seed, count):
    envs.reset(seed=seed)
    rng = np.random.default_rng(0)
    for _ in range(count):
        action = rng.uniform(-1, 1, envs.action_space.shape)
        yield envs.step(action)


def test_a_vector_environment_resets_in_the_same_step():
    envs = GymnasiumVectorEnv(Hopper("native"), 5, steps=12)
    assert envs.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    fell = stopped = 0
    for obs, reward, terminated, truncated, infos in _play(envs, 0, 60):
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
    """And the same seed gives the same episodes."""
    many = [o for o, *_ in _play(GymnasiumVectorEnv(Hopper("native"), 3, steps=9), 4, 30)]
    again = [o for o, *_ in _play(GymnasiumVectorEnv(Hopper("native"), 3, steps=9), 4, 30)]
    shifted = [o for o, *_ in _play(GymnasiumVectorEnv(Hopper("native"), 3, steps=9), [5, 6, 7], 1)]
    np.testing.assert_array_equal(many, again)
    assert (shifted[0] != many[0]).any()
    first, _ = GymnasiumVectorEnv(Hopper("native"), 3).reset(seed=4)
    second, _ = GymnasiumVectorEnv(Hopper("native"), 3).reset(seed=5)
    np.testing.assert_array_equal(first[1:], second[:2])


def test_gymnasium_counts_episodes():
    envs = gymnasium.wrappers.vector.RecordEpisodeStatistics(
        GymnasiumVectorEnv(Hopper("native"), 4, steps=6)
    )
    lengths = [
        n
        for *_, infos in _play(envs, 0, 12)
        if "episode" in infos
        for n in infos["episode"]["l"][infos["_episode"]]
    ]
    assert lengths == [6] * 8


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_brax_wrappers_run():
    from brax.envs import training

    from hybrid_rl.envs.adapters.brax import BraxEnv

    env = training.wrap(BraxEnv(Hopper("native")), episode_length=6, action_repeat=2)
    state = jax.jit(env.reset)(jax.random.split(jax.random.PRNGKey(0), 3))
    first, step = state.obs, jax.jit(env.step)
    ours, own = Hopper("native"), jax.jit(jax.vmap(Hopper("native").step))
    truth = jax.vmap(ours.reset)(jax.random.split(jax.random.PRNGKey(0), 3))
    for t in range(3):
        action = jnp.full((3, 3), 0.1 * t)
        for _ in range(2):
            truth = own(truth, action)
        state = step(state, action)
        if t < 2:
            np.testing.assert_allclose(state.obs, truth.obs, atol=1e-5)
            assert not state.done.any()
    assert state.done.all()
    assert state.info["truncation"].all()
    np.testing.assert_allclose(state.info["episode_metrics"]["length"], 6)
    np.testing.assert_array_equal(state.obs, first)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # Brax imports jaxopt
def test_brax_wrappers_reject_new_style_keys():
    from brax.envs import training

    from hybrid_rl.envs.adapters.brax import BraxEnv

    env = training.wrap(BraxEnv(Pendulum()), episode_length=6)
    with pytest.raises(TypeError, match=r"keys of jax\.random\.PRNGKey, not of jax\.random\.key"):
        env.reset(jax.random.split(jax.random.key(0), 3))


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_brax_trainers_run_with_the_lines_of_the_docstring(monkeypatch):
    """And not without them: when Brax supports the current JAX, they can be removed."""
    from brax.training.agents.ppo import networks, train
    from brax.training.pmap import bcast_local_devices

    from hybrid_rl.envs.adapters import brax

    with pytest.raises(AttributeError, match="device_put_replicated"):
        bcast_local_devices(0.0)
    lines = re.findall(r"^    jax\.device_put_replicated = .*?^    \)$", brax.__doc__, re.M | re.S)
    monkeypatch.setattr(jax, "device_put_replicated", None, raising=False)  # undone at the end
    exec(textwrap.dedent(lines[0]), {"jax": jax})
    few = partial(
        networks.make_ppo_networks,
        policy_hidden_layer_sizes=(8,),
        value_hidden_layer_sizes=(8,),
    )
    with jax.numpy_rank_promotion("allow"):
        make, params, _ = train.train(
            brax.BraxEnv(Pendulum()),
            num_timesteps=64,
            episode_length=8,
            num_envs=4,
            batch_size=4,
            num_minibatches=1,
            unroll_length=4,
            num_updates_per_batch=1,
            network_factory=few,
            run_evals=False,
        )
        action, _ = make(params, deterministic=True)(jnp.ones(3), jax.random.PRNGKey(0))
    assert action.shape == (1,)
    assert np.isfinite(action).all()
