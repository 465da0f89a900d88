"""Players by hand: experts that push and stack, in our worlds with their defaults."""

from functools import cache

import jax

from hybrid_rl.envs.experts.push import PushController
from hybrid_rl.envs.experts.stack import StackController
from hybrid_rl.types import Params

EXPERTS = {"sawyer_push": PushController(), "panda_stack": StackController(grip="action")}


@cache
def play(env, expert, decisions, worlds):
    """The first states [worlds], and actions and states [worlds, decisions] of `expert`."""

    def run(state):
        def one(carry, _):
            state, memory = carry
            action, memory, _ = expert.act(Params(), memory, state.obs, jax.random.key(0))
            state = env.step(state, action)
            return (state, memory), (action, state)

        return jax.lax.scan(one, (state, expert.init(env.spec)), None, decisions)[1]

    first = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(1), worlds))
    return first, *jax.jit(jax.vmap(run))(first)
