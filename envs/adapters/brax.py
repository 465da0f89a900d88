"""A world of ours as a Brax environment, so that Brax's wrappers run on it.

    pipeline_state = (data, info),   done = 1.0 where terminated

Brax keeps the clock, resets by putting the first `pipeline_state` and `obs` back, and writes
into `info`; what our world remembers must come back with a reset, so it travels in
`pipeline_state`. Keys are of the old kind, `jax.random.PRNGKey`: Brax reads their shape.

Brax's trainers (PPO, SAC, APG of Brax 0.14.2) call a function that JAX 0.10 removed. They run
on our worlds once a script gives it back, before training:

    jax.device_put_replicated = lambda tree, devices: jax.tree.map(
        lambda x: jax.numpy.stack([x] * len(devices)), tree
    )

Source: Brax's documentation, `brax.envs.base.Env`, `brax.envs.wrappers.training`.
"""

from typing import Any

import jax
import jax.numpy as jnp
from brax.envs.base import Env as BraxEnv
from brax.envs.base import State
from jax import Array

from hybrid_rl.types import Env, EnvState


class World(BraxEnv):
    """`env`, as Brax sees it."""

    def __init__(self, env: Env) -> None:
        self.env = env

    def reset(self, rng: Array) -> State:
        """First state of an episode, from a key of the old kind [2].

        Raises:
            TypeError: for a key of the new kind, which Brax's wrappers cannot batch.
        """
        if jnp.issubdtype(rng.dtype, jax.dtypes.prng_key):
            raise TypeError("Brax takes keys of jax.random.PRNGKey, not of jax.random.key")
        now: Any = self.env.reset(rng)
        done = jnp.float32(0.0)
        kept: Any = (now.data, now.info)
        return State(kept, now.obs, now.reward, done, dict(now.metrics), {})

    def step(self, state: Any, action: Array) -> State:
        """The state after one decision."""
        data, info = state.pipeline_state
        no = jnp.zeros((), bool)
        before = EnvState(
            data, state.obs, state.reward, state.done.astype(bool), no, state.metrics, info
        )
        now = self.env.step(before, action)
        return state.replace(
            pipeline_state=(now.data, now.info),
            obs=now.obs,
            reward=now.reward,
            done=now.terminated.astype(jnp.float32),
            metrics={**state.metrics, **now.metrics},
        )

    @property
    def observation_size(self) -> int:
        """Size o of an observation."""
        return self.env.spec.obs

    @property
    def action_size(self) -> int:
        """Size m of an action."""
        return self.env.spec.act

    @property
    def backend(self) -> str:
        """Name of the physics; Brax only shows it."""
        return "hybrid_rl"

    @property
    def dt(self) -> float:
        """Time between two decisions [s]."""
        return self.env.spec.dt
