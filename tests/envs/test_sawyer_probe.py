"""Sawyer's probing against the free point mass, MuJoCo's geometry and its own limits."""

from functools import partial

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import pytest
from worlds import along, jitted, many

from hybrid_rl.envs.analytic.contact_plane import ContactPlane
from hybrid_rl.envs.analytic.point_mass import PointMass
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.kinematics import rotate
from hybrid_rl.envs.sawyer_probe import HOME, TIP, SawyerProbe

POSE = (0.55, 0.02, 0.4)
WORLD = SawyerProbe("native", theta=POSE)
PLANE = ContactPlane(
    objects=WORLD.objects, low=WORLD.low, high=WORLD.high, theta=POSE, radius=WORLD.radius
)
TRIALS = 4


@pytest.fixture(scope="module")
def paths():
    """The first states [TRIALS], actions [TRIALS, 30, 2] to and fro, and the states after them."""
    first = many(WORLD, "reset")(jax.random.split(jax.random.key(3), TRIALS))
    to_middle = np.array([0.55, 0.0]) - np.asarray(first.obs[:, :2])
    to_middle /= np.linalg.norm(to_middle, axis=1, keepdims=True)
    to_and_fro = np.repeat([1.0, -1.0], 15)
    actions = jnp.asarray(to_middle[:, None] * to_and_fro[:, None], jnp.float32)
    states = jax.vmap(lambda state, u: along(WORLD, state, u))(first, actions)
    return first, actions, states


def test_it_starts_where_the_contact_plane_does(paths) -> None:
    """By inverse kinematics, within 0.5 mm."""
    want = many(PLANE, "reset")(jax.random.split(jax.random.key(3), TRIALS))
    np.testing.assert_allclose(paths[0].obs, want.obs, atol=5e-4)


def test_the_tip_moves_as_the_free_point_mass_until_it_touches(paths) -> None:
    """Each decision within 2 mm and 2 cm/s of the exact integral, while the rod is held upright."""
    first, actions, states = paths
    free = PointMass(WORLD.acceleration, WORLD.drag)
    before = jnp.concatenate([first.obs[:, None], states.obs[:, :-1]], 1)
    want = jax.vmap(many(free, "dynamics"))(before, actions)
    p = np.asarray(states.obs[..., :2])
    inside = ((p > WORLD.low) & (p < WORLD.high)).all(-1)
    apart = inside & (np.cumsum(np.asarray(states.reward), 1) == 0)
    assert apart.sum() > 20
    error = np.abs(np.asarray(states.obs - want))[apart]
    assert (error.max(0) < [2e-3, 2e-3, 2e-2, 2e-2]).all()
    tip, rotation, _ = jax.vmap(many(TIP, "pose"))(states.data.qpos)
    assert np.ptp(np.asarray(tip[..., 2])) < 5e-3
    down = jax.jit(jax.vmap(rotate, (0, None)))(rotation[apart], jnp.array([0.0, 0.0, 1.0]))
    assert float(down[:, 2].max()) < -np.cos(0.02)  # [rad]


def test_what_it_feels_is_a_rod_at_an_object(paths) -> None:
    """The rod stays within 2 mm of what it presses, and the command leads by `lead` at most."""
    _, _, states = paths
    distance = jax.jit(jax.vmap(jax.vmap(partial(PLANE.distance, pose=jnp.array(POSE)))))
    gap = np.asarray(distance(states.obs[..., :2])) - WORLD.radius
    assert gap.min() > -2e-3
    felt = np.asarray(states.reward) == 1
    assert felt.any(1).sum() >= 2
    pressing = felt[:, :-2] & felt[:, 1:-1] & felt[:, 2:]
    assert pressing.any()
    assert np.abs(gap[:, 1:-1][pressing]).max() < 2e-3
    assert not felt[gap > 0.03].any()
    lead = np.linalg.norm(states.info["command"][..., :2] - states.obs[..., :2], axis=-1)
    assert lead.max() < WORLD.lead + 0.005  # the tip moved since the last command
    pressed = felt[:, 14]  # before it turns back
    assert pressed.any()
    assert not felt[pressed, 20].any()


def test_the_objects_of_the_model_are_those_of_the_distance() -> None:
    """Distance of MuJoCo between the rod, held upright, and the objects at theta."""
    model = mjcf.load(WORLD.asset)
    data = mujoco.MjData(model)
    parts = [i for i in range(model.ngeom) if model.geom(i).name.startswith("object")]
    reached = jax.jit(lambda p: WORLD._reached(p, jnp.array(HOME)))
    distance = jitted(WORLD, "distance")
    for s in np.random.default_rng(0).uniform(WORLD.low, WORLD.high, (10, 2)):
        data.qpos[:] = reached(jnp.asarray(s, jnp.float32))
        mujoco.mj_kinematics(model, data)
        rod = model.geom("rod").id
        got = min(mujoco.mj_geomDistance(model, data, rod, i, 9.0, None) for i in parts)
        want = float(distance(jnp.asarray(s, jnp.float32), jnp.array(POSE))) - WORLD.radius
        if want > 0:
            assert got == pytest.approx(want, abs=5e-4)
