"""Environments against their sources: Gymnasium's models and environments, closed forms."""

from pathlib import Path

import gymnasium
import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import TASKS, jitted, make

from hybrid_rl.envs.cartpole import Cartpole
from hybrid_rl.envs.halfcheetah import LEGS, HalfCheetah, _kneels
from hybrid_rl.envs.locomotion import pybullet_reward
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.physics import Physics

FILES = {
    "halfcheetah": "half_cheetah.xml",
    "hopper": "hopper.xml",
    "walker2d": "walker2d_v5.xml",
    "ant": "ant.xml",
    "ant_capsules": "ant.xml",
    "humanoid": "humanoid.xml",
}
NAMES = {
    "halfcheetah": "HalfCheetah-v5",
    "hopper": "Hopper-v5",
    "walker2d": "Walker2d-v5",
    "pendulum": "Pendulum-v1",
    "ant": "Ant-v5",
    "humanoid": "Humanoid-v5",
}
POINTS = 12  # additional geoms of our ant: the spheres at the ends of capsules
FIELDS = (
    "body_mass",
    "body_inertia",
    "body_ipos",
    "body_iquat",
    "body_pos",
    "body_quat",
    "body_parentid",
    "dof_armature",
    "dof_damping",
    "dof_frictionloss",
    "jnt_type",
    "jnt_axis",
    "jnt_range",
    "jnt_limited",
    "jnt_stiffness",
    "jnt_solref",
    "jnt_solimp",
    "jnt_margin",
    "qpos0",
    "qpos_spring",
    "geom_type",
    "geom_pos",
    "geom_quat",
    "geom_bodyid",
    "geom_friction",
    "geom_condim",
    "geom_contype",
    "geom_conaffinity",
    "geom_margin",
    "geom_gap",
    "geom_solref",
    "geom_solimp",
    "geom_solmix",
    "geom_priority",
    "actuator_gear",
    "actuator_ctrlrange",
    "actuator_ctrllimited",
    "actuator_trnid",
    "actuator_gainprm",
    "actuator_biasprm",
    "actuator_forcelimited",
)
TOUCHING = ("geom_contype", "geom_conaffinity", "geom_friction", "geom_condim", "geom_margin")
OPTIONS = (
    "timestep",
    "integrator",
    "gravity",
    "solver",
    "iterations",
    "ls_iterations",
    "tolerance",
    "ls_tolerance",
    "cone",
    "jacobian",
    "impratio",
    "density",
    "viscosity",
    "wind",
    "enableflags",
)


