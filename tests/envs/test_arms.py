"""Arms against the tables of their makers and MuJoCo C; what a hand can do with them."""

from math import pi

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from scripts import play, push, stack
from worlds import DECISIONS, IMPLEMENTATIONS, make, program

from hybrid_rl.envs import mjcf
from hybrid_rl.envs.kinematics import Chain, damped, hold, inverse, times, turn, within
from hybrid_rl.envs.panda_stack import READY, TOOL, PandaStack
from hybrid_rl.envs.sawyer_push import HEIGHT, HOME, TIP, SawyerPush

SAWYER, PANDA = "sawyer_push.xml", "panda_stack.xml"
POSES = [  # asset, site, joints [rad], where the site is [m]: computed from the makers' tables
    (SAWYER, "hand", (0, -1.18, 0, 2.18, 0, 0.57, 3.3161), (0.4496, 0.1603, 0.2158)),
    (SAWYER, "hand", HOME, (0.5595, 0.0307, -0.0530)),
    (SAWYER, "hand", (-0.2, -0.6, 0, 1.9, 0, 0.3, 1.571), (0.5358, 0.0550, 0.0230)),
    (SAWYER, "hand", (0,) * 7, (1.0155, 0.1603, 0.3170)),
    (PANDA, "tool", READY, (0.30689, 0, 0.48688)),
    (PANDA, "tool", (0, 0, 0, -pi / 2, 0, pi / 2, -0.7853), (0.5545, 0, 0.5211)),
    (PANDA, "tool", (0, 0.3, 0, -pi / 2, 0, 2, -0.7853), (0.6778, 0, 0.3785)),
    (PANDA, "tool", (0, pi / 16, 0, -5 * pi / 6, 0, pi - 0.2, pi / 4), (0.4581, 0, 0.0922)),
]
MASSES = {  # [kg]
    SAWYER: {
        **dict(base=2.0687, l0=5.3213, l1=4.505, l2=1.745, l3=2.5097, l4=1.1136, l5=1.5625),
        **dict(l6=0.3292, rod=0.05, cube=0.1),
    },
    PANDA: {
        **dict(link0=0.629769, link1=4.970684, link2=0.646926, link3=3.228604, link4=3.587895),
        **dict(link5=1.225946, link6=1.666555, link7=0.735522, hand=0.73),
        **dict(left_finger=0.015, right_finger=0.015, block=0.1, base=0.1),
    },
}
LIMITS = {  # least, greatest [rad]; velocity [rad/s]; torque [N m]
    SAWYER: [
        (-3.0503, 3.0503, 1.74, 80),
        (-3.8095, 2.2736, 1.328, 80),
        (-3.0426, 3.0426, 1.957, 40),
        (-3.0439, 3.0439, 1.957, 40),
        (-2.9761, 2.9761, 3.485, 9),
        (-2.9761, 2.9761, 3.485, 9),
        (-4.7124, 4.7124, 4.545, 9),
    ],
    PANDA: [
        (-2.8973, 2.8973, 2.175, 87),
        (-1.7628, 1.7628, 2.175, 87),
        (-2.8973, 2.8973, 2.175, 87),
        (-3.0718, -0.0698, 2.175, 87),
        (-2.8973, 2.8973, 2.61, 12),
        (-0.0175, 3.7525, 2.61, 12),
        (-2.8973, 2.8973, 2.61, 12),
    ],
}
PRINCIPAL = {  # moments of inertia [kg m^2], greatest first
    "l0": (0.06516, 0.05109, 0.01862),
    "l1": (0.02243, 0.02216, 0.00971),
    "l2": (0.02579, 0.02551, 0.00293),
    "l3": (0.01024, 0.00970, 0.00370),
    "l4": (0.01365, 0.01355, 0.00127),
    "l5": (0.00474, 0.00423, 0.00191),
    "l6": (0.00036, 0.00031, 0.00021),
}
SINGULAR = {  # values of the Jacobian at the first pose
    (SAWYER, "hand", HOME): (1.88, 1.81, 1.07, 0.357, 0.345, 0.243),
    (PANDA, "tool", READY): (1.81, 1.68, 1.15, 0.342, 0.305, 0.221),
}


