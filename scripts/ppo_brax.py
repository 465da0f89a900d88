"""Brax's own PPO on an environment of this library, with the settings of algo=ppo.

    python -m scripts.ppo_brax task=halfcheetah physics=mjx total_steps=20000000 out=ppo_brax.json

All words but out, evals and reward_scale are overrides of `python -m hybrid_rl.train algo=ppo`. Of
these the sizes, rates and weights are Brax's, too. algo=ppo divides rewards by a running scale of
the returns, Brax multiplies them by reward_scale. Evaluations have `eval_episodes` deterministic
episodes. Seeds are trained one after another; the seconds `s` of a row are those of its seed, and
what the command needs before the first.
"""

import json
import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from time import monotonic
from typing import Any

import jax
import jax.numpy as jnp
from brax.envs import base
from brax.training.agents.ppo import networks, train
from flax import linen
from jax import Array

from hybrid_rl.envs.adapters.brax import BraxEnv
from hybrid_rl.files.atomic import write_text
from hybrid_rl.run.machine.provenance import device, versions
from hybrid_rl.settings.build import Run, build, load
from hybrid_rl.training.episode import EXACT
from hybrid_rl.version import BEGAN
from scripts.compare_peers import Row, clock, returns

OWN = {"out": "ppo_brax.json", "evals": "20", "reward_scale": "1"}


class Exact(BraxEnv):
    """An environment in full precision, whatever that of the networks is."""

    def reset(self, rng: Array) -> base.State:
        """A random initial state."""
        with EXACT():
            return super().reset(rng)

    def step(self, state: Any, action: Array) -> base.State:
        """The state after one decision."""
        with EXACT():
            return super().step(state, action)


def settings(run: Run, evals: int, reward_scale: float) -> dict[str, Any]:
    """The arguments of Brax's `train` that are the settings of a run."""
    learner: Any = run.agent.learners["policy"]
    config, episode = run.config, run.agent.episode
    sizes = {
        "policy_hidden_layer_sizes": learner.policy.hidden,
        "value_hidden_layer_sizes": learner.hidden,
        "activation": getattr(linen, learner.activation),
    }
    return {
        "num_timesteps": config.total_steps * episode.action_repeat,
        "episode_length": episode.steps * episode.action_repeat,
        "action_repeat": episode.action_repeat,
        "num_envs": config.num_envs,
        "unroll_length": learner.unroll,
        "batch_size": config.num_envs // learner.minibatches,
        "num_minibatches": learner.minibatches,
        "num_updates_per_batch": learner.epochs,
        "learning_rate": learner.learning_rate,
        "entropy_cost": learner.entropy,
        "discounting": learner.discount,
        "gae_lambda": learner.trace,
        "clipping_epsilon": learner.clip,
        "max_grad_norm": learner.max_grad_norm,
        "normalize_observations": learner.policy.normalise,
        "reward_scaling": reward_scale,
        "network_factory": partial(networks.make_ppo_networks, **sizes),
        "num_evals": evals + 1,
        "num_eval_envs": config.eval_episodes,
        "deterministic_eval": True,
    }


def learn(
    run: Run, given: dict[str, Any], seed: int, before: float, on_row: Callable[[Row], None]
) -> None:
    """Train one seed; on_row gets each evaluation. before: [s] of the command before any seed."""
    episode, began = run.agent.episode, monotonic() - before

    def progress(step: int, metrics: Mapping[str, Any]) -> None:
        value = round(float(metrics["eval/episode_reward"]), 1)
        made = int(step) // episode.action_repeat
        on_row({"step": made, "return": value, "s": round(monotonic() - began, 1)})

    train.train(Exact(episode.env), seed=seed, progress_fn=progress, **given)


def main() -> None:
    """The command."""
    words = dict(word.split("=", 1) for word in sys.argv[1:])
    own = {key: words.pop(key, value) for key, value in OWN.items()}
    run = build(load(["algo=ppo", *(f"{key}={value}" for key, value in words.items())]))
    jax.device_put_replicated = lambda tree, devices: jax.tree.map(  # JAX 0.10 removed it
        lambda x: jnp.stack([x] * len(devices)), tree
    )
    given = settings(run, int(own["evals"]), float(own["reward_scale"]))
    rows: dict[int, list[Row]] = {seed: [] for seed in run.seeds}
    about = {"task": run.config.task, "machine": device(), "versions": versions(("brax", "jax"))}
    about |= {key: value for key, value in given.items() if key != "network_factory"}

    def write(seed: int, row: Row) -> None:
        rows[seed].append(row)
        known = {s: each for s, each in rows.items() if each}
        found = {**about, "returns": returns(known), "clock": clock(known), "rows": known}
        write_text(Path(own["out"]), json.dumps(found, indent=1) + "\n")
        print(f"seed {seed}: {row}", flush=True)

    before = monotonic() - BEGAN
    for seed in run.seeds:
        learn(run, given, seed, before, partial(write, seed))


if __name__ == "__main__":
    main()
