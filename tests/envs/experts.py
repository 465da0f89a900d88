"""Episodes of the hand-written experts."""

from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from worlds import IMPLEMENTATIONS, jitted, step_grid

from hybrid_rl.envs.experts.push import PushController
from hybrid_rl.envs.experts.stack import StackController
from hybrid_rl.types import Params

EXPERTS = {"sawyer_push": PushController(), "panda_stack": StackController(grip="action")}


def over_implementations(task):
    """Ids as of the other tests of the task: MJX only with `--slow`."""
    ids = [f"{task}-{implementation}" for implementation in IMPLEMENTATIONS]
    return pytest.mark.parametrize("implementation", IMPLEMENTATIONS, ids=ids)


@cache
def play(env, expert, decisions):
    """Actions [4, decisions, m] and states [4, decisions] of `expert` in four episodes.

    Stepped by the program that the other tests of `env` compiled.
    """
    keys = jax.random.split(jax.random.key(1), 4).reshape(2, 2)
    state = jax.vmap(jax.vmap(jitted(env, "reset")))(keys)
    memory = jax.tree.map(lambda a: jnp.tile(a, (2, 2, 1)), expert.init(env.spec))

    @jax.jit
    @jax.vmap
    @jax.vmap
    def act(memory, obs):
        return expert.act(Params(), memory, obs, jax.random.key(0))[:2]

    path = []
    for _ in range(decisions):
        action, memory = act(memory, state.obs)
        state = step_grid(env)(state, action)
        path.append((action, state))
    stacked = jax.tree.map(lambda *leaves: np.stack(leaves, 2), *path)
    return jax.tree.map(lambda a: a.reshape(4, *a.shape[2:]), stacked)