def _at(asset, joints):
    """MuJoCo's data of `asset` at these joints."""
    model = mjcf.load(asset)
    data = mujoco.MjData(model)
    data.qpos[: len(joints)] = joints
    mujoco.mj_forward(model, data)
    return model, data


def _pose(asset, site, qpos):
    return jax.jit(Chain(asset, site).pose)(jnp.asarray(qpos, jnp.float32))


@pytest.mark.parametrize(("asset", "site", "joints", "place"), POSES)
def test_poses_are_the_makers(asset, site, joints, place):
    _, data = _at(asset, joints)
    np.testing.assert_allclose(data.site(site).xpos, place, atol=6e-5)


@pytest.mark.parametrize(("asset", "site", "joints", "place"), POSES)
def test_chain_is_mujocos(asset, site, joints, place):
    """Position, rotation and Jacobian, at this pose and at one that is nothing special."""
    for shift in (0.0, 0.1):
        model, data = _at(asset, np.add(joints, shift))
        position, rotation, jacobian = _pose(asset, site, data.qpos)
        expected = np.zeros((2, 3, model.nv))
        mujoco.mj_jacSite(model, data, *expected, model.site(site).id)
        matrix = jax.vmap(turn, (None, 0), 1)(rotation, jnp.eye(3))
        np.testing.assert_allclose(position, data.site(site).xpos, atol=2e-6)
        np.testing.assert_allclose(matrix, data.site(site).xmat.reshape(3, 3), atol=2e-6)
        np.testing.assert_allclose(jacobian, expected.reshape(6, -1)[:, :7], atol=2e-6)


def test_chain_of_slides_and_shifted_hinges(tmp_path):
    file = tmp_path / "chain.xml"
    inner = """<body pos="0.3 0 0" quat="1 2 0 0"><joint axis="0 1 0" pos="0.1 0.2 0"/>
      <joint type="slide" axis="0 0.6 0.8" ref="0.5"/><geom size="0.1"/>
      <site name="end" pos="0 0 1" quat="1 0 1 0"/></body>"""
    file.write_text(
        "<mujoco><option><flag autoreset='disable'/></option><worldbody><body>"
        f"<joint type='slide'/><geom size='0.1'/>{inner}</body></worldbody></mujoco>"
    )
    model, data = _at(str(file), (0.4, 0.7, -0.2))
    position, rotation, jacobian = _pose(str(file), "end", data.qpos)
    expected = np.zeros((2, 3, model.nv))
    mujoco.mj_jacSite(model, data, *expected, 0)
    np.testing.assert_allclose(position, data.site("end").xpos, atol=1e-6)
    np.testing.assert_allclose(jacobian, expected.reshape(6, -1), atol=1e-6)
    place, quat = Chain(str(file), "end").at((0.4, 0.7, -0.2))
    np.testing.assert_allclose(place, position, atol=1e-6)
    np.testing.assert_allclose(np.abs(quat @ rotation), 1.0, atol=1e-6)


@pytest.mark.parametrize("asset", MASSES)
def test_masses(asset):
    model = mjcf.load(asset)
    names = {model.body(i).name: model.body(i).mass[0] for i in range(1, model.nbody)}
    assert names == pytest.approx(MASSES[asset])


def test_moving_masses():
    sawyer, panda = mjcf.load(SAWYER), mjcf.load(PANDA)
    assert sawyer.body("l0").subtreemass[0] == pytest.approx(17.0863 + 0.05, abs=1e-3)
    assert panda.body("link1").subtreemass[0] == pytest.approx(16.822, abs=1e-3)


@pytest.mark.parametrize("name", PRINCIPAL)
def test_principal_inertia(name):
    inertia = sorted(mjcf.load(SAWYER).body(name).inertia, reverse=True)
    np.testing.assert_allclose(inertia, PRINCIPAL[name], atol=6e-6)


