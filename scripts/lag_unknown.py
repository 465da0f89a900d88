"""Simulated worlds late by an unknown lag: do random decisions find it?

    python -m scripts.lag_unknown out=lag_unknown.json

Of each task and delay [decisions] ten worlds, whose first decisions are random and know of no
delay. FILE has the lag by `doctor`'s estimate [decisions], and for how many an action is held back
by a method that knows this lag, and by one that knows the true one; `same`: 1 where they agree.
"""

import json

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.cli.arguments import Argument, output, read, whole
from hybrid_rl.outside.lag import estimated
from hybrid_rl.settings import build
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.wrappers import whole as held

ARGUMENTS = (
    Argument("decisions", 2000, "random ones of each world", whole()),
    Argument("seeds", 10, "of each task and delay", whole()),
    Argument("out", "", "JSON", needed="out=FILE.json"),
)
TASKS = {  # -> what one types with it
    "halfcheetah": [],
    "hopper": [],
    "cartpole": [],
    "quadcopter": ["episode.action_repeat=4", "episode.steps=300"],
}
DELAYS = {  # -> delay, jitter [decisions], loss
    "0": (0, 0, 0),
    "0.3": (0.3, 0, 0),
    "1": (1, 0, 0),
    "1.45": (1.45, 0, 0),
    "2.3": (2.3, 0, 0),
    "4": (4, 0, 0),
    "1, jitter and loss": (1, 0.3, 0.01),
    "2.3, jitter and loss": (2.3, 0.3, 0.01),
}
AGES = np.arange(8)  # actions of which one may act, the newest first, as in `doctor`


def lag_of(episode: Episode, key: jax.Array, decisions: int) -> float:
    """The lag [decisions] of one world, estimated from `decisions` random actions."""

    def one(carry: tuple, key: jax.Array) -> tuple:
        state, age = carry
        act, again = jax.random.split(key)
        u = jax.random.uniform(act, (episode.spec.act,), jnp.float32, -1, 1)
        now = episode.step(state, u)
        row = state.obs, now.obs, u, age
        return (episode.auto_reset(now, again), jnp.where(now.done, 0, age + 1)), row

    begin, rest = jax.random.split(key)
    first = episode.reset(begin), jnp.int32(0)
    rows = jax.jit(lambda: jax.lax.scan(one, first, jax.random.split(rest, decisions))[1])()
    obs, after, u, age = map(np.asarray, rows)
    t = np.nonzero(age >= len(AGES))[0]  # whose actions are all of the same episode
    moving = obs.std(0) > 0
    sent, times = u[t[:, None] - AGES], np.tile(-AGES.astype(float), (len(t), 1))
    return estimated(obs[t][:, moving], after[t][:, moving], sent, times, np.ones(len(t)))


def main() -> None:
    """The command."""
    given, _ = read(__doc__, ARGUMENTS)
    out, found, same = output("out", given["out"], (".json",)), {}, []
    for task, words in TASKS.items():
        plain = build.episodes(build.load([f"task={task}", "algo=sac", *words]))
        for name, (delay, jitter, loss) in DELAYS.items():
            dt = plain.spec.dt
            late = {"episode.delay": delay * dt, "episode.jitter": jitter * dt}
            late |= {"episode.loss": loss, "episode.lag": 0}
            typed = [f"{key}={value}" for key, value in late.items()]
            episode = build.episodes(build.load([f"task={task}", "algo=sac", *words, *typed]))
            keys = jax.random.split(jax.random.key(300), given["seeds"])
            lags = [round(lag_of(episode, key, given["decisions"]), 2) for key in keys]
            row = {"lags": lags, "held": [int(held(lag)) for lag in lags]}
            true = int(held(float(delay + jitter)))
            same += [int(each == true) for each in row["held"]]
            found.setdefault(task, {})[name] = {**row, "true": true}
            print(task, name, found[task][name], flush=True)
    made = f"{given['decisions']} random decisions of each world; lags [decisions]"
    numbers = {"made": made, "same": same, "tasks": found}
    out.write_text(json.dumps(numbers) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
