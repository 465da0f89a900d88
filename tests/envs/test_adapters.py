"""Environments with the interfaces of Gymnasium and Brax."""

import re
import shutil
import subprocess
import sys
import textwrap
import warnings
from functools import partial

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

from hybrid_rl import config
from hybrid_rl.envs import gym
from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv, GymnasiumVectorEnv
from hybrid_rl.envs.adapters.packed import pack, unpack
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.analytic.two_link import TwoLink
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.hopper import Hopper
from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.errors import UsageError

pytestmark = pytest.mark.turns(2)

ID = "hybrid_rl/"


def can_draw():
    """Whether this machine can render."""
    try:
        offscreen.backend()
    except offscreen.NoGraphicsError:
        return False
    return True


@pytest.mark.filterwarnings("ignore:.*Box observation space (min|max)imum value is:UserWarning")
@pytest.mark.parametrize("name", ["HalfCheetah", "Hopper", "TwoLink"])
def test_gymnasium_accepts_an_environment(name):
    """By its id, whose environment has a `spec`."""
    env = gymnasium.make(f"hybrid_rl/{name}", render_mode="rgb_array")
    check_env(env.unwrapped, skip_render_check=not can_draw())
    env.close()


def test_every_task_has_an_id_and_its_time_limit():
    """A decision of the cartpole's task is two of its environment's."""
    outside = {"gymnasium", "playground", "robot", "online"}
    files = {path.stem for path in config.CONF.glob("task/*.yaml")} - outside
    targets = [spec.kwargs["world"] for name, spec in gymnasium.registry.items() if ID in name]
    assert len(targets) == len(set(targets)) == len(files)
    assert gymnasium.spec("hybrid_rl/Walker2d").max_episode_steps == 1000
    assert gymnasium.spec("hybrid_rl/Cartpole").max_episode_steps == 2 * 500
    assert GymnasiumEnv(TwoLink()).steps == GymnasiumVectorEnv(TwoLink(), 2).steps == 200


CRANE = """
defaults: [{base}_self_]
task: crane
env: {{_target_: crane.Crane}}
episode: {{action_repeat: 3}}
"""


@pytest.fixture
def limits(tmp_path, monkeypatch):
    """The limits of the pendulum and of a user's crane, whose `defaults` begin with `base`."""

    def of(base):
        shutil.copy(config.CONF / "task" / "pendulum.yaml", tmp_path)
        (tmp_path / "crane.yaml").write_text(CRANE.format(base=base))
        monkeypatch.setattr(gym, "TASKS", tmp_path)
        return gym.limits.__wrapped__()

    return of


@pytest.mark.parametrize("base", ["/task@_global_: pendulum, ", "pendulum, "])
def test_a_task_takes_its_time_limit_from_its_defaults(limits, base):
    """The pendulum's 200 decisions, each of three steps."""
    found = limits(base)
    assert found["crane.Crane"] == 3 * 200
    assert found["hybrid_rl.envs.analytic.pendulum.Pendulum"] == 200


def test_a_task_without_the_length_of_an_episode_is_one_line(limits):
    with pytest.raises(UsageError, match=r"crane.yaml: has no steps; a task needs env._target_"):
        limits("/noise: white, ")
    with pytest.raises(UsageError, match=r"crane.yaml: there is no winch.yaml beside it"):
        limits("winch, ")


def test_the_ids_are_registered_without_jax():
    code = "import sys, hybrid_rl.envs.gym; sys.exit('jax' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_an_id_takes_the_fields_of_its_environment():
    long = {"success_distance": 1.0, "max_episode_steps": 4}
    env = gymnasium.make("hybrid_rl.envs.gym:hybrid_rl/TwoLink", **long)
    env.reset(seed=0)
    ends = [env.step(np.zeros(2, np.float32))[3] for _ in range(4)]
    assert (env.unwrapped.env.success_distance, ends) == (1.0, [False, False, False, True])
    envs = gymnasium.make_vec("hybrid_rl/TwoLink", num_envs=2, **long)
    ended = [truncated.all() for _, _, _, truncated, _ in _play(envs, 0, 4)]
    assert (envs.env.success_distance, ended) == (1.0, [False, False, False, True])


def test_an_environment_of_another_package_needs_a_time_limit():
    class Mine(TwoLink):
        pass

    with pytest.raises(ValueError, match="steps: Mine has no time limit of its own; give steps=N"):
        GymnasiumEnv(Mine())
    assert GymnasiumEnv(Mine(), steps=7).steps == 7


