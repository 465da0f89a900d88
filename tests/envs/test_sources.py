"""Environments against Gymnasium's: models, trajectories with rewards, initial states."""

import gymnasium
import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import TASKS, jitted, make, many

from hybrid_rl.envs.mujoco import mjcf

NAMES = {
    "halfcheetah": "HalfCheetah-v5",
    "hopper": "Hopper-v5",
    "walker2d": "Walker2d-v5",
    "pendulum": "Pendulum-v1",
    "ant": "Ant-v5",
    "humanoid": "Humanoid-v5",
    "swimmer": "Swimmer-v5",
}
PHYSICAL = ("qpos", "body_", "dof_", "jnt_", "geom_", "actuator_")  # arrays begin with these
DRAWN = ("geom_matid", "geom_rgba", "geom_group", "geom_user", "geom_size")  # the last: the floor
UNUSED = ("jnt_pos", "dof_length")  # of slides; of what sleeps
TOUCHING = ("contype", "conaffinity", "friction", "condim", "margin", "bvh", "geomadr", "geomnum")


@pytest.fixture(autouse=True)
def temporary_folder(tmp_path, monkeypatch):
    """MuJoCo writes a log of deprecated attributes to the working directory."""
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("name", [*(name for name in NAMES if name != "pendulum"), "ant_capsules"])
def test_a_model_is_that_of_gymnasium(name):
    """All that moves; contacts of the ants, whose capsules end in spheres, are in test_ant.py."""
    source = gymnasium.make(NAMES[name.removesuffix("_capsules")]).unwrapped
    ours, theirs = mjcf.load(f"{name}.xml"), source.model
    common, compared = ours.geom_group == 0, 0
    for field in dir(theirs):
        ant = name.startswith("ant") and any(word in field for word in TOUCHING)
        if not field.startswith(PHYSICAL) or field in DRAWN + UNUSED or ant:
            continue
        a, b = getattr(ours, field), getattr(theirs, field)
        a = a[common] if field.startswith("geom_") and len(common) == len(a) else a
        np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-12, err_msg=field)
        compared += 1
    assert compared > 100
    sizes = [m.geom_size[m.geom_group == 0][1:] for m in (ours, theirs)]  # without the floor
    np.testing.assert_allclose(*sizes, rtol=1e-12)
    if name.startswith("ant"):
        assert not ours.geom_contype.any() | ours.geom_conaffinity.any()
    for option in [each for each in dir(theirs.opt) if not each.startswith("_")]:
        a, b = getattr(ours.opt, option), getattr(theirs.opt, option)
        if option == "disableflags":
            assert a ^ b == mujoco.mjtDisableBit.mjDSBL_AUTORESET
        elif option == "solver":
            assert a in (b, mujoco.mjtSolver.mjSOL_NEWTON)  # the humanoid's is PGS
        else:
            np.testing.assert_array_equal(a, b, option)
    source.close()


@pytest.mark.parametrize("task", [task for task in NAMES if task not in ("ant", "humanoid")])
def test_trajectory_and_reward(task):
    """20 random decisions; then, where it falls, one action until it does; float64 there."""
    theirs = gymnasium.make(NAMES[task]).unwrapped
    theirs.reset(seed=3)
    ours, rng, scale = make(task), np.random.default_rng(0), 2.0 if task == "pendulum" else 1.0
    state = jitted(ours, "reset")(jax.random.key(0))
    if task == "pendulum":
        state = state.replace(data=jnp.asarray(theirs.state, jnp.float32))
    else:
        qpos, qvel = (jnp.asarray(x) for x in (theirs.data.qpos, theirs.data.qvel))
        state = state.replace(data=ours._body.reset(qpos, qvel))
    fall = np.resize(np.array([0.5, -0.5, 0.3], np.float32), ours.spec.act)
    for decision in range(200):
        action = rng.uniform(-1, 1, ours.spec.act).astype(np.float32) if decision < 20 else fall
        obs, reward, terminated, _, _ = theirs.step(scale * action)
        state = jitted(ours, "step")(state, action)
        if decision < 20:
            np.testing.assert_allclose(state.obs, obs, atol=1e-4)
            np.testing.assert_allclose(state.reward, reward, atol=1e-4)
        assert bool(state.terminated) == terminated
        if terminated or (task not in ("hopper", "walker2d") and decision == 19):
            break
    assert terminated == (task in ("hopper", "walker2d"))
    assert not hasattr(ours, "ended") or terminated == bool(ours.ended(state.obs))
    theirs.close()


@pytest.mark.parametrize("task", [task for task in NAMES if task != "pendulum"])
def test_initial_states_are_distributed_as_in_gymnasium(task):
    theirs, ours = gymnasium.make(NAMES[task]).unwrapped, TASKS[task](physics="native")
    a = np.array([theirs.reset(seed=i)[0][: ours.spec.obs] for i in range(300)])
    b = np.asarray(many(ours, "reset")(jax.random.split(jax.random.key(0), 300)).obs)
    np.testing.assert_allclose(a.mean(0), b.mean(0), atol=5 * a.std(0).max() / 300**0.5)
    np.testing.assert_allclose(a.std(0), b.std(0), rtol=0.25)
    theirs.close()
