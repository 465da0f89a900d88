"""Players by hand: a push that brings the block to the target, a pick that stacks it."""

from functools import cache

import jax
import jax.numpy as jnp
from worlds import DECISIONS

from hybrid_rl.envs.panda_stack import BASE, BLOCK, SIDE, TOOL
from hybrid_rl.envs.sawyer_push import TIP


def push(env, state, memory):
    """Go round the block, then through it to the target."""
    tip, block = TIP.pose(state.data.qpos)[0][:2], state.data.qpos[7:9]
    way = state.info["target"] - block
    way = way / jnp.linalg.norm(way)
    side = jnp.stack((-way[1], way[0]))
    along, across = (tip - block) @ way, (tip - block) @ side
    pushing = (along < -0.03) & (jnp.abs(across) < 0.012)
    round_it = jnp.where(across < 0, -0.08, 0.08) * (along > -0.05)
    behind = block - 0.07 * way + round_it * side - tip
    velocity = jnp.where(pushing, 0.1 * way - 3 * across * side, 3 * behind)
    kept = env.smoothing
    action = (velocity - kept * state.info["velocity"]) / ((1 - kept) * env.speed)
    return action / jnp.maximum(1.0, jnp.abs(action).max()), memory


def stack(env, state, memory):
    """Above the block, down, close, up, above the base, down, open, up."""
    phase, waited = memory
    tool, block, base = TOOL.pose(state.data.qpos)[0], state.data.qpos[BLOCK], state.data.qpos[BASE]
    up, goal = jnp.array([0.0, 0.0, 0.1]), base + jnp.array([0.0, 0.0, SIDE])
    lifted = jnp.array([*READY_XY, 0.2])
    raise NotImplementedError
