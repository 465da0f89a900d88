"""The contact plane against closed forms, MuJoCo C and its own free flight."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import along, jitted, many, shown

from hybrid_rl.envs.analytic.contact_plane import ContactPlane
from hybrid_rl.envs.analytic.point_mass import PointMass

WORLD = ContactPlane()


def at(env, x, pose=None):
    """The state at x [4], with the objects at `pose` [3]."""
    state = jitted(env, "reset")(jax.random.key(0))
    pose = state.data.pose if pose is None else jnp.asarray(pose, jnp.float32)
    x = jnp.asarray(x, jnp.float32)
    return state.replace(data=state.data._replace(x=x, pose=pose), obs=x)


@pytest.mark.parametrize("drag", [0.0, 0.5])
def test_without_contact_it_is_the_point_mass(drag) -> None:
    """Ten steps of a decision are one of the exact integral, and nothing is felt."""
    env, free = ContactPlane(objects=(), drag=drag), PointMass(1.0, drag)
    actions = np.random.default_rng(0).uniform(-1, 1, (30, 2)).astype(np.float32)
    states = along(env, at(env, [0.2, 0.3, 0.5, -0.4]), actions)
    x, dynamics = jnp.array([0.2, 0.3, 0.5, -0.4]), jax.jit(free.dynamics)
    for u, after in zip(actions, states.obs, strict=True):
        x = dynamics(x, jnp.asarray(u))
        np.testing.assert_allclose(after, x, atol=1e-5)
    assert not states.reward.any()


def test_contact_against_mujoco() -> None:
    """A ball that is pushed against a wall and slides along it, by a sphere of MuJoCo C."""
    wall = (0.5, 0.8, 0.0, 0.4, 0.1, 0.001)
    env = ContactPlane(objects=(wall,))
    model = mujoco.MjModel.from_xml_string(
        """<mujoco><option timestep="0.0005" gravity="0 0 0" cone="elliptic"/><worldbody>
        <geom type="box" pos="0.5 0.8 0" size="0.4 0.1 0.2" condim="1"
              solref="0.004 1" solimp="0.99 0.999 0.0001"/>
        <body><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>
        <geom type="sphere" size="0.03" mass="1" condim="1" solref="0.004 1"
              solimp="0.99 0.999 0.0001"/></body></worldbody></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = (0.3, 0.62), (0.2, 0.3)
    actions = np.tile(np.array([[0.4, 0.8]], np.float32), (5, 1))
    states = along(env, at(env, [0.3, 0.62, 0.2, 0.3]), actions)
    for u, after in zip(actions, states.obs, strict=True):
        for _ in range(200):
            data.qfrc_applied[:] = u
            mujoco.mj_step(model, data)
        np.testing.assert_allclose(after[:2], data.qpos, atol=5e-3)
    np.testing.assert_array_equal(states.reward[-3:], 1)


def test_the_sensor_errs_as_often_as_its_rates_say() -> None:
    """Missed contacts at a wall; false ones in free space, in proportion to the action's change."""
    env = ContactPlane(false_contact=0.2, missed=0.1)
    alternating = np.tile([[0.6, 0.8], [-0.6, -0.8]], (400, 1))
    free = ContactPlane(objects=(), false_contact=0.2)
    states = along(free, at(free, [0.5, 0.5, 0, 0]), alternating)
    assert float(states.reward[1:].mean()) == pytest.approx(0.2, abs=0.045)  # three deviations
    still = along(free, at(free, [0.5, 0.5, 0, 0]), np.full((200, 2), 0.5))
    assert not still.reward[1:].any()
    inside = along(env, at(env, [0.25, 0.6, 0, 0]), np.tile([[0.0, 0.3]], (800, 1)))
    touching = np.asarray(inside.metrics["touch"]) == 1
    assert touching[5:].all()
    missed = 1 - np.asarray(inside.reward)[touching].mean()
    assert missed == pytest.approx(0.1, abs=0.035)


def test_resets_draw_a_clear_start_and_a_pose() -> None:
    env = ContactPlane(theta=(0.5, 0.5, 0.0), spread=(0.1, 0.1, 3.1416))
    states = many(env, "reset")(jax.random.split(jax.random.key(0), 200))
    clear = many(env, "distance")(states.obs[:, :2], states.data.pose)
    assert float(clear.min()) > env.radius
    poses = np.asarray(states.data.pose)
    low, high = poses.min(0), poses.max(0)
    assert (np.abs(poses - [0.5, 0.5, 0.0]) <= [0.1, 0.1, 3.1416]).all()
    assert (high - low > [0.18, 0.18, 6]).all()


def test_the_ball_never_enters_an_object() -> None:
    """100 pushes towards the objects, at up to 2 m/s, for two seconds."""
    rng = np.random.default_rng(1)
    s = rng.uniform(0, 1, (1000, 2)).astype(np.float32)
    s = s[np.asarray(many(WORLD, "distance")(s)) > 0.05][:100]
    way = np.array(WORLD.objects)[rng.integers(3, size=100), :2] - s
    u = way / np.linalg.norm(way, axis=1, keepdims=True)
    states = jax.vmap(lambda x: at(WORLD, x))(np.hstack([s, 2 * u]))
    after = jax.vmap(lambda state, u: along(WORLD, state, u))(states, u[:, None].repeat(20, 1))
    apart = jax.vmap(many(WORLD, "distance"))(after.obs[..., :2])
    assert float(apart.min()) > WORLD.radius - 1e-3
    assert after.metrics["touch"].any(1).mean() > 0.9


def test_the_scene_has_a_disc_where_the_distance_says() -> None:
    """A ray of MuJoCo C that comes from above hits an object where the distance is negative."""
    env = ContactPlane(theta=(0.55, 0.45, 0.5))
    state = env.reset(jax.random.key(0))
    data, geom, hits = shown(env, state), np.zeros(1, np.int32), 0
    model, distance = data.model, jitted(env, "distance")
    for s in np.random.default_rng(2).uniform(0.02, 0.98, (300, 2)):
        apart = float(distance(jnp.asarray(s, jnp.float32), state.data.pose))
        if abs(apart) < 0.005 or np.hypot(*(s - np.asarray(state.obs[:2]))) < 0.04:
            continue
        mujoco.mj_ray(model, data, np.array([*s, 1.0]), np.array([0, 0, -1.0]), None, 1, -1, geom)
        body = model.body(model.geom_bodyid[geom[0]]).name if geom[0] >= 0 else ""
        assert (body == "objects") == (apart < 0), s
        hits += apart < 0
    assert hits > 10