@pytest.mark.parametrize("asset", LIMITS)
def test_limits(asset):
    model, (low, high, speed, torque) = mjcf.load(asset), np.transpose(LIMITS[asset])
    np.testing.assert_allclose(model.jnt_range[:7], np.stack((low, high), 1))
    np.testing.assert_allclose(model.actuator_ctrlrange[:7], np.stack((-speed, speed), 1))
    np.testing.assert_allclose(model.actuator_forcerange[:7], np.stack((-torque, torque), 1))
    assert model.jnt_limited[:7].all()
    assert model.actuator_forcelimited[:7].all()


@pytest.mark.parametrize(("asset", "site", "joints"), SINGULAR)
def test_damped_least_squares(asset, site, joints):
    _, data = _at(asset, joints)
    jacobian = _pose(asset, site, data.qpos)[2]
    values = np.linalg.svd(jacobian, compute_uv=False)
    np.testing.assert_allclose(values, SINGULAR[asset, site, joints], atol=6e-3)
    twist = np.array([0.1, -0.05, 0.02, 0.0, 0.1, 0.0])
    wish = np.array([0.3, -0.2, 0.5, 0.1, -0.4, 0.2, 0.3])
    inverted = np.linalg.pinv(jacobian)
    exact = damped(jacobian, twist, 1e-4, jnp.zeros(7))
    np.testing.assert_allclose(exact, inverted @ twist, atol=2e-4)
    near = damped(jacobian, twist, 1e-4, wish)
    free = wish - inverted @ (jacobian @ wish)  # what of the wish moves no site
    np.testing.assert_allclose(near, inverted @ twist + free, atol=1e-3)
    assert np.linalg.norm(free) > 0.1
    straight = np.array([0.1, -0.05, 0.02, 0.0, 0.0, 0.0])
    given = jacobian @ damped(jacobian, straight, 0.02, jnp.zeros(7))
    assert np.linalg.norm(given - straight) < 0.01 * np.linalg.norm(straight)


def test_rotations():
    rng = np.random.default_rng(0)
    r, s = (jnp.asarray(q / np.linalg.norm(q), jnp.float32) for q in rng.normal(size=(2, 4)))
    v = jnp.asarray(rng.normal(size=3), jnp.float32)
    product, turned = np.empty(4), np.empty(3)
    mujoco.mju_mulQuat(product, np.asarray(r, float), np.asarray(s, float))
    mujoco.mju_rotVecQuat(turned, np.asarray(v, float), np.asarray(r, float))
    np.testing.assert_allclose(times(r, s), product, atol=1e-6)
    np.testing.assert_allclose(turn(r, v), turned, atol=1e-6)
    np.testing.assert_allclose(turn(inverse(r), turn(r, v)), v, atol=1e-6)
    small = jnp.array([1.0, 0.005, -0.01, 0.002])  # 0.01, -0.02, 0.004 rad
    wanted = times(small / jnp.linalg.norm(small), r)
    np.testing.assert_allclose(hold(r, -wanted, 5.0), [0.05, -0.1, 0.02], atol=1e-4)


def test_within_stops_only_what_leaves():
    low, high = jnp.zeros(4), jnp.ones(4)
    velocity, place = jnp.array([1.0, -1.0, 1.0, -1.0]), jnp.array([1.5, 1.5, -0.5, -0.5])
    np.testing.assert_array_equal(within(velocity, place, low, high), [0.0, -1.0, 1.0, 0.0])


def test_the_rod_goes_where_it_is_told():
    """2 s along y at 0.1 m/s: straight, level and upright."""
    env = SawyerPush("native", smoothing=0.0)
    state = env.reset(jax.random.key(0))
    aside = state.data.qpos.at[7:9].set(jnp.array([0.7, 0.4]))
    state = state.replace(data=state.data.replace(qpos=aside))
    begin, upright = TIP.at(HOME)
    step = jax.jit(env.step)
    for _ in range(20):
        state = step(state, jnp.array([0.0, 0.1 / 0.15]))
    tip, rotation, _ = TIP.pose(state.data.qpos)
    np.testing.assert_allclose(tip - begin, [0.0, 0.2, 0.0], atol=0.01)
    assert abs(tip[2] - begin[2]) < 1e-3
    assert jnp.abs(hold(rotation, jnp.asarray(upright), 1.0)).max() < np.radians(0.5)
    for _ in range(40):
        state = step(state, jnp.array([1.0, 1.0]))
    tip = TIP.pose(state.data.qpos)[0]
    np.testing.assert_allclose(tip[:2], env.high, atol=0.02)


