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
from hybrid_rl.types import Params

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
    controller = AheadController(Seeing(), model, lag, most=3)
    state = controller.init(ENV.spec)._replace(sent=sent)
    x = start = jnp.array([np.cos(2.0), np.sin(2.0), 1.5])
    for u in sent[4 - int(lag) :]:
        x = ENV.dynamics(x, u)
    got = controller.predicted(Params(), state, start)
    np.testing.assert_allclose(got, x, rtol=1e-5, atol=1e-6)
    later = controller.predicted(Params(), state._replace(lag=jnp.float32(0)), start)
    np.testing.assert_array_equal(later, start)  # a lag may change


@pytest.mark.parametrize("model", [Exact(ENV), World(Episode(ENV))])
@pytest.mark.parametrize("delay", [1.5, 2.0])
def test_it_acts_at_what_will_be_observed(model, delay):
    """Two decisions later, from the second on: by the true model that is the truth."""
    episode = Episode(ENV, delay=delay * ENV.spec.dt)
    controller = ahead(Seeing(model), episode.known_lag)
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
    assert ahead(with_model, 0.0) is with_model
    assert ahead(without, 1.0) is without
    assert ahead(with_model, 2.0).most == 2
    assert ahead(ahead(with_model, 2.0), 0.0) is with_model
    assert ahead(ahead(with_model, 2.0), 3.0) == ahead(with_model, 3.0)
    assert ahead(with_model, 0.0, most=4).lag == 0
