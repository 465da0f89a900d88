"""Does a task stay finite? Random actions in many worlds, and what became of them.

    python scripts/finite.py ant sawyer_push --worlds 256 --decisions 10000 --physics native

Worlds restart when an episode ends. Says how many worlds were ever not finite (observation,
reward or state), and the greatest observation; exits with 1 where there was such a world.
"""

import argparse
import sys
from time import perf_counter

import jax
import jax.numpy as jnp

from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.settings import build as config
from hybrid_rl.types import EnvState


def tumble(task: str, physics: str, worlds: int, decisions: int) -> tuple[int, float]:
    """(worlds that were not finite at some time, greatest observation in size)."""
    given = config.load([f"task={task}", f"physics={physics}"])
    prepare(given)
    episode = config.build(given).agent.episode
    first = jax.jit(jax.vmap(episode.reset))(jax.random.split(jax.random.key(0), worlds))

    def forward(i: jax.Array, held: tuple) -> tuple:
        state, lost, most = held
        acting, renewing = jax.random.split(jax.random.fold_in(jax.random.key(1), i))
        u = jax.random.uniform(acting, (worlds, episode.spec.act), minval=-1, maxval=1)
        state = jax.vmap(episode.step)(state, u)
        leaves = [x for x in jax.tree.leaves(state) if jnp.issubdtype(x.dtype, jnp.floating)]
        finite = [jnp.isfinite(x.reshape(worlds, -1)).all(1) for x in leaves]
        lost |= ~jnp.stack(finite).all(0)
        most = jnp.maximum(most, jnp.abs(state.obs).max())
        return jax.vmap(episode.auto_reset)(state, jax.random.split(renewing, worlds)), lost, most

    @jax.jit
    def run(state: EnvState) -> tuple:
        start = (state, jnp.zeros(worlds, bool), jnp.zeros(()))
        return jax.lax.fori_loop(0, decisions, forward, start)[1:]

    lost, most = run(first)
    return int(lost.sum()), float(most)


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description="Random actions in many worlds")
    parser.add_argument("tasks", nargs="+")
    parser.add_argument("--worlds", type=int, default=256)
    parser.add_argument("--decisions", type=int, default=10_000)
    parser.add_argument("--physics", default="native")
    arguments = parser.parse_args()
    bad = 0
    for task in arguments.tasks:
        began = perf_counter()
        lost, most = tumble(task, arguments.physics, arguments.worlds, arguments.decisions)
        bad += lost
        print(
            f"{task}, {arguments.physics}: {lost} of {arguments.worlds} worlds not finite in "
            f"{arguments.decisions:,} decisions, observations up to {most:.3g}, "
            f"{perf_counter() - began:.0f} s",
            flush=True,
        )
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
