"""Players by hand: a push that brings the block to the target, a pick that stacks it."""

from functools import cache

import jax
import jax.numpy as jnp

from hybrid_rl.envs.panda_stack import BASE, BLOCK, DT, SIDE, TOOL
from hybrid_rl.envs.sawyer_push import TIP


def push(env, state, memory):
    """Go round the block, then through it to the target. memory: none."""
    tip, block = TIP.pose(state.data.qpos)[0][:2], state.data.qpos[7:9]
    way = state.info["target"] - block
    way = way / jnp.linalg.norm(way)
    side = jnp.stack((-way[1], way[0]))
    along, across = (tip - block) @ way, (tip - block) @ side
    pushing = (along < -0.03) & (jnp.abs(across) < 0.02)
    around = jnp.where(across < 0, -0.08, 0.08) * (along > -0.05)
    behind = 3 * (block - 0.07 * way + around * side - tip)
    velocity = jnp.where(pushing, 0.1 * way - 5 * across * side, behind)
    velocity *= jnp.minimum(1.0, env.speed / jnp.linalg.norm(velocity))
    kept = env.smoothing
    action = (velocity - kept * state.info["velocity"]) / ((1 - kept) * env.speed)
    return jnp.clip(action, -1.0, 1.0), memory


def stack(env, state, memory):
    """Above the block, down, close, up, above the base, down, open, up. memory: phase, waited."""
    phase, waited = memory
    tool, block, base = TOOL.pose(state.data.qpos)[0], state.data.qpos[BLOCK], state.data.qpos[BASE]
    up, goal = jnp.array([0.0, 0.0, 0.1]), base + jnp.array([0.0, 0.0, SIDE])
    high = tool.at[2].set(0.15)
    goals = jnp.stack([block + up, block, tool, high, goal + up, goal, tool, goal + up])
    error = goals[phase] - tool
    still = (phase == 2) | (phase == 6)
    done = jnp.where(still, waited >= 6, jnp.linalg.norm(error) < 0.006)
    memory = jnp.where(done, jnp.minimum(phase + 1, 7), phase), jnp.where(done, 0, waited + 1)
    kept = jnp.exp(-DT / env.lag)
    velocity = jnp.clip(3 * error, -env.speed, env.speed)
    action = (velocity - kept * state.info["velocity"]) / ((1 - kept) * env.speed)
    grip = jnp.where((phase >= 2) & (phase <= 5), 1.0, -1.0)
    return jnp.concatenate([jnp.clip(action, -1.0, 1.0), grip[None]]), memory


START = {push: (), stack: (0, 0)}


@cache
def play(env, script, decisions, worlds):
    """The first states [worlds], and actions and states [worlds, decisions] of `script`."""

    def run(state):
        def one(carry, _):
            state, memory = carry
            action, memory = script(env, state, memory)
            state = env.step(state, action)
            return (state, memory), (action, state)

        return jax.lax.scan(one, (state, START[script]), None, decisions)[1]

    first = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(1), worlds))
    return first, *jax.jit(jax.vmap(run))(first)
