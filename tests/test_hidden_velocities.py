"""What networks of a study see, and what they remember."""

import jax
import numpy as np

from scripts import hidden_velocities as study

KEY = jax.random.key(0)


def test_a_history_is_seen_as_agents_see_it():
    obs, u = jax.random.normal(KEY, (20, 8)), jax.random.uniform(KEY, (20, 6))
    rates = np.diff(obs, axis=0) / 0.05
    parts = (obs[9], rates[8], u[8], rates[7], u[7])
    np.testing.assert_allclose(study.seen(3, obs, u)[9], np.concatenate(parts), rtol=1e-4)


def test_a_recurrent_network_remembers_what_it_no_longer_sees():
    """The sum of all numbers, of which it sees the newest, in other episodes."""
    x = jax.random.normal(KEY, (2, 64, 10, 1))
    y, errors = np.cumsum(x, 2), []
    for recurrent in (True, False):
        params = study.fitted(study.weights(x[0, 0, 0], 1, recurrent, KEY), x[0], y[0], 400, KEY)
        guess = jax.vmap(lambda x, p=params: study.network(p, study.STILL, x)[1])(x[1])
        errors.append(np.square(guess - y[1]).mean() / y[1].var())
    assert errors[0] < 0.1 < 0.5 < errors[1]
