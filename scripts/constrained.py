"""Return and violations of a constraint, by who acts: policies, or the planner in four ways.

    python -m scripts.constrained run=DIR constraint=speed constraint.most=3 out=FILE
    python -m scripts.constrained run=DIR penalised=DIR2 constraint=pitch reward=run out=FILE

Nothing is trained. The goal is `reward`, which the planner knows, or that of the training, with its
critic. `penalised` is a run whose training had the constraint. Runs with the same seeds have the
same first states in all rows. Episodes count the decisions that violate, and those until a fall.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import jax.numpy as jnp
from jax import Array

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import CHANGES, CONFIG_DIR, GOAL, POLICY, Argument, read, whole
from hybrid_rl.controllers.gradient import GradientController
from hybrid_rl.errors import UsageError
from hybrid_rl.run.retarget import load_changed
from hybrid_rl.run.saved import Trained, load
from hybrid_rl.training.rollout import advance, begin, scores
from scripts.seeds import Row, every, split_names, write

CHANCE = 0.1  # unless constraint.chance is given
ARGUMENTS = (
    Argument("run", "", "folder of a run with a learned model"),
    POLICY,
    Argument("penalised", "", "folder of a run that was trained with the constraint"),
    *GOAL,
    CONFIG_DIR,
    Argument("episodes", 3, "of each seed", whole()),
    Argument("rows", "", "of these only, with ; between them; empty: all"),
    Argument("out", "constrained.json", "the numbers"),
)


def acting(trained: Trained, penalised: Trained | None) -> dict[str, tuple[Trained, Any]]:
    """Row -> the learners that act in it, and their controller."""
    limit: Any = trained.episode.constraint
    planner = trained.controllers["full"]
    if limit is None or not isinstance(planner, GradientController):
        raise UsageError("constraint: give one, and a run with a learned model")
    hard: Any = replace(limit, chance=getattr(limit, "chance", None) or CHANCE)
    ways = {
        "no constraint": None,
        "price": replace(hard, chance=None),
        "chance": replace(hard, price=0.0),
        "price and chance": hard,
    }
    known = {"policy": (trained, trained.controllers["policy"])}
    if penalised is not None:
        known["policy, penalised"] = (penalised, penalised.controllers["policy"])
    return known | {
        f"both, {way}": (trained, replace(planner, constraint=each)) for way, each in ways.items()
    }


def measured(trained: Trained, controller: Any, episodes: int) -> dict[str, Any]:
    """Means [S] over the episodes: return, violations and decisions."""

    def one(params: Any, keys: Array) -> dict[str, Array]:
        carry = begin(trained.episode, controller, keys)
        steps = jnp.int32(trained.episode.steps)
        env, *_ = advance(trained.episode, controller, params, carry, steps)
        return {**scores(env), "decisions": env.clock.decision}

    got = every(trained, episodes, one)
    return {name: each.mean(1) for name, each in got.items()}


def main() -> None:
    """The command."""
    given, changes = read(__doc__, ARGUMENTS, CHANGES, ("run", "policy"))
    trained, words = load_changed(given, changes)
    other = load(given["penalised"], "penalised") if given["penalised"] else None
    other = other and replace(other, episode=trained.episode)  # the same world and constraint
    known = acting(trained, other)
    wanted = split_names(given["rows"]) or list(known)
    if lost := [name for name in wanted if name not in known]:
        raise UsageError(f"rows={lost[0]}: choose from {'; '.join(known)}")

    def rows() -> Iterator[Row]:
        for name in wanted:
            yield name, measured(*known[name], given["episodes"])

    about = {"changes": words, "penalised": given["penalised"]}
    write(given["out"], trained, {**about, "episodes": given["episodes"]}, rows())


if __name__ == "__main__":
    command.run(main)
