"""What would a perfect model be worth? A trained policy, planned on the world itself.

    python scripts/true_world.py runs/ant/bc/TIME --horizon 5 --samples 40 --episodes 10

Candidates are drawn from the run's policy at states that the world itself runs through, weighted
by the rewards that it pays (returns over their deviation), and their weighted mean is executed:
`hybrid_bc`'s planner without any error of a model. Episodes are those of `evaluate`.
"""

import argparse
from functools import partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import sampling
from hybrid_rl.evaluate import Trained, load
from hybrid_rl.training.rollout import evaluation_keys
from hybrid_rl.types import EnvState


def outcome(trained: Trained, params: Any, key: Array, arguments: argparse.Namespace) -> Array:
    """Undiscounted return of one episode."""
    controller: Any = trained.controllers["policy"]
    episode, policy = trained.episode, controller.policy
    shape = (arguments.samples, arguments.horizon, episode.spec.act)

    def step(env: EnvState, u: Array) -> EnvState:
        after = episode.step(env, u)
        return jax.tree.map(lambda old, new: jnp.where(env.done, old, new), env, after)

    def candidate(env: EnvState, noise: Array) -> tuple[Array, Array]:
        def forward(env: EnvState, noise: Array) -> tuple[EnvState, tuple[Array, Array]]:
            u, _ = policy.sample(params.policy, env.obs, noise)
            after = step(env, u)
            return after, (u, after.info["return"] - env.info["return"])

        us, rewards = jax.lax.scan(forward, env, noise)[1]
        return us, jnp.cumsum(rewards[::-1])[::-1]

    def decide(carry: tuple[EnvState, Array]) -> tuple[EnvState, Array]:
        env, key = carry
        key, now = jax.random.split(key)
        us, returns = jax.vmap(partial(candidate, env))(jax.random.normal(now, shape))
        w = sampling.weights(returns, arguments.temperature, True, None)
        return step(env, w[:, 0] @ us[:, 0]), key

    start, key = jax.random.split(key)
    begin = (episode.reset(start), key)
    return jax.lax.while_loop(lambda c: ~c[0].done, decide, begin)[0].info["return"]


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description="A trained policy, planned on the world itself")
    parser.add_argument("run", type=Path)
    parser.add_argument("--horizon", type=int, default=5)
    parser.add_argument("--samples", type=int, default=40)
    parser.add_argument("--temperature", type=float, default=1.0)
    parser.add_argument("--episodes", type=int, default=10)
    arguments = parser.parse_args()
    trained = load(arguments.run)
    one = jax.jit(jax.vmap(lambda p, key: outcome(trained, p, key, arguments), in_axes=(None, 0)))
    for i, seed in enumerate(trained.seeds):
        params = jax.tree.map(lambda x, i=i: x[i], trained.params)
        returns = one(params, evaluation_keys(seed, arguments.episodes))
        print(f"seed {seed}: {float(returns.mean()):,.1f}, {sorted(returns.round(0).tolist())}")


if __name__ == "__main__":
    main()
