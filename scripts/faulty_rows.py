"""Decisions of faulty worlds, without learning, and what the doctor's checks find in them.

    python -m scripts.faulty_rows tasks=pendulum seeds=31,32,33 out=docs/results/doctor.json

A third of the episodes has uniform actions, each other one a random linear policy with noise. The
thresholds were chosen with cart_pendulum and cartpole, seeds 1 and 2, in view.
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.cli.arguments import Argument, read
from hybrid_rl.tools.doctor import observed, regular, task
from hybrid_rl.tools.doctor.evidence import Evidence
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Params, Spec, Transition

sys.path.insert(0, str(Path(__file__).parent / "broken"))
from faulty_world import KINDS, Faulty  # pyright: ignore[reportMissingImports]

NATIVE = {"physics": "native"}
TASKS: dict[str, tuple[str, tuple[int, ...], int, int, dict[str, str]]] = {
    # class, its velocities, steps of an episode, decisions, settings
    "pendulum": ("analytic.pendulum.Pendulum", (2,), 200, 3000, {}),
    "cart_pendulum": ("analytic.cart_pendulum.CartPendulum", (2, 3), 120, 3000, {}),
    "cartpole": ("cartpole.Cartpole", (1, 4), 300, 3000, NATIVE),
    "halfcheetah": ("halfcheetah.HalfCheetah", tuple(range(8, 17)), 1000, 10000, NATIVE),
    "hopper": ("hopper.Hopper", tuple(range(5, 11)), 200, 10000, NATIVE),
}
SHORT = {"cart_pendulum": 20, "hopper": 15}  # decisions of an episode at least, for their number
CHECKS = {
    "action rate": observed.rare,
    "noise": observed.noise,
    "action": observed.action,
    "hidden state": observed.hidden,
    "every other decision": regular.alternates,
    "action's gain": regular.gains,
    "ends": task.ends,
    "reward": task.reward,
}
ARGUMENTS = (
    Argument("tasks", "pendulum", f"of {', '.join(TASKS)}"),
    Argument("seeds", "31", "of the episodes"),
    Argument("kinds", "", "of faults; empty: all; none: of the sound world alone"),
    Argument("out", "", "JSON that gets the names of the checks that spoke; empty: printed alone"),
)


class Tried:
    """Uniform actions, or a linear policy of the episode with noise."""

    def init(self, spec: Spec) -> tuple[Array, Array, Array]:
        """Weights [1+o, m] and noise [], and whether they are drawn."""
        return jnp.zeros((1 + spec.obs, spec.act)), jnp.zeros(()), jnp.zeros((), bool)

    def greedy(self) -> "Tried":
        """Itself."""
        return self

    def act(self, params: Params, state: tuple, obs: Array, key: Array) -> tuple[Any, ...]:
        """Action [m], the state, no metrics. noise > 1: uniform."""
        weights, noise, drawn = state
        a, b, c, d = jax.random.split(key, 4)
        new = 2 * jax.random.normal(a, weights.shape) / jnp.sqrt(len(weights))
        weights = jnp.where(drawn, weights, new)
        some = jax.random.uniform(c, minval=0.2, maxval=0.8)
        noise = jnp.where(drawn, noise, jnp.where(jax.random.uniform(b) < 1 / 3, 9.0, some))
        size = weights.shape[1:]
        linear = jnp.append(1.0, jnp.tanh(obs / 2)) @ weights + noise * jax.random.normal(d, size)
        chance = jax.random.uniform(d, size, minval=-1, maxval=1)
        return jnp.where(noise > 1, chance, jnp.tanh(linear)), (weights, noise, drawn | True), {}


def made(name: str, seed: int, kinds: list[str]) -> Iterator[Evidence]:
    """The decisions of each kind of fault."""
    of, velocities, steps, number, own = TASKS[name]

    def world(kind: Any) -> Episode:
        env = Faulty(f"hybrid_rl.envs.{of}", kind, velocities, steps, own)
        return Episode(env, steps=steps)

    def one(kind: Array, key: Array) -> tuple[Array, ...]:
        action, s = rollout_with_actions(world(kind), Tried(), Params(), key, steps)
        return action, s.obs, s.reward, s.terminated, s.done

    keys = jax.random.split(jax.random.key(1000 * seed + 7), number // SHORT.get(name, steps))
    numbers = jnp.array([KINDS.index(kind) for kind in kinds])
    found = jax.jit(jax.vmap(jax.vmap(one, (None, 0)), (0, None)))(numbers, keys)
    agent = SimpleNamespace(spec=world("none").spec)
    for action, obs, reward, ended, done in zip(*map(np.asarray, found), strict=True):
        lives, over = ~done[:, :-1], (done & ~ended)[:, 1:]
        each = (obs[:, :-1], action, reward[:, 1:], 1.0 * ended[:, 1:], 1.0 * over, obs[:, 1:])
        rows = Transition(*(a[lives][:number][None] for a in each))
        folder, run = SimpleNamespace(rows=[], summary={}), SimpleNamespace(agent=agent)
        evidence = Evidence(folder, run, rows)  # pyright: ignore
        vars(evidence)["at_rest"] = None
        yield evidence


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    kinds = [kind for kind in given["kinds"].split(",") if kind] or KINDS
    found: dict[str, dict[str, list[str]]] = {}
    for name in given["tasks"].split(","):
        for seed in map(int, given["seeds"].split(",")):
            for kind, run in zip(kinds, made(name, seed, kinds), strict=True):
                lines = {check: line for check, of in CHECKS.items() if (line := of(run))}
                found.setdefault(f"{name}, seed {seed}", {})[kind] = [*lines]
                print(name, seed, kind, *lines.values(), sep="\n  ", flush=True)
    if given["out"]:
        out = Path(given["out"])
        old = json.loads(out.read_text()) if out.exists() else {}
        out.write_text(json.dumps(old | {"rows": old.get("rows", {}) | found}, indent=1) + "\n")


if __name__ == "__main__":
    main()