def test_wrong_use_is_refused():
    one, many = GymnasiumEnv(TwoLink()), GymnasiumVectorEnv(TwoLink(), 3)
    for call in (one.render, lambda: one.step(np.zeros(2)), lambda: many.step(np.zeros((3, 2)))):
        with pytest.raises(ResetNeeded, match=r"call reset\(\) first"):
            call()
    with pytest.raises(ValueError, match="render_mode='human': choose one of None, 'rgb_array'"):
        GymnasiumEnv(TwoLink(), render_mode="human")
    one.reset(seed=0), many.reset(seed=0)
    with pytest.raises(ValueError, match=r"action has the shape \(3,\); \(2,\) is needed"):
        one.step(np.zeros(3))
    with pytest.raises(ValueError, match=r"action has the shape \(2,\); \(3, 2\) is needed"):
        many.step(np.zeros(2))
    with pytest.raises(ValueError, match=r"action=\[nan, 0\.0\]: all numbers must be finite"):
        one.step([np.nan, 0.0])


def test_a_step_after_the_end_warns_once():
    env, action = GymnasiumEnv(TwoLink(), steps=2), np.zeros(2, np.float32)
    env.reset(seed=0)
    env.step(action), env.step(action)
    with pytest.warns(UserWarning, match=r"the episode is over; call reset\(\)") as warned:
        env.step(action), env.step(action)
    assert len(warned) == 1
    env.reset()
    env.step(action)


def test_info_has_the_metrics():
    """Distance of the arm from its target, in [rad], and whether that is success."""
    env, seen = GymnasiumEnv(TwoLink(success_distance=2.0)), set()
    for seed in range(8):
        obs, first = env.reset(seed=seed)
        after, *_, last = env.step(np.ones(2, np.float32))
        for x, info in ((obs, first), (after, last)):
            distance = float(np.linalg.norm(x[[0, 2]] - x[4:]))
            assert info == {"distance": pytest.approx(distance), "success": distance < 2.0}
            assert type(info["success"]) is bool
            seen.add(info["success"])
    assert seen == {False, True}


def test_infos_are_those_of_single_environments():
    """Gymnasium's own vector environment, which steps one after the other, has the same keys."""
    world = TwoLink(success_distance=1.0)
    make = partial(GymnasiumEnv, world, 4)
    own = gymnasium.vector.SyncVectorEnv([make] * 2, autoreset_mode=AutoresetMode.SAME_STEP)
    ours = GymnasiumVectorEnv(world, 2, steps=4)
    for (*_, a), (*_, b) in zip(_play(own, 0, 5), _play(ours, 0, 5), strict=True):
        assert set(a) == set(b)
        assert a["success"].dtype == b["success"].dtype == bool
        np.testing.assert_array_equal(a["_distance"], b["_distance"])
        if "final_info" in b:
            assert set(a["final_info"]) == set(b["final_info"])
            distance = np.linalg.norm(b["final_obs"][:, [0, 2]] - b["final_obs"][:, 4:], axis=1)
            np.testing.assert_allclose(b["final_info"]["distance"], distance, rtol=1e-5)


def test_a_state_is_packed_without_loss():
    """Keys, counters and flags among numbers."""
    state = jax.jit(TwoLink().reset)(jax.random.key(0))
    new = jax.random.key(5)
    more = {"new": new, "key": jnp.array([1, 2**32 - 1], jnp.uint32), "count": jnp.int32(-3)}
    state = state.replace(info={**state.info, **more})
    like = jax.eval_shape(lambda: state)
    again = jax.jit(lambda x: unpack(pack(x, like), like))(state)
    assert (jax.random.key_data(again.info.pop("new")) == jax.random.key_data(new)).all()
    state.info.pop("new")
    jax.tree.map(np.testing.assert_array_equal, again, state)
    assert jax.tree.map(lambda x: x.dtype, again) == jax.tree.map(lambda x: x.dtype, state)


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
    class Bare:
        spec, reset = TwoLink().spec, TwoLink().reset
        step = None

    env = GymnasiumEnv(Bare(), steps=0)
    env.reset()
    with pytest.raises(ValueError, match="has no `scene` and no `pose`"):
        env.render()


@pytest.mark.parametrize("env", [HalfCheetah("native"), Hopper("native")])
def test_the_adapter_steps_the_environment(env):
    """200 decisions of random actions, without resets."""
    adapter = GymnasiumEnv(env, steps=200)
    adapter.reset(seed=0)
    adapter.action_space.seed(0)
    state, step = adapter.state, jax.jit(env.step)
    for t in range(200):
        action = adapter.action_space.sample()
        with warnings.catch_warnings(action="ignore"):  # the hopper fell
            obs, reward, terminated, truncated, info = adapter.step(action)
        state = step(state, action)
        np.testing.assert_allclose(obs, state.obs, rtol=1e-6)
        assert reward == pytest.approx(float(state.reward), rel=1e-5)
        assert info == {"speed": pytest.approx(float(state.metrics["speed"]), rel=1e-5)}
        assert terminated == bool(state.terminated)
        assert truncated == (t == 199 and not terminated)


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
