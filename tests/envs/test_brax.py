"""Environments with the interface of Brax."""

import re
import textwrap
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.hopper import Hopper


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_brax_wrappers_run():
    from brax.envs import training

    from hybrid_rl.envs.adapters.brax import BraxEnv

    env = training.wrap(BraxEnv(Hopper("native")), episode_length=6, action_repeat=2)
    state = jax.jit(env.reset)(jax.random.split(jax.random.PRNGKey(0), 3))
    first, step = state.obs, jax.jit(env.step)
    ours, own = Hopper("native"), jax.jit(jax.vmap(Hopper("native").step))
    truth = jax.vmap(ours.reset)(jax.random.split(jax.random.PRNGKey(0), 3))
    for t in range(3):
        action = jnp.full((3, 3), 0.1 * t)
        for _ in range(2):
            truth = own(truth, action)
        state = step(state, action)
        if t < 2:
            np.testing.assert_allclose(state.obs, truth.obs, atol=1e-5)
            assert not state.done.any()
    assert state.done.all()
    assert state.info["truncation"].all()
    np.testing.assert_allclose(state.info["episode_metrics"]["length"], 6)
    np.testing.assert_array_equal(state.obs, first)


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_brax_trainers_run_with_the_lines_of_the_docstring(monkeypatch):
    """And not without them: when Brax supports the current JAX, they can be removed."""
    from brax.training.agents.ppo import networks, train
    from brax.training.pmap import bcast_local_devices

    from hybrid_rl.envs.adapters import brax

    with pytest.raises(AttributeError, match="device_put_replicated"):
        bcast_local_devices(0.0)
    lines = re.findall(r"^    jax\.device_put_replicated = .*?^    \)$", brax.__doc__, re.M | re.S)
    monkeypatch.setattr(jax, "device_put_replicated", None, raising=False)  # undone at the end
    exec(textwrap.dedent(lines[0]), {"jax": jax})
    hidden = {"policy_hidden_layer_sizes": (8,), "value_hidden_layer_sizes": (8,)}
    few = partial(networks.make_ppo_networks, **hidden)
    sizes = {"num_timesteps": 64, "episode_length": 8, "num_envs": 4, "batch_size": 4}
    sizes |= {"num_minibatches": 1, "unroll_length": 4, "num_updates_per_batch": 1}
    with jax.numpy_rank_promotion("allow"):
        make, params, _ = train.train(
            brax.BraxEnv(Pendulum()), **sizes, network_factory=few, run_evals=False
        )
        action, _ = make(params, deterministic=True)(jnp.ones(3), jax.random.PRNGKey(0))
    assert action.shape == (1,)
    assert np.isfinite(action).all()
