"""Decisions in one world, outside a compiled loop."""

import time
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.training.agent import Agent
from hybrid_rl.types import Params


class Decider:
    """What a controller does in one world, step by step: u = decide(params, obs, decisions).

    It explores if the agent's controller does. at_random: so do its `random_steps`.
    """

    def __init__(self, agent: Agent, seed: int, at_random: bool) -> None:
        """Compile."""
        self.agent, self.at_random = agent, at_random
        key = jax.random.key(seed)
        self.like = jax.eval_shape(lambda: agent.params(agent.init(key)))  # of the parameters
        self._key = jax.random.fold_in(key, int(time.time()))
        self._rest = jax.jit(lambda: agent.controller.init(agent.spec))()
        zeros = jax.tree.map(lambda leaf: np.zeros(leaf.shape, leaf.dtype), self.like)
        first = zeros, self._rest, np.zeros(agent.spec.obs, np.float32), self._key, np.int32(0)
        self._program = jax.jit(self._decided).lower(*first).compile()
        self._program(*first)  # the first call takes longer
        self.begin()

    def begin(self) -> None:
        """An episode begins."""
        self._control = self._rest

    def __call__(self, params: Params | None, obs: np.ndarray, decisions: int) -> np.ndarray:
        """The action [m] at `obs` [o], so many decisions into the run."""
        step = np.int32(decisions)
        u, self._control, self._key = self._program(params, self._control, obs, self._key, step)
        return np.asarray(u)

    def _decided(
        self, params: Params, control: Any, obs: Array, key: Array, step: Array
    ) -> tuple[Array, Any, Array]:
        """Action [m], state of the controller, key."""
        key, drawing, deciding = jax.random.split(key, 3)
        world = self.agent.episode.env.reset(key).replace(obs=obs)
        params = params._replace(decisions=step, world=world)
        u, control, _ = self.agent.controller.act(params, control, obs, deciding)
        at_random = jax.random.uniform(drawing, u.shape, minval=-1, maxval=1)
        random = self.at_random & (step < self.agent.random_steps)
        return jnp.where(random, at_random, u), control, key
