"""Properties of every environment in every implementation."""

from dataclasses import replace
from pathlib import Path

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from worlds import (
    ANALYTIC,
    ARMS,
    BROKEN,
    DECISIONS,
    FROM_OTHERS,
    IMPLEMENTATIONS,
    LIFTED,
    OTHER,
    OWN_TEST,
    SIMULATED,
    TASKS,
    TOUCH,
    TOUCHING,
    actions,
    apart,
    jitted,
    make,
    many,
    rollout,
    shown,
    start,
    step_grid,
    task_of,
)

from hybrid_rl.envs.mujoco import mjcf, scenery

CASES = [
    *((task, each) for task in SIMULATED for each in IMPLEMENTATIONS),
    *((task, "analytic") for task in ANALYTIC),
]
STATE = {"two_link": 4, "sprk_sand": 4, "sawyer_torque": 14, "legs": 45}  # before a reference
LATE = ("lander",)  # an action moves velocities now, and positions one decision later
PAGE = Path(__file__).resolve().parents[2] / "docs" / "tasks.md"


def test_every_task_has_its_row_on_the_page():
    table = PAGE.read_text(encoding="utf-8").partition("|---|---|---|\n")[2].partition("\n\n")[0]
    rows = [row.split("|")[1].split("`")[1::2] for row in table.splitlines()]
    assert TASKS.keys() | OWN_TEST == {name for names in rows for name in names}
    assert not FROM_OTHERS & TASKS.keys()


@pytest.fixture(params=CASES, ids="-".join)
def env(request):
    return make(*request.param)


def test_states_have_their_shapes_and_are_finite_and_never_truncated(env):
    path, lead = rollout(env), (2, 2, DECISIONS)
    assert path.obs.shape == (*lead, env.spec.obs)
    assert path.obs.dtype == path.reward.dtype == np.float32
    assert path.reward.shape == path.terminated.shape == path.truncated.shape == lead
    assert path.terminated.dtype == path.truncated.dtype == bool
    assert not path.truncated.any()
    assert all(np.isfinite(leaf[TOUCHING]).all() for leaf in jax.tree.leaves(path))
    assert (np.abs(path.obs[TOUCHING][-1] - path.obs[TOUCHING][0]) > 1e-3).any()


def test_lanes_are_equal_by_start_and_nan_stays_in_its_own(env):
    path = rollout(env)
    for leaf in jax.tree.leaves(path):
        np.testing.assert_array_equal(leaf[TOUCHING], leaf[OTHER])
    late = 5 + (task_of(env) in LATE)
    assert np.isfinite(path.obs[BROKEN][:5]).all()
    assert np.isnan(path.obs[BROKEN][late:, : STATE.get(task_of(env))]).all()
    assert np.isnan(path.reward[BROKEN][5:]).all()


def test_it_is_equal_by_value_and_its_pose_is_one_of_its_scene(env):
    again = replace(env)
    assert (env, hash(env)) == (again, hash(again))
    model, pose_of = mjcf.load(scenery.scene_of(env)), scenery.pose_of(env)
    pose = jax.eval_shape(lambda key: pose_of(env.reset(key)), jax.random.key(0))
    assert pose.shape == (model.nq,)
    assert model.camera("track").id >= 0


@pytest.mark.parametrize("task", ["ant", "humanoid", "quadcopter", *ARMS, "sawyer_torque"])
def test_finite_for_long(task):
    """Random decisions beyond the end of episodes."""
    env, rng = make(task), np.random.default_rng(0)
    state = start(env)
    for _ in range(200):
        action = rng.uniform(-1, 1, (2, 2, env.spec.act)).astype(np.float32)
        state = step_grid(env)(state, jnp.asarray(action))
        assert np.isfinite(state.obs).all()
        assert np.isfinite(state.reward).all()


