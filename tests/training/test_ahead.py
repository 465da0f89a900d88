"""A controller that acts where the robot will be when its action acts."""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.models.exact import Exact
from hybrid_rl.models.world import World
from hybrid_rl.training.ahead import AheadController, ahead
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Params, Spec

ENV = Pendulum()
KEY = jax.random.key(0)


@dataclass(frozen=True)
class Seeing:
    """Random actions; its state is the observation at which it acted."""

    model: Exact | World | None = None

    def init(self, spec):
        return jnp.zeros(spec.obs)

    def act(self, params, state, obs, key):
        seen = obs if params.world is None else params.world.obs
        return jax.random.uniform(key, (1,), minval=-1, maxval=1), seen, {}

    def greedy(self):
        return self


@pytest.mark.parametrize("lag", [1.0, 3.0])
def test_the_predicted_state_is_that_of_the_model_rolled_by_hand(lag):
    model, sent = Exact(ENV), jnp.array([[0.7], [-0.5], [0.9], [0.2]])
    controller = AheadController(Seeing(), model, ENV.spec, lag, most=3)
    state = controller.init(ENV.spec)._replace(sent=sent)
    x = start = jnp.array([np.cos(2.0), np.sin(2.0), 1.5])
    for u in sent[4 - int(lag) :]:
        x = ENV.dynamics(x, u)
    got = controller.predicted(Params(), state, start)
    np.testing.assert_allclose(got, x, rtol=1e-5, atol=1e-6)
    later = controller.predicted(Params(), state._replace(lag=jnp.float32(0)), start)
    np.testing.assert_array_equal(later, start)  # a lag may change


@dataclass(frozen=True)
class Summing:
    """o' = o + u sum(s), at planning states (o, sum(s))."""

    def lift(self, params, obs):
        return jnp.stack((obs[0], obs.sum()))

    def step(self, params, x, u):
        return jnp.stack((x[0] + u[0] * x[1], jnp.nan))


def test_a_history_gets_what_is_predicted():
    """s = (o, v, u_before, v_before, u_before that) with decisions of 0.5 s, two of them late."""
    spec = Spec(obs=1, act=1, dt=0.5)
    controller = AheadController(Seeing(), Summing(), spec, lag=2.0, most=2)
    state = controller.init(spec)._replace(sent=jnp.array([[9.0], [2.0], [-1.0]]))
    s = jnp.array([1.0, 2.0, 0.3, 4.0, 0.5])
    first = np.array([1 + 2 * 7.8, 2 * 2 * 7.8, 2.0, 2.0, 0.3])
    then = first[0] - first.sum()
    got = controller.predicted(Params(), state, s)
    np.testing.assert_allclose(got, [then, -2 * first.sum(), -1, first[1], 2], rtol=1e-5)


@pytest.mark.parametrize("model", [Exact(ENV), World(Episode(ENV))])
@pytest.mark.parametrize("delay", [1.5, 2.0])
def test_it_acts_at_what_will_be_observed(model, delay):
    """Two decisions later, from the second on: by the true model that is the truth."""
    episode = Episode(ENV, delay=delay * ENV.spec.dt)
    controller = ahead(Seeing(model), ENV.spec, episode.known_lag)
    state, control, obs, seen = episode.reset(KEY), controller.init(ENV.spec), [], []
    act, step = jax.jit(controller.act), jax.jit(episode.step)
    for key in jax.random.split(KEY, 8):
        obs.append(state.obs)
        params = Params(world=state if isinstance(model, World) else None)
        u, control, _ = act(params, control, state.obs, key)
        seen.append(control.inner)
        state = step(state, u)
    np.testing.assert_allclose(np.array(seen[:-2]), np.array(obs[2:]), rtol=1e-4, atol=1e-4)
    assert np.abs(np.array(seen) - np.array(obs)).max() > 0.1


def test_it_is_around_controllers_with_a_model_where_there_is_a_lag():
    with_model, without = Seeing(Exact(ENV)), Seeing()
    assert ahead(with_model, ENV.spec, 0.0) is with_model
    assert ahead(without, ENV.spec, 1.0) is without
    assert ahead(with_model, ENV.spec, 2.0).most == 2
    assert ahead(ahead(with_model, ENV.spec, 2.0), ENV.spec, 0.0) is with_model
    assert ahead(ahead(with_model, ENV.spec, 2.0), ENV.spec, 3.0) == ahead(
        with_model, ENV.spec, 3.0
    )
    assert ahead(with_model, ENV.spec, 0.0, most=4).lag == 0