@pytest.fixture(autouse=True)
def temporary_folder(tmp_path, monkeypatch):
    """MuJoCo writes a log of deprecated attributes to the working directory."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture(params=FILES)
def models(request):
    folder = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
    theirs = mujoco.MjModel.from_xml_path(str(folder / FILES[request.param]))
    return mjcf.load(f"{request.param}.xml"), theirs


@pytest.mark.parametrize("field", FIELDS)
def test_model_field(models, field):
    ours, theirs = (getattr(m, field) for m in models)
    if field.startswith("geom_") and len(ours) == len(theirs) + POINTS:
        common = models[0].geom_group == 0
        if field in TOUCHING:  # tested in test_ant.py
            assert not models[0].geom_contype.any() | models[0].geom_conaffinity.any()
            return
        ours = ours[common]
    np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("field", OPTIONS)
def test_model_option(models, field):
    ours, theirs = (getattr(m.opt, field) for m in models)
    if field == "solver" and theirs == mujoco.mjtSolver.mjSOL_PGS:  # the humanoid's
        theirs = mujoco.mjtSolver.mjSOL_NEWTON
    np.testing.assert_array_equal(ours, theirs)


def test_capsule_sizes(models):
    ours, theirs = (m.geom_size[m.geom_group == 0][1:] for m in models)  # without the floor
    np.testing.assert_allclose(ours, theirs, rtol=1e-12)


def test_only_autoreset_differs(models):
    ours, theirs = (m.opt.disableflags for m in models)
    assert ours ^ theirs == mujoco.mjtDisableBit.mjDSBL_AUTORESET


def _set(task, env, state, qpos, qvel):
    """`state` at qpos, qvel."""
    if task == "pendulum":
        return state.replace(data=jnp.array([qpos[0], qvel[0]], jnp.float32))
    data = env._body.reset(jnp.asarray(qpos), jnp.asarray(qvel))
    return state.replace(data=data)


@pytest.mark.parametrize("task", [task for task in NAMES if task not in ("ant", "humanoid")])
def test_trajectory_and_reward(task):
    """20 decisions; Gymnasium in float64 throughout."""
    theirs = gymnasium.make(NAMES[task]).unwrapped
    theirs.reset(seed=3)
    rng = np.random.default_rng(0)
    if task == "pendulum":
        qpos, qvel = theirs.state[:1], theirs.state[1:]
        scale = 2.0
    else:
        qpos, qvel = theirs.data.qpos, theirs.data.qvel
        scale = 1.0
    ours = make(task, "native")
    state = _set(task, ours, ours.reset(jax.random.key(0)), qpos, qvel)
    step = jitted(ours, "step")
    for _ in range(20):
        action = rng.uniform(-1, 1, ours.spec.act).astype(np.float32)
        obs, reward, terminated, _, _ = theirs.step(scale * action)
        state = step(state, action)
        np.testing.assert_allclose(state.obs, obs, atol=1e-4)
        np.testing.assert_allclose(state.reward, reward, atol=1e-4)
        assert bool(state.terminated) == terminated
    theirs.close()


@pytest.mark.parametrize("task", ["hopper", "walker2d"])
def test_terminates_with_that_of_gymnasium(task):
    theirs = gymnasium.make(NAMES[task]).unwrapped
    theirs.reset(seed=1)
    ours = make(task, "native")
    state = _set(task, ours, ours.reset(jax.random.key(0)), theirs.data.qpos, theirs.data.qvel)
    step = jitted(ours, "step")
    action = np.resize(np.array([0.5, -0.5, 0.3], np.float32), ours.spec.act)
    decisions = 0
    while not state.terminated:
        terminated = theirs.step(action)[2]
        state = step(state, action)
        assert bool(state.terminated) == terminated == bool(ours.ended(state.obs))
        decisions += 1
    assert 5 < decisions < 200


@pytest.mark.parametrize(
    ("z", "pitch", "ends"),
    [
        (0.78, 0.0, True),
        (0.84, 0.98, False),
        (0.84, -1.02, True),
        (1.98, 0.0, False),
        (2.02, 0, True),
    ],
)
def test_walker_is_healthy_where_that_of_gymnasium_is(z, pitch, ends):
    theirs = gymnasium.make("Walker2d-v5").unwrapped
    theirs.reset(seed=1)
    qpos, qvel = np.array([0, z, pitch, 0, -1, 0, 0, -1, 0]), np.zeros(9)
    theirs.set_state(qpos, qvel)
    ours = make("walker2d", "native")
    state = _set("walker2d", ours, ours.reset(jax.random.key(0)), qpos, qvel)
    after = jitted(ours, "step")(state, jnp.zeros(6))
    _, reward, terminated, *_ = theirs.step(np.zeros(6))
    assert bool(after.terminated) == terminated == ends == bool(ours.ended(after.obs))
    np.testing.assert_allclose(after.reward, float(reward), atol=1e-4)


@pytest.mark.parametrize("task", ["halfcheetah", "hopper", "walker2d", "ant", "humanoid"])
def test_initial_states_are_distributed_as_in_gymnasium(task):
    theirs = gymnasium.make(NAMES[task]).unwrapped
    size = TASKS[task](physics="native").spec.obs
    a = np.array([theirs.reset(seed=i)[0][:size] for i in range(300)])
    b = jax.vmap(TASKS[task](physics="native").reset)(jax.random.split(jax.random.key(0), 300))
    b = np.asarray(b.obs)
    np.testing.assert_allclose(a.mean(0), b.mean(0), atol=5 * a.std(0).max() / 300**0.5)
    np.testing.assert_allclose(a.std(0), b.std(0), rtol=0.25)
    theirs.close()


def test_walker_reward():
    limits = jnp.array([[-1.0, 1.0], [0.0, 2.0]])
    reward = pybullet_reward(
        jnp.array(True),
        jnp.float32(2.0),
        jnp.array([0.5, -1.0]),
        jnp.array([0.0, 2.0]),
        jnp.array([4.0, 2.0]),
        limits,
    )
    # 1 + 2 - 2 * mean(.5 * .4, 1 * .2) - 0.1 * mean(.25, 1) - 0.1 * 1
    np.testing.assert_allclose(reward, 1 + 2 - 2 * 0.2 - 0.0625 - 0.1, rtol=1e-6)


def test_cheetah_kneels_where_mujoco_has_a_contact():
    body = Physics("halfcheetah_contact.xml", "native")
    model, rng = body.model, np.random.default_rng(0)
    data = mujoco.MjData(model)
    qpos = rng.uniform(-0.5, 0.5, (300, 9)).astype(np.float32)
    qpos[:, 1] -= 0.1
    kneels = jax.vmap(lambda q: _kneels(body, body.reset(q, jnp.zeros(9))))(qpos)
    legs, truth = {model.geom(name).id for name in LEGS}, []
    for q in qpos:
        data.qpos[:] = q
        mujoco.mj_forward(model, data)
        truth.append(bool(legs & set(data.contact.geom2.tolist())))
    assert 30 < sum(truth) < 270
    np.testing.assert_array_equal(kneels, truth)


@pytest.mark.parametrize("task", ["hopper", "walker2d"])
def test_pybullet_rewards_terminate_all_but_the_cheetah(task):
    cheetah = HalfCheetah("native", "pybullet")
    state = cheetah.reset(jax.random.key(0))
    over = state.data.replace(qpos=jnp.array([0, 0, 3, 0, 0, 0, 0, 0, 0], jnp.float32))
    step = jitted(cheetah, "step")
    stand, fall = step(state, jnp.zeros(6)), step(state.replace(data=over), jnp.zeros(6))
    assert stand.reward - stand.metrics["speed"] > 0.5
    assert fall.reward - fall.metrics["speed"] < -0.9
    assert not fall.terminated
    walker = TASKS[task]("native", "pybullet")
    state, still = walker.reset(jax.random.key(0)), jnp.zeros(walker.spec.act)
    leaning = state.data.qpos.at[2].set(0.9)
    assert not jitted(walker, "step")(state, still).terminated
    tipped = state.replace(data=state.data.replace(qpos=leaning.at[2].set(1.1)))
    leaning = state.replace(data=state.data.replace(qpos=leaning))
    assert not jitted(walker, "step")(leaning, still).terminated
    after = jitted(walker, "step")(tipped, still)
    assert after.terminated
    assert after.reward - after.metrics["speed"] < -0.9


def _tolerance(x, margin):
    """dm_control's `tolerance` with bounds (0, 0), Gaussian, 0.1 at the margin."""
    return np.exp(-0.5 * (np.abs(x) / margin * np.sqrt(-2 * np.log(0.1))) ** 2)