def test_the_filter_keeps_what_it_says():
    sawyer, panda = SawyerPush("native"), PandaStack("native")
    state = jax.jit(sawyer.reset)(jax.random.key(0))
    state = jax.jit(sawyer.step)(state, jnp.array([1.0, -1.0]))
    np.testing.assert_allclose(state.info["velocity"], [0.03, -0.03], rtol=1e-5)
    state = jax.jit(sawyer.step)(state, jnp.zeros(2))
    np.testing.assert_allclose(state.info["velocity"], [0.024, -0.024], rtol=1e-5)
    state = jax.jit(panda.reset)(jax.random.key(0))
    state = jax.jit(panda.step)(state, jnp.array([1.0, 0.0, 0.0, 1.0]))
    np.testing.assert_allclose(state.info["velocity"][0], 0.15 * (1 - np.exp(-0.5)), rtol=1e-5)
    assert state.info["closed"] == 1.0


def _sawyer(tip_to_block, block_to_target, action, **fields):
    """One decision that moves nothing, from a block and target so placed."""
    env = SawyerPush("native", **fields)
    state = env.reset(jax.random.key(0))
    block = TIP.pose(state.data.qpos)[0][:2] + jnp.asarray(tip_to_block)
    qpos = state.data.qpos.at[7:9].set(block)
    info = {**state.info, "target": block + jnp.asarray(block_to_target)}
    return env.step(state.replace(data=state.data.replace(qpos=qpos), info=info), action)


def test_push_reward_by_hand():
    state = _sawyer((0.3, 0.4), (0.0, 0.1), jnp.zeros(2))
    np.testing.assert_allclose(state.reward, -5 * 0.1 - 10 * 0.5, atol=2e-3)
    np.testing.assert_allclose(state.obs, [3.0, 4.0, 0.0, -1.0], atol=2e-3)
    acted = _sawyer((0.3, 0.4), (0.0, 0.1), jnp.array([0.0, 1.0]), speed=0.0)
    np.testing.assert_allclose(acted.reward - state.reward, -0.01, atol=1e-4)
    assert not state.terminated
    assert _sawyer((0.3, 0.4), (0.0, 0.049), jnp.zeros(2)).terminated
    going_on = _sawyer((0.3, 0.4), (0.0, 0.049), jnp.zeros(2), terminate=False)
    assert going_on.metrics["success"] == 1.0
    assert not going_on.terminated


def test_push_starts_are_apart():
    env = SawyerPush("native")
    states = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(0), 500))
    block, target = np.asarray(states.data.qpos[:, 7:9]), np.asarray(states.info["target"])
    tip = TIP.at(HOME)[0][:2]
    assert (np.linalg.norm(block - tip, axis=1) > 0.06).all()
    assert (np.linalg.norm(block - env.block, axis=1) <= 0.08 + 1e-6).all()
    assert (np.linalg.norm(block - target, axis=1) > 0.12).all()
    assert (target >= env.target_low).all()
    assert (target <= env.target_high).all()
    assert (target.std(0) > [0.04, 0.08]).all()
    np.testing.assert_allclose(states.data.qpos[:, 9], HEIGHT)
    assert not states.terminated.any()


def _panda(env, block, closed, fingers):
    """The state that the task sees with the block so far from the hand [3]."""
    state = env.reset(jax.random.key(0))
    tool = TOOL.pose(state.data.qpos)[0]
    held = jnp.concatenate([jnp.full(2, fingers), tool + jnp.asarray(block)])
    data = state.data.replace(qpos=state.data.qpos.at[7:12].set(held))
    info = {**state.info, "closed": jnp.float32(closed)}
    return env._state(data, jnp.zeros(4), info), tool


