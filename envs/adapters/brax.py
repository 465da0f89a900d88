"""An environment of this library as a Brax environment, for Brax's wrappers.

    pipeline_state = (data, info),   done = 1.0 if terminated

Brax counts the steps of an episode, resets by restoring the first `pipeline_state` and `obs`, and
writes into `info`. A reset must restore the environment's own `info` too, so it is part of
`pipeline_state`. Keys are those of `jax.random.PRNGKey`, since Brax reads their shape.

Brax's trainers (PPO, SAC, APG of Brax 0.14.2) call a function that JAX 0.10 removed. They work
after a script restores it, before training:

    jax.device_put_replicated = lambda tree, devices: jax.tree.map(
        lambda x: jax.numpy.stack([x] * len(devices)), tree
    )

Source: Brax's documentation, `brax.envs.base.Env`, `brax.envs.wrappers.training`.
"""

from typing import Any

import jax.numpy as jnp
from brax.envs import base
from jax import Array

from hybrid_rl.protocols import Env
from hybrid_rl.types import EnvState, PyTree


class BraxEnv(base.Env):
    """`env` with the interface of Brax."""

    def __init__(self, env: Env) -> None:
        self.env = env

    def reset(self, rng: Array) -> base.State:
        """A random initial state; rng: a key [2] of `jax.random.PRNGKey`."""
        first = self.env.reset(rng)
        pipeline_state: PyTree = first.data, first.info
        done = jnp.float32(0.0)
        return base.State(pipeline_state, first.obs, first.reward, done, dict(first.metrics), {})

    def step(self, state: Any, action: Array) -> base.State:
        """The state after one decision."""
        data, info = state.pipeline_state
        ended, metrics = state.done.astype(bool), state.metrics
        before = EnvState(data, state.obs, state.reward, ended, metrics=metrics, info=info)
        after = self.env.step(before, action)
        return state.replace(
            pipeline_state=(after.data, after.info),
            obs=after.obs,
            reward=after.reward,
            done=after.terminated.astype(jnp.float32),
            metrics={**state.metrics, **after.metrics},
        )

    @property
    def observation_size(self) -> int:
        """Size of an observation."""
        return self.env.spec.obs

    @property
    def action_size(self) -> int:
        """Size of an action."""
        return self.env.spec.act

    @property
    def backend(self) -> str:
        """Name of the physics, which Brax only displays."""
        return "hybrid_rl"

    @property
    def dt(self) -> float:
        """Time between two decisions [s]."""
        return self.env.spec.dt
