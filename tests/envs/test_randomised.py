"""Another body in each episode, against robots whose body is changed for good."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import call, call_train
from worlds import make

from hybrid_rl import evaluate
from hybrid_rl.cli import command
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.cartpole import Cartpole
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.training.episode import Episode

FIXED = {"mass": [1.5, 1.5], "friction": [0.5, 0.5], "motors": [0.8, 0.8], "payload": [0.4, 0.4]}


def states(episode, count=20):
    """qpos [count, nq] of an episode by the same actions."""

    def step(state, action):
        state = episode.step(state, action)
        return state, state.data.qpos

    actions = jax.random.uniform(jax.random.key(1), (count, episode.spec.act), minval=-1.0)
    first = jax.jit(episode.reset)(jax.random.key(0))
    return jax.jit(lambda state: jax.lax.scan(step, state, actions))(first)[1]


def test_ranges_of_one_value_are_the_body_with_that_value():
    plain = make("halfcheetah", "native")
    drawn = states(Episode(plain, randomise=FIXED))
    changed = HalfCheetah("native", **{name: pair[0] for name, pair in FIXED.items()})
    np.testing.assert_allclose(drawn, states(Episode(changed)), rtol=1e-3, atol=1e-3)
    assert np.abs(drawn - states(Episode(plain))).max() > 0.05


def test_each_episode_and_each_motor_has_its_own_and_keeps_it():
    plain = make("halfcheetah", "native")
    names = ("mass", "motors", "damping")
    episode = Episode(plain, randomise=dict.fromkeys(names, (0.5, 2.0)))
    first = jax.jit(jax.vmap(episode.reset))(jax.random.split(jax.random.key(0), 64))
    model, fields = plain._body.model, jax.tree.map(np.asarray, first.data.fields)
    mass = fields["body_mass"][:, 1:] / model.body_mass[1:]
    np.testing.assert_allclose(mass, np.broadcast_to(mass[:, :1], mass.shape), rtol=1e-5)
    motors = fields["actuator_gainprm"][:, :, 0] / model.actuator_gainprm[:, 0]
    damping = fields["dof_damping"][:, 3] / model.dof_damping[3]
    for factor in (mass[:, 0], *motors.T, damping):
        assert 0.5 <= factor.min() < 0.6
        assert 1.85 < factor.max() <= 2.0
    assert np.abs(np.corrcoef([mass[:, 0], *motors.T, damping]) - np.eye(8)).max() < 0.5
    after = jax.jit(jax.vmap(episode.step))(first, jnp.zeros((64, 6)))
    for name, value in fields.items():
        np.testing.assert_array_equal(after.data.fields[name], value)


def test_what_is_not_drawn_stays_that_of_the_model_and_the_start_is_the_same():
    plain = Cartpole("native")
    state = Episode(plain, randomise={"mass": (0.5, 2.0), "motors": None}).reset(jax.random.key(3))
    assert {*state.data.fields} == {"body_mass", "body_inertia"}
    np.testing.assert_array_equal(state.obs, Episode(plain).reset(jax.random.key(3)).obs)
    assert not Episode(plain, randomise={"mass": None}).reset(jax.random.key(3)).data.fields


@pytest.mark.parametrize(
    ("env", "given", "line"),
    [
        (
            Cartpole("native"),
            {"mass": (2, 1)},
            "randomise.mass=[2.0, 1.0]: must be [low, high], or",
        ),
        (Cartpole("native"), {"mass": 2}, "randomise.mass=2: must be a list, or null"),
        (Cartpole("native"), {"mass": (0, 1)}, "randomise.mass=[0, 1]: must be above 0, or null"),
        (Pendulum(), {"mass": (1, 2)}, "only robots in MuJoCo have other bodies"),
    ],
)
def test_ranges_that_cannot_be_drawn_are_refused(env, given, line):
    with pytest.raises(ValueError, match="randomise") as error:
        Episode(env, randomise=given)
    assert line in str(error.value)


def test_commands_train_and_evaluate_with_drawn_bodies(tmp_path, capfd):
    folder = tmp_path / "run"
    words = ["task=cartpole", "algo=sac", "settings=light", "total_steps=20", "random_steps=20"]
    words += ["episode.steps=10", "eval_every=20"]
    drawn = "episode.randomise.mass=[0.5,2]"
    assert call_train(*words, drawn, f"run_dir={folder}") == 0
    run = partial(command.run, evaluate.main)
    wider = "episode.randomise.friction=[0.1,3]"
    assert call(run, f"run={folder}", "episodes=2", wider) == 0
    assert [*folder.glob("evaluation_*randomise.friction*.json")]
    capfd.readouterr()
    typo = "episode.randomise.masss=[1,2]"
    assert call(run, f"run={folder}", typo) == 2
    assert "episode.randomise: " in (line := capfd.readouterr().err)
    assert "'masss'" in line
