"""The hamster ball in MuJoCo against the contact plane and the free point mass."""

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import along, jitted, many

from hybrid_rl.envs.analytic.contact_plane import ContactPlane
from hybrid_rl.envs.analytic.point_mass import PointMass
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.sprk import TIMESTEP, Sprk

WALL = (0.5, 0.8, 0.0, 0.4, 0.1, 0.01)
DISC = (0.5, 0.8, 0.0, 0.15, 0.15, 0.15)
POSE = (0.55, 0.45, 0.5)


def at(env, x):
    """The state at x [4], with the objects in their reference arrangement."""
    state, x = jitted(env, "reset")(jax.random.key(0)), jnp.asarray(x, jnp.float32)
    return state.replace(data=jitted(env._body, "reset")(x[:2], x[2:]), obs=x)


def test_free_flight_is_the_point_mass_but_for_eulers_steps() -> None:
    """Velocities are off by h b |v| at the most, positions by h |v| and what that adds up to."""
    drag, start = 0.5, np.array([0.2, 0.3, 0.5, -0.4])
    env = Sprk("native", objects=(), drag=drag, lag=0.0)
    free = PointMass(1.0, drag)
    actions = np.random.default_rng(0).uniform(-1, 1, (30, 2)).astype(np.float32)
    states = along(env, at(env, start), actions)
    x, path = jnp.asarray(start, jnp.float32), []
    for u in actions:
        x = free.dynamics(x, jnp.asarray(u))
        path.append(x)
    error = np.abs(np.array(states.obs) - np.array(path)).max(0)
    step = TIMESTEP * float(np.abs(np.array(path)[:, 2:]).max())
    assert (error[2:] < step * drag).all()
    assert (error[:2] < step * (1 + drag * 3.0)).all()  # [s] in all
    assert not states.reward.any()


def test_the_motor_follows_with_a_lag() -> None:
    """From rest, v = a (t - lag (1 - exp(-t / lag))); Euler's sum is off by h a at the most."""
    env = Sprk("native", objects=(), lag=0.05)
    states = along(env, at(env, np.zeros(4)), jnp.ones((3, 2)))
    t = 0.1 * np.arange(1, 4)
    want = t - 0.05 * (1 - np.exp(-t / 0.05))
    np.testing.assert_allclose(states.obs[:, 2], want, atol=TIMESTEP)


@pytest.mark.parametrize("shape", [WALL, DISC], ids=["wall", "disc"])
def test_contacts_are_those_of_the_contact_plane(shape) -> None:
    """Pushed against an object and along it: within 5 mm, and felt from the same decision."""
    fields = {"objects": (shape,), "radius": 0.0365}
    env, plane = Sprk("native", lag=0.0, **fields), ContactPlane(**fields)
    x = [0.45, 0.55, 0.1, 0.3]
    actions = jnp.tile(jnp.array([[0.2, 0.8]]), (8, 1))
    states = along(env, at(env, x), actions)
    start = plane.reset(jax.random.key(0))
    start = start.replace(data=start.data._replace(x=jnp.array(x)), obs=jnp.array(x))
    want = along(plane, start, actions)
    np.testing.assert_allclose(states.obs[:, :2], want.obs[:, :2], atol=5e-3)
    assert states.reward.argmax() == want.reward.argmax() > 0
    np.testing.assert_array_equal(states.reward[-3:], want.reward[-3:])


def test_objects_are_turned_and_the_start_is_that_of_the_contact_plane() -> None:
    """The ball stays outside of turned objects, and starts where the contact plane's does."""
    fields = {"theta": POSE, "spread": (0.1, 0.1, 3.0), "radius": 0.0365}
    env, plane = Sprk("native", **fields), ContactPlane(**fields)
    keys = jax.random.split(jax.random.key(0), 20)
    first, same = (many(world, "reset")(keys) for world in (env, plane))
    np.testing.assert_allclose(first.obs, same.obs, atol=1e-6)
    np.testing.assert_array_equal(first.info["pose"], same.data.pose)
    middle = 0.5 - first.obs[:, :2]
    u = middle / jnp.linalg.norm(middle, axis=1, keepdims=True)
    after = jax.vmap(lambda state, u: along(env, state, u))(first, jnp.repeat(u[:, None], 15, 1))
    pose = after.info["pose"]
    distance = jax.vmap(many(plane, "distance"))(after.obs[..., :2], pose)
    assert float(distance.min()) > env.radius - 3e-3
    touched = np.asarray(after.metrics["touch"]).any(1)
    assert touched.sum() > 5
    assert (np.asarray(distance).min(1)[touched] < env.radius + 5e-3).all()


def test_the_accelerometer_feels_quick_movements_and_misses_weak_contacts() -> None:
    """In free space the mean of a change |du| is a |du| lag / h (1 - exp(-h / lag)), h = 1/30 s."""
    env = Sprk("native", objects=(WALL,), sensor="accelerometer", lag=0.02, threshold=0.5)
    share = 0.02 * 30 * (1 - np.exp(-1 / (30 * 0.02)))
    changes = np.array([0.9, 1.1]) * env.threshold / share
    for change, felt in zip(changes, (0, 1), strict=True):
        actions = jnp.array([[-change / 2, 0.0], [change / 2, 0.0]] * 3)
        states = along(env, at(env, [0.5, 0.2, 0, 0]), actions)
        np.testing.assert_array_equal(states.reward[1:], felt)
        assert not states.metrics["touch"].any()
    for push, felt in ((0.3, 0), (0.7, 1)):
        states = along(env, at(env, [0.5, 0.65, 0, 0]), jnp.tile(jnp.array([[0, push]]), (20, 1)))
        np.testing.assert_array_equal(states.metrics["touch"][-5:], 1)
        np.testing.assert_array_equal(states.reward[-5:], felt)


def test_mujoco_measures_the_distance_to_rounded_boxes() -> None:
    """Distance of the ball to MuJoCo's geoms, outside of them."""
    env, s = Sprk("native"), np.random.default_rng(0).uniform(0, 1, (40, 2))
    model = mjcf.load(env.asset)
    data, ball = mujoco.MjData(model), model.geom("ball").id
    parts = [i for i in range(model.ngeom) if model.geom(i).name.startswith("object")]
    assert len(parts) == model.npair == 13
    for data.qpos[:], want in zip(s, many(env, "distance")(jnp.asarray(s)), strict=True):
        mujoco.mj_kinematics(model, data)
        got = min(mujoco.mj_geomDistance(model, data, ball, i, 9.0, None) for i in parts)
        if want > env.radius:
            assert got + env.radius == pytest.approx(float(want), abs=1e-5)
