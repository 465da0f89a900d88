"""What an episode counts, what a learner is paid, and what a run and its evaluation report."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import small

from hybrid_rl.constraints.effort import Effort
from hybrid_rl.constraints.limit import Limit
from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.data.replay import Replay
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.errors import UsageError
from hybrid_rl.run.members import loop_of
from hybrid_rl.run.start import _rewritten
from hybrid_rl.settings import build as config
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import evaluate_episodes, rollout
from hybrid_rl.types import Params

WORLD = Pendulum()
SLOW = Limit(WORLD, "speed", 2.0, norm=True, price=7.0)


@pytest.mark.parametrize("repeat", [1, 2])
def test_violations_are_those_of_the_observations(repeat: int) -> None:
    """A swinging pendulum: decisions with |w'| > 2; the return is that without the constraint."""
    plain = Episode(WORLD, 30, repeat)
    limited, key = Episode(WORLD, 30, repeat, constraint=SLOW), jax.random.key(1)
    resting = ConstantController()
    states = jax.jit(lambda: rollout(limited, resting, Params(), key, 30))()
    free = jax.jit(lambda: rollout(plain, resting, Params(), key, 30))()
    broken = np.abs(states.obs[1:, 2]) > 2
    assert 0 < broken.sum() < 30
    np.testing.assert_array_equal(states.metrics["violation"], [0, *broken])
    np.testing.assert_array_equal(states.clock.violations, np.cumsum([0, *broken]))
    np.testing.assert_array_equal(states.clock.total, free.clock.total)
    np.testing.assert_allclose(states.reward[1:], free.reward[1:] - 7 * broken, rtol=1e-6)
    got = evaluate_episodes(limited, resting, Params(), key[None])
    assert {name: float(each[0]) for name, each in got.items()} == {
        "return": pytest.approx(float(free.clock.total[-1])),
        "violations": broken.sum(),
    }
    assert set(evaluate_episodes(plain, resting, Params(), key[None])) == {"return"}


def test_noise_of_sensors_violates_nothing() -> None:
    """The environment counts by what is, not by what a controller sees."""
    steady = Limit(WORLD, "speed", 8.5, norm=True)
    noisy = Episode(WORLD, 20, sensor_noise=5.0, constraint=steady)
    resting, key = ConstantController(), jax.random.key(0)
    states = jax.jit(lambda: rollout(noisy, resting, Params(), key, 20))()
    assert np.abs(states.obs[:, 2]).max() > 8.5
    assert float(states.clock.violations[-1]) == 0


def test_effort_counts_the_action_that_arrives() -> None:
    """Clipped, and late."""
    late = Episode(WORLD, 20, delay=WORLD.spec.dt, constraint=Effort(0.9))
    state, step, seen = late.reset(jax.random.key(0)), jax.jit(late.step), []
    for u in (5.0, 0.5, -1.0, 0.0):
        state = step(state, jnp.array([u]))
        seen.append(float(state.clock.violations))
    assert seen == [0, 1, 1, 2]


def test_learners_are_paid_less_and_the_return_stays() -> None:
    """In the memory of a run, by the pendulum's own reward of each decision."""
    given = ["task=pendulum", "constraint=speed", "constraint.most=2", "constraint.price=7"]
    built = config.build(small.load("sac", *given))
    loop = loop_of(built.agent, built.seeds, stride=20)
    state = loop.init()
    state, metrics = loop.compile(state)(state, jnp.int32(0), jnp.int32(20))
    rows = state.memory.rows[0, :20, 0]  # of the first learner
    o, m, width = 3, 1, Replay.width(built.agent.spec)
    obs, action, reward, after = rows[:, :o], rows[:, o : o + m], rows[:, o + m], rows[:, -o:]
    assert rows.shape[1] == width
    paid = np.asarray(jax.vmap(WORLD.reward_of)(obs, action, after))
    broken = np.abs(after[:, 2]) > 2
    assert broken.any()
    np.testing.assert_allclose(reward, paid - 7 * broken, rtol=1e-4)
    np.testing.assert_allclose(state.env.clock.total[0, 0], paid.sum(), rtol=1e-4)
    np.testing.assert_array_equal(metrics["world/violation"][:20, 0], broken)
    again = _rewritten(built.agent, state.memory, relabelled=True)  # of a run that begins with it
    np.testing.assert_allclose(again.rows[0, :20, 0, o + m], reward, rtol=1e-4)


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ("constraint=pace", "constraint=pace: unknown; choose one of .*height, limit, pitch, "),
        ("task=van_der_pol constraint=speed", "needs an environment with `quantities`"),
    ],
)
def test_a_constraint_that_does_not_fit_is_refused(given, line) -> None:
    with pytest.raises(UsageError, match=line):
        config.build(config.load(["task=pendulum", *given.split()]))