def test_stack_reward_by_hand():
    env = PandaStack("native")
    free, tool = _panda(env, (0.3, 0.0, -0.4), 0.0, 0.04)
    np.testing.assert_allclose(free.reward, -0.5, rtol=1e-5)
    held, _ = _panda(env, (0.0, 0.005, 0.01), 1.0, 0.0255)
    goal = np.array([0.45, 0.12, 0.075])
    np.testing.assert_allclose(held.reward, -1.25 * np.linalg.norm(tool - goal), rtol=1e-5)
    assert held.metrics["grasped"] == 1.0
    for block, closed, fingers in [
        ((0.0, 0.005, 0.01), 0.0, 0.0255),  # told to open
        ((0.0, 0.005, 0.01), 1.0, 0.03),  # not closed
        ((0.0, 0.0, -0.03), 1.0, 0.025),  # beside the block
    ]:
        assert _panda(env, block, closed, fingers)[0].metrics["grasped"] == 0.0


def test_stack_success_by_hand():
    env = PandaStack("native")
    _, tool = _panda(env, (0.0, 0.0, 0.0), 0.0, 0.04)
    there = np.array([0.45, 0.12, 0.075]) - np.asarray(tool)
    assert _panda(env, there, 0.0, 0.04)[0].terminated
    assert not _panda(PandaStack("native", terminate=False), there, 0.0, 0.04)[0].terminated
    for shift, closed in [((0.03, 0, 0), 0.0), ((0, 0, 0.015), 0.0), ((0, 0, 0), 1.0)]:
        assert _panda(env, there + shift, closed, 0.04)[0].metrics["success"] == 0.0


def test_a_base_anywhere_is_seen():
    env = PandaStack("native", base_spread=0.03)
    states = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(0), 50))
    goal = np.asarray(states.data.qpos[:, 16:19]) + [0, 0, 0.05]
    assert states.obs.shape == (50, env.spec.obs) == (50, 16)
    np.testing.assert_allclose(states.obs[:, 13:], goal, atol=1e-6)
    assert (goal.std(0)[:2] > 0.01).all()


@pytest.mark.parametrize("fields", [{"low": (0.0,)}, {"block": (1.0, 2.0, 3.0)}])
@pytest.mark.parametrize("task", [SawyerPush, PandaStack])
def test_wrong_sizes_are_named(task, fields):
    (name,) = fields
    with pytest.raises(ValueError, match=rf"{name}=\[.*must be \w+ numbers"):
        task(**fields)


def _replay(implementation, task, script, decisions):
    """The last states [4] of `script` played natively, and of its actions here."""
    first, actions, states = play(make(task, "native"), script, decisions, 4)
    end = jax.tree.map(lambda a: a[:, -1], states)
    if implementation == "native":
        return end, states
    now, run = jax.tree.map(lambda a: a.reshape(2, 2, *a.shape[1:]), first), program(make(task, "mjx"))
    actions = actions.reshape(2, 2, decisions, -1)
    parts = []
    for t in range(0, decisions, DECISIONS):
        parts.append(run(now, actions[:, :, t : t + DECISIONS]))
        now = jax.tree.map(lambda a: a[:, :, -1], parts[-1])
    path = jax.tree.map(lambda *a: jnp.concatenate(a, 2).reshape(4, decisions, *a[0].shape[3:]), *parts)
    return jax.tree.map(lambda a: a[:, -1], path), path


@pytest.mark.parametrize("implementation", IMPLEMENTATIONS)
def test_a_script_pushes_the_block_home(implementation):
    _, path = _replay(implementation, "sawyer_push", push, 100)
    assert path.metrics["success"].any(1).all()
    height = path.data.qpos[..., 9]
    assert jnp.abs(height - HEIGHT).max() < 2e-3  # the block neither tips nor jumps
    assert jnp.abs(path.data.qvel).max() < 5.0


@pytest.mark.parametrize("implementation", IMPLEMENTATIONS)
def test_a_script_stacks_the_block(implementation):
    end, path = _replay(implementation, "panda_stack", stack, 120)
    assert path.metrics["success"].any(1).all()
    np.testing.assert_array_equal(end.metrics["success"], 1.0)
    assert (path.metrics["grasped"].sum(1) > 20).all()
    moved = path.data.qpos[..., 16:19] - jnp.array([0.45, 0.12, 0.025])[None, None]
    assert jnp.abs(moved).max() < 5e-3  # the base stays