def test_cartpole_rewards():
    cos, dm = Cartpole("native", "cos"), Cartpole("native", "dm_control")
    state = cos.reset(jax.random.key(0))
    rng = np.random.default_rng(0)
    for qpos, qvel, a in zip(*rng.uniform(-1, 1, (2, 5, 2)), range(5), strict=True):
        now = state.replace(data=cos._body.reset(jnp.array(qpos), jnp.array(qvel)))
        action = jnp.array([a / 4], jnp.float32)
        after = jitted(cos, "step")(now, action)
        x, _, c, _, w = np.asarray(after.obs)
        np.testing.assert_allclose(after.reward, c, rtol=1e-6)
        expected = (1 + c) / 2 * (1 + _tolerance(x, 2)) / 2 * (4 + 1 - (a / 4) ** 2) / 5
        expected *= (1 + _tolerance(w, 5)) / 2
        np.testing.assert_allclose(jitted(dm, "step")(now, action).reward, expected, rtol=1e-5)
        assert jitted(dm, "step")(now, action).reward <= 1.0
    top = state.replace(data=dm._body.reset(jnp.zeros(2), jnp.zeros(2)))
    np.testing.assert_allclose(jitted(dm, "step")(top, jnp.zeros(1)).reward, 1.0, atol=1e-6)
