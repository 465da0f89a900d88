"""Episodes under a controller whose parameters stay as they are."""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols import Controller
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import EnvState, Params


def begin(episode: Episode, controller: Controller, keys: Array) -> tuple:
    """One episode per key [N] before its first decision: (states, controller states, keys)."""
    starts, keys = _split(keys)
    env = jax.vmap(episode.reset)(starts)
    rest = controller.init(episode.spec)
    control = jax.tree.map(lambda x: jnp.broadcast_to(x, (len(keys), *x.shape)), rest)
    return env, control, keys


def advance(
    episode: Episode, controller: Controller, params: Params, carry: tuple, rounds: Array
) -> tuple:
    """`carry` of `begin` after at most `rounds` [] more decisions in each episode.

    All N worlds run side by side; one that is done stands still.
    """
    act = jax.vmap(controller.act, in_axes=(None, 0, 0, 0))

    def going(carry: tuple) -> Array:
        return (carry[0] < rounds) & ~jnp.all(carry[1].done)

    def decide(carry: tuple) -> tuple:
        i, env, control, keys = carry
        keys, now = _split(keys)
        u, control, _ = act(params, control, env.obs, now)
        after = jax.vmap(episode.step)(env, u)
        frozen = jax.tree.map(
            lambda old, new: jnp.where(
                env.done.reshape(env.done.shape + (1,) * (new.ndim - 1)), old, new
            ),
            env,
            after,
        )
        return i + 1, frozen, control, keys

    return jax.lax.while_loop(going, decide, (jnp.zeros((), jnp.int32), *carry))[1:]


def scores(env: EnvState) -> dict[str, Array]:
    """Undiscounted `return` of each finished episode, and where the task has it `success`.

    Success is 1 where the last state counts as one, else 0.
    """
    success = {"success": env.metrics["success"]} if "success" in env.metrics else {}
    return {"return": env.info["return"], **success}


def evaluate_episodes(
    episode: Episode, controller: Controller, params: Params, keys: Array
) -> dict[str, Array]:
    """The `scores` [N] of one whole episode per key [N]."""
    carry = begin(episode, controller, keys)
    return scores(advance(episode, controller, params, carry, jnp.int32(episode.steps))[0])


def rollout(
    episode: Episode, controller: Controller, params: Params, key: Array, steps: int
) -> EnvState:
    """The states [steps+1, ...] of one episode, from its reset; it stands still once done."""
    return rollout_with_actions(episode, controller, params, key, steps)[1]


def rollout_with_actions(
    episode: Episode, controller: Controller, params: Params, key: Array, steps: int
) -> tuple[Array, EnvState]:
    """The actions [steps, m] of one episode and its states [steps+1, ...]."""
    start, key = jax.random.split(key)
    env = episode.reset(start)

    def decide(carry: tuple, key: Array) -> tuple:
        env, control = carry
        u, control, _ = controller.act(params, control, env.obs, key)
        after = episode.step(env, u)
        env = jax.tree.map(lambda old, new: jnp.where(env.done, old, new), env, after)
        return (env, control), (u, env)

    carry = (env, controller.init(episode.spec))
    _, (actions, states) = jax.lax.scan(decide, carry, jax.random.split(key, steps))
    join = jax.tree.map(lambda first, rest: jnp.concatenate([first[None], rest]), env, states)
    return actions, join


def evaluation_keys(seed: int, episodes: int) -> Array:
    """Keys [N] of the evaluation of learner `seed`: the same at every evaluation."""
    return jax.random.split(jax.random.fold_in(jax.random.key(seed), 0xE7A1), episodes)


def _split(keys: Array) -> tuple[Array, Array]:
    """Two keys [N] from each of keys [N]."""
    pairs = jax.vmap(jax.random.split)(keys)
    return pairs[:, 0], pairs[:, 1]
