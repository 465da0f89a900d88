"""Another body in each episode, against robots whose body is changed for good."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import yaml
from worlds import along, jitted, make

from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.errors import UsageError
from hybrid_rl.training.episode import Episode

FIXED = {"mass": [1.5, 1.5], "friction": [0.5, 0.5], "motors": [0.8, 0.8], "payload": [0.4, 0.4]}


def states(episode):
    """qpos [20, nq] of an episode by the same actions."""
    actions = jax.random.uniform(jax.random.key(1), (20, episode.spec.act), minval=-1.0)
    return along(episode, jitted(episode, "reset")(jax.random.key(0)), actions).data.qpos


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


def test_a_range_has_two_ends_in_any_order():
    with pytest.raises(ValueError, match=r"randomise.mass=.*: must have 2 entries"):
        Episode(make("cartpole"), randomise={"mass": (2, 1, 3)})
    drawn = [states(Episode(make("cartpole"), randomise={"mass": p})) for p in ((1, 2), (2, 1))]
    np.testing.assert_array_equal(*drawn)


def test_elements_have_their_own_values_whatever_form_they_are_given_in(tmp_path):
    plain = make("halfcheetah", "native")
    ranges = {
        "joint.back_thigh.damping": [7.0, 7.0],
        "joint.front_shin.frictionloss": [0.5, 0.5],
        "body.back_foot.mass": [2.0, 2.0],
        "actuator.back_thigh.gain": [0.5, 0.5],
    }
    (tmp_path / "ranges.yaml").write_text(yaml.safe_dump(ranges))
    file = Episode(plain, randomise={"elements": str(tmp_path / "ranges.yaml")})
    episode = Episode(plain, randomise={"elements": ranges})
    assert hash(episode.randomise) == hash(file.randomise)
    fields, model = episode.reset(jax.random.key(0)).data.fields, plain._body.model
    foot, thigh = model.body("back_foot").id, model.joint("back_thigh").dofadr[0]
    assert fields["dof_damping"][thigh] == 7.0
    assert fields["dof_frictionloss"][model.joint("front_shin").dofadr[0]] == 0.5
    heavier = 2 / model.body_mass[foot] * model.body_inertia[foot]
    np.testing.assert_allclose(fields["body_inertia"][foot], heavier, rtol=1e-6)
    gains = np.array(model.actuator_gainprm[:, 0])
    gains[model.actuator("back_thigh").id] *= 0.5
    np.testing.assert_allclose(fields["actuator_gainprm"][:, 0], gains, rtol=1e-6)
    assert np.abs(states(file) - states(Episode(plain))).max() > 0.01


def test_an_element_that_the_model_lacks_is_refused():
    with pytest.raises(UsageError, match=r"elements: joint.knee.damping: must name an element"):
        Episode(make("cartpole"), randomise={"elements": {"joint.knee.damping": [1, 2]}}).reset(
            jax.random.key(0)
        )
