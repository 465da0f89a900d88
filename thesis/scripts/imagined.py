"""Does a learned model imagine what happens? Its future beside the world's, from the same states.

    python thesis/scripts/imagined.py runs/walker2d/hybrid_stochastic/TIME --after 20 100 300

The policy of a run's first seed acts, with its noise, in many worlds. From the states that they
reach after so many decisions it goes on in the world, and in the model with its reward. Compared
are the share of episodes that end, and the mean reward of those that go on: a model that imagines
falls makes a policy too careful, one that imagines too much reward deceives it.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

import jax
import numpy as np
from jax import Array

from hybrid_rl.errors import CheckpointError, UsageError
from hybrid_rl.run.saved import load

COUNTS = (5, 10, 25)  # decisions ahead


def futures(run: Path, afters: Sequence[int], worlds: int) -> dict[int, dict[str, Any]]:
    """For each of `afters` {world, model}: ended, the share of episodes, and reward, after COUNTS.

    Raises:
        UsageError: unless the policy of the run learns from a model, and episodes last so long.
    """
    trained: Any = load(run)
    learner = trained.agent.learners.get("policy")
    if not hasattr(learner, "reward"):
        raise UsageError(f"{run}: its policy learns without a model; choose algo=hybrid_stochastic")
    policy, model, reward, episode = learner.policy, learner.model, learner.reward, trained.episode
    params: Any = jax.tree.map(lambda leaf: leaf[0], trained.params)

    def decided(x: Array, key: Array) -> Array:
        noise = jax.random.normal(key, (len(x), episode.spec.act))
        return policy.sample(params.policy, x, noise)[0]

    def in_world(state: Any, key: Array) -> tuple:
        state = jax.vmap(episode.step)(state, decided(state.obs, key))
        return state, (state.terminated, state.reward)

    def in_model(x: Array, key: Array) -> tuple:
        acting, moving, choosing = jax.random.split(key, 3)
        u = decided(x, acting)
        next_x = model.draw(params.model, x, u, jax.random.normal(moving, x.shape), choosing)
        outcome = jax.vmap(reward.outcome, (None, 0, 0, 0))
        rewards, ends = outcome(params, x, u, next_x)
        return next_x, (ends > 0, rewards)

    @partial(jax.jit, static_argnums=0)
    def run_from(after: int, key: Array) -> tuple:
        starting, first, second, third = jax.random.split(key, 4)
        state = jax.vmap(episode.reset)(jax.random.split(starting, worlds))
        state, (ended, _) = jax.lax.scan(in_world, state, jax.random.split(first, after))
        going = jax.random.split(second, COUNTS[-1])
        world = jax.lax.scan(in_world, state, going)[1]
        imagined = jax.lax.scan(in_model, state.obs, jax.random.split(third, COUNTS[-1]))[1]
        return ~ended.any(0), world, imagined

    rows = {}
    for after in afters:
        alive, *both = jax.tree.map(np.asarray, run_from(after, jax.random.key(0)))
        if not alive.any():
            raise UsageError(f"--after {after}: every episode has ended by then")
        rows[after] = {
            name: measured(ended[:, alive], rewards[:, alive])
            for name, (ended, rewards) in zip(("world", "model"), both, strict=True)
        }
    return rows


def measured(ended: np.ndarray, rewards: np.ndarray) -> dict[str, list[float]]:
    """The measures of [T, N] episodes that end, and their rewards."""
    over = np.logical_or.accumulate(ended)
    before = np.concatenate([np.zeros_like(over[:1]), over[:-1]])  # ended earlier
    return {
        "ended": [float(over[n - 1].mean()) for n in COUNTS],
        "reward": [float(rewards[:n][~before[:n]].mean()) for n in COUNTS],
    }


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description="Futures in the learned model and in the world")
    parser.add_argument("run", type=Path)
    parser.add_argument("--after", type=int, nargs="+", default=[20, 100, 300], help="decisions")
    parser.add_argument("--worlds", type=int, default=256)
    parser.add_argument("--out", type=Path, help="JSON with the numbers")
    arguments = parser.parse_args()
    try:
        rows = futures(arguments.run, arguments.after, arguments.worlds)
    except (UsageError, CheckpointError) as error:
        print(error, file=sys.stderr)
        return 1
    for after, row in rows.items():
        print(f"after {after} decisions, within {', '.join(map(str, COUNTS))} more:")
        for name, one in row.items():
            ended = ", ".join(f"{100 * share:.1f}%" for share in one["ended"])
            reward = ", ".join(f"{each:.2f}" for each in one["reward"])
            print(f"  {name}: {ended} end; reward {reward} per decision")
    if arguments.out:
        arguments.out.write_text(json.dumps({"within": COUNTS, "after": rows}, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
