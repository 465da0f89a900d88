"""Episodes of a controller with fixed parameters."""

from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.batching import prepend, repeat, where
from hybrid_rl.protocols import Controller
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import EnvState, Params


def act(
    controller: Controller, params: Params, control: Any, env: EnvState, keys: Array
) -> tuple[Array, Any, dict[str, Array]]:
    """Actions [N, m], controller states and metrics in N worlds `env`, with the same params."""

    def one(control: Any, env: EnvState, key: Array) -> tuple[Array, Any, dict[str, Array]]:
        return controller.act(params._replace(world=env), control, env.obs, key)

    return jax.vmap(one)(control, env, keys)


def begin(episode: Episode, controller: Controller, keys: Array) -> tuple:
    """N episodes before their first decision, one per key: (states, controller states, keys)."""
    starts, keys = _split(keys)
    env = jax.vmap(episode.reset)(starts)
    rest = controller.init(episode.spec)
    return env, repeat(rest, len(keys)), keys


def advance(
    episode: Episode, controller: Controller, params: Params, carry: tuple, rounds: Array
) -> tuple:
    """The `carry` of `begin` after at most `rounds` [] more decisions in each episode.

    All N environments run in parallel; one that is done keeps its last state.
    """

    def unfinished(carry: tuple) -> Array:
        return (carry[0] < rounds) & ~jnp.all(carry[1].done)

    def decide(carry: tuple) -> tuple:
        i, *rest = carry
        return i + 1, *_decided(episode, controller, params, tuple(rest))

    return jax.lax.while_loop(unfinished, decide, (jnp.zeros((), jnp.int32), *carry))[1:]


def _decided(episode: Episode, controller: Controller, params: Params, carry: tuple) -> tuple:
    """The `carry` of `begin` after one more decision in each episode that is not done."""
    env, control, keys = carry
    keys, now = _split(keys)
    u, control, _ = act(controller, params, control, env, now)
    after = jax.vmap(episode.step)(env, u)
    return where(env.done, env, after), control, keys


def scores(env: EnvState) -> dict[str, Array]:
    """Undiscounted `return` of each finished episode and, if there are such, two more.

    `success` is 1 if the last state is a success, else 0. `violations` is the number of decisions
    that violated the constraint.
    """
    success = {"success": env.metrics["success"]} if "success" in env.metrics else {}
    found = {"return": env.clock.total, "violations": env.clock.violations, **success}
    return {name: value for name, value in found.items() if value is not None}


def evaluate_episodes(
    episode: Episode, controller: Controller, params: Params, keys: Array
) -> dict[str, Array]:
    """The `scores` [N] of N whole episodes, one per key."""
    carry = begin(episode, controller, keys)
    return scores(advance(episode, controller, params, carry, jnp.int32(episode.steps))[0])


def rollout(
    episode: Episode, controller: Controller, params: Params, key: Array, steps: int
) -> EnvState:
    """The states [steps+1, ...] of one episode from its reset; the last is repeated once done.

    It is the episode that `evaluate_episodes` makes of the key.
    """

    def decide(carry: tuple, _: None) -> tuple[tuple, EnvState]:
        carry = _decided(episode, controller, params, carry)
        return carry, carry[0]

    carry = begin(episode, controller, key[None])
    _, states = jax.lax.scan(decide, carry, length=steps)
    return jax.tree.map(lambda leaf: leaf[:, 0], prepend(carry[0], states))


def rollout_with_actions(
    episode: Episode, controller: Controller, params: Params, key: Array, steps: int
) -> tuple[Array, EnvState]:
    """The actions [steps, m] of one episode and its states [steps+1, ...]."""
    start, key = jax.random.split(key)
    env = episode.reset(start)

    def decide(carry: tuple, key: Array) -> tuple:
        env, control = carry
        u, control, _ = controller.act(params._replace(world=env), control, env.obs, key)
        after = episode.step(env, u)
        env = where(env.done, env, after)
        return (env, control), (u, env)

    carry = (env, controller.init(episode.spec))
    _, (actions, states) = jax.lax.scan(decide, carry, jax.random.split(key, steps))
    return actions, prepend(env, states)


def evaluation_keys(seed: int, episodes: int) -> Array:
    """The keys [N] of the evaluations of learner `seed`, the same for every evaluation."""
    return jax.random.split(jax.random.fold_in(jax.random.key(seed), 0xE7A1), episodes)


def _split(keys: Array) -> tuple[Array, Array]:
    """Two arrays of keys [N], split from keys [N]."""
    pairs = jax.vmap(jax.random.split)(keys)
    return pairs[:, 0], pairs[:, 1]
