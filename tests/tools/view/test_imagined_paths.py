"""The paths that the live window draws: positions along imagined observations."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.ant import Ant
from hybrid_rl.envs.cartpole import Cartpole
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.mujoco import scenery
from hybrid_rl.envs.sawyer_push import SawyerPush
from hybrid_rl.envs.sawyer_torque import SawyerTorque
from hybrid_rl.envs.sprk import Sprk
from hybrid_rl.tools.view import imagined
from hybrid_rl.training.episode import Episode

pytestmark = pytest.mark.turns(2)


@pytest.mark.parametrize(
    ("env", "fits"),
    [
        (HalfCheetah(), 0.05),
        (Cartpole(), 1e-5),
        (Pendulum(), 1e-5),
        (SawyerTorque(), 1e-5),
        (Sprk(), None),
    ],
)
def test_positions_follow_from_observations(env, fits):
    """Of a true path of 20 decisions; not of a ball seen in another frame."""
    episode = Episode(env)
    read = imagined.reading(episode)
    if fits is None:
        assert read is None
        return

    @jax.jit
    def path(key):
        first, action = episode.reset(key), 0.3 * jnp.ones(env.spec.act)
        _, states = jax.lax.scan(lambda s, _: (episode.step(s, action),) * 2, first, length=20)
        return first, jnp.concatenate([first.obs[None], states.obs]), jax.vmap(env.pose)(states)

    first, obs, poses = path(jax.random.key(3))
    apart = np.asarray(read(first, obs))[1:] - poses
    assert np.abs((apart + np.pi) % (2 * np.pi) - np.pi).max() < fits  # angles may turn round


def test_the_path_of_a_pendulum_is_that_of_its_tip():
    model = scenery.dressed(scenery.scene_of(Pendulum()))
    poses = np.array([[[0.0], [np.pi / 2], [np.pi]]])
    points = imagined.track(model, poses, *imagined.point_of(model))
    (line,) = imagined.lines(model, poses)
    np.testing.assert_array_equal(line, points)
    middle = points[0, [0, 2]].mean(0)
    away = np.linalg.norm(points[0] - middle, axis=1)
    np.testing.assert_allclose(away, away[0], rtol=1e-3)
    assert away[0] == pytest.approx(2 * np.linalg.norm(model.body_ipos[-1]), rel=1e-3)


def test_the_drawn_point_is_of_a_torso_a_pole_or_an_arm():
    models = [scenery.dressed(scenery.scene_of(env)) for env in (Ant(), Cartpole(), SawyerPush())]
    drawn = [model.body(imagined.point_of(model)[0]).name for model in models]
    assert drawn[:2] == ["torso", "pole"]
    assert drawn[2] not in ("block", "target")