@pytest.mark.parametrize("task", TASKS)
def test_resets_differ_by_key_and_repeat(task):
    reset = jitted(make(task), "reset")
    first, again, other = (reset(jax.random.key(k)).obs for k in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert (np.asarray(first) != np.asarray(other)).any()


VARIANTS = [  # beside the defaults
    ("quadcopter_se3", {"drag": False}),
    ("quadcopter_se3", {"turn": 1.0, "terminate": False}),
    ("lander", {"task": "hover"}),
]
EUCLIDEAN = [
    make(task, **given)
    for task, given in [*((task, {}) for task in ANALYTIC), *VARIANTS]
    if hasattr(TASKS[task], "from_local")
]


@pytest.mark.parametrize("env", EUCLIDEAN, ids=repr)
def test_dynamics_rest_at_the_equilibrium_and_are_those_of_a_step(env):
    """Local coordinates are 0 there, and invert; the reward is that of observations, if known."""
    with jax.enable_x64(True):
        x, u = env.equilibrium()
        np.testing.assert_allclose(jax.jit(env.dynamics)(x, u), x, atol=1e-12)
        np.testing.assert_array_equal(env.to_local(x), 0)
        size = env.to_local(x).size
        e = jnp.asarray(np.random.default_rng(0).uniform(-0.4, 0.4, size))
        np.testing.assert_allclose(env.to_local(env.from_local(e)), e, atol=1e-12)
    assert np.abs(u).max() < 1
    state, u = jitted(env, "reset")(jax.random.key(3)), jnp.linspace(-0.5, 0.7, env.spec.act)
    after = jitted(env, "step")(state, u)
    np.testing.assert_allclose(after.obs, jitted(env, "dynamics")(state.obs, u), atol=1e-5)
    if hasattr(env, "reward_of"):
        paid = jitted(env, "reward_of")(state.obs, u, after.obs)
        np.testing.assert_allclose(after.reward, paid, rtol=1e-5)
        assert float(after.reward) != 0


@pytest.mark.parametrize("task", [t for t, kind in TASKS.items() if hasattr(kind, "reference")])
def test_a_reference_comes_true(task):
    """What is next at one decision is now at the one after; at the equilibrium both are there."""
    env, n = make(task), STATE[task]
    now, later = many(env, "reference")(jnp.asarray(rollout(env).obs[TOUCHING]))
    np.testing.assert_allclose(now[1:, :n], later[:-1, :n], atol=1e-6)
    x, _ = env.equilibrium()
    np.testing.assert_array_equal(env.reference(x)[0], x)


POINTS = {
    "quadcopter": lambda data: [data.body("quadcopter").xpos],
    "sawyer_push": lambda data: [data.site("tip").xpos, data.body("cube").xpos],
    "panda_stack": lambda data: [data.site("tool").xpos, data.body("block").xpos],
}


@pytest.mark.parametrize("task", POINTS)
def test_points_of_observations_are_where_mujoco_has_them(task):
    """From a state and the observations of eight decisions."""
    env = make(task)
    states = [jax.tree.map(lambda a, t=t: a[(*OTHER, t)], rollout(env)) for t in range(8)]
    want = np.array([POINTS[task](shown(env, state)) for state in states])
    near = 2e-3 if task == "sawyer_push" else 1e-5  # the height of its rod is not observed
    points = env.points(states[0], np.stack([state.obs for state in states]))
    np.testing.assert_allclose(points, want, atol=near)
    assert np.ptp(want[:, 0], axis=0).max() > 0.01


S, C = np.sin(0.3), np.cos(0.3)
TURNED = Rotation.from_rotvec([0.2, -0.3, 0.1]).as_matrix()
LONG, LEANING = {"length": 1.2}, [0.3, 0.5, 0, 0]
FALLING, FLYING = [0.2, 0.3, -0.3, 0, 0, 0], [1, 2, 3, *TURNED.ravel(), *[0] * 6]
SHOWN = [  # a state, and where a body or a geom is then in the scene: position [m], and its z axis
    ("cart_pendulum", LONG, LEANING, "rod", [0.5 + 0.6 * S, 0, 0.6 * C], [-S, 0, -C]),
    ("cart_swing_up", LONG, LEANING, "rod", [0.5 - 0.6 * S, 0, 0.6 * C], [S, 0, -C]),
    ("cart_double_pendulum", {}, FALLING, "upper", [0.2 + S / 2, 0, C / 2], [-S, 0, C]),
    ("lander", {}, [0.4, 0.3, np.pi / 2, 0, 0, 0], "lander", [0.4, 0, 0.3], [-1, 0, 0]),
    ("two_link", {}, [0.3, 0, 0, 0], "tip", [0.2 * C, 0.2 * S, None], None),
    ("quadcopter_se3", {}, FLYING, "frame", [1, 2, 3], TURNED[:, 2]),
]


@pytest.mark.parametrize(("task", "given", "x", "name", "position", "axis"), SHOWN)
def test_a_scene_shows_the_state(task, given, x, name, position, axis):
    env = make(task, **given)
    state = jitted(env, "reset")(jax.random.key(0)).replace(data=jnp.asarray(x, jnp.float32))
    data = shown(env, state)
    found = data.geom(name) if name in ("rod", "tip") else data.body(name)
    for got, want in zip(found.xpos, position, strict=True):
        assert want is None or got == pytest.approx(want, abs=1e-6)
    if axis is not None:
        np.testing.assert_allclose(found.xmat.reshape(3, 3)[:, 2], axis, atol=1e-6)


BOX = (0.5, 0.5, 0, 0.1, 0.1)  # an object of the contact plane without its rounding


@pytest.mark.parametrize(
    ("task", "given", "line"),
    [
        ("halfcheetah", {"motors": [1.0, 1.0]}, r"motors=.*: must be 1 or 6 numbers"),
        ("contact_plane", {"objects": ((*BOX, 0.2),)}, "rounding"),
        ("sprk", {"low": (1.0, 0.0)}, "low="),
    ],
)
def test_values_that_do_not_fit_are_named(task, given, line):
    with pytest.raises(ValueError, match=line):
        TASKS[task](**given)


# Largest difference from MuJoCo C over 20 decisions in contact, 1e-4 for itself, and by MJX.
BY_MJX = {
    "halfcheetah": 3e-3,
    "walker2d": 1e-3,
    "ant": 3e-3,
    "humanoid": 1e-3,
    "sawyer_push": 5e-2,
    "panda_stack": 1e-1,
    "sawyer_torque": 2e-4,
}


@pytest.mark.parametrize("implementation", IMPLEMENTATIONS)
@pytest.mark.parametrize("task", SIMULATED)
def test_it_moves_as_in_mujoco_in_the_air_and_in_contact(task, implementation):
    near = BY_MJX.get(task, 1e-4) if implementation == "mjx" else 1e-4
    free = 1e-3 if task in ("ant", "humanoid", "walker2d") else 1e-4
    env = make(task, implementation)
    assert apart(env, LIFTED) < free
    assert apart(env, TOUCHING) < near


@pytest.mark.parametrize("task", TOUCH)
def test_contact_is_made(task):
    """Otherwise the bounds above would not test contact."""
    path = rollout(make(task)).data
    model = mjcf.load(path.asset)
    data, touching = mujoco.MjData(model), {model.geom(name).id for name in TOUCH[task][0]}
    counts = {TOUCHING: 0, LIFTED: 0}
    for lane in counts:
        for data.qpos[:] in np.asarray(path.qpos)[lane]:
            mujoco.mj_forward(model, data)
            counts[lane] += any(touching <= set(pair) for pair in data.contact.geom.tolist())
    assert counts[TOUCHING] >= 5
    assert counts[LIFTED] == 0


@pytest.mark.parametrize("task", [task for task in SIMULATED if task not in ARMS])
def test_a_single_environment_gives_the_same_bits_as_a_batch(task):
    env = make(task)
    state = jax.tree.map(lambda a: a[TOUCHING], start(env))
    for t, action in enumerate(actions(env)[TOUCHING]):
        state = jitted(env, "step")(state, action)
        batch = jax.tree.leaves(rollout(env).data)
        for single, several in zip(jax.tree.leaves(state.data), batch, strict=True):
            np.testing.assert_array_equal(single, several[TOUCHING][t])
