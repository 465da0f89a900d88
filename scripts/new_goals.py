"""Returns on rewards that a run was never trained on, by who acts: policy, planner, or both.

    python -m scripts.new_goals run=DIR goals="speed 2;speed -2;level" steps=200 out=FILE

Each goal is a reward of conf/reward, with its target if it has one. All rows have the same first
states and nothing is trained. `still` acts with zeros; `times f` is the policy's action times f.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, cast

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import Argument, read, whole
from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.controllers.sampling import SamplingController
from hybrid_rl.errors import UsageError
from hybrid_rl.proposals.knots import KnotsProposal
from hybrid_rl.proposals.mixture import MixtureProposal
from hybrid_rl.proposals.noise import NoiseProposal
from hybrid_rl.proposals.policy import PolicyProposal
from hybrid_rl.run.retarget import retargeted
from hybrid_rl.run.saved import Trained, load
from hybrid_rl.tools.view.subject import replace_part
from hybrid_rl.training.rollout import advance, begin, scores
from scripts.seeds import Row, every, split_names, write

FACTORS = (0.8, 0.6, 0.4, 0.2)
SIGNALS = {"share": "planner/policy_share", "insertion": "planner/mode_insertion_gradient"}
ARGUMENTS = (
    Argument("run", "", "folder of a run with a learned model", needed="run=DIR"),
    Argument("goals", "speed 2", "REWARD TARGET; several with ; between them"),
    Argument(
        "rows",
        "",
        "of these only, with ; between them, or KEY=VALUE of the gradient planner; empty: all",
    ),
    Argument("env", "", "KEY=VALUE of the environment, where goals need another"),
    Argument("steps", 200, "decisions of an episode", whole()),
    Argument("episodes", 3, "of each seed", whole()),
    Argument("out", "new_goals.json", "the numbers"),
)


@dataclass(frozen=True)
class OneOf:
    """One of several goals, by a number that a compiled program takes as its argument."""

    goals: tuple[Any, ...]
    index: Array  # []

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of the chosen goal."""
        return jnp.stack([each.reward_of(x, u, after) for each in self.goals])[self.index]

    def smoothed(self, x: Array, u: Array, after: Array) -> Array:
        """The same, without jumps where the goal can."""
        each = [getattr(goal, "smoothed", goal.reward_of)(x, u, after) for goal in self.goals]
        return jnp.stack(each)[self.index]


@dataclass(frozen=True)
class Times:
    """A controller whose action is multiplied by a factor."""

    controller: Any
    factor: float

    def init(self, spec: Any) -> Any:
        """The controller's."""
        return self.controller.init(spec)

    def act(self, params: Any, state: Any, obs: Array, key: Array) -> tuple:
        """The controller's action times the factor."""
        u, state, metrics = self.controller.act(params, state, obs, key)
        return self.factor * u, state, metrics


@dataclass(frozen=True)
class Watched:
    """A controller whose state has the sum of one of its metrics until the end of the episode."""

    controller: Any
    metric: str

    def init(self, spec: Any) -> Any:
        """The controller's, and 0."""
        return self.controller.init(spec), jnp.zeros(())

    def act(self, params: Any, state: Any, obs: Array, key: Array) -> tuple:
        """The controller's."""
        u, inner, metrics = self.controller.act(params, state[0], obs, key)
        now = jnp.where(params.world.done, 0.0, metrics[self.metric])
        return u, (inner, state[1] + now), metrics


def rows(trained: Trained) -> dict[str, Any]:
    """Name -> controller, for the goal of `trained`."""
    both: Any = trained.controllers["full"]
    alone: Any = trained.controllers["planner"]
    policy = trained.controllers["policy"]
    noise = NoiseProposal(0.5, 0.8) if trained.episode.spec.act > 2 else KnotsProposal(5, std=0.7)
    sampling = partial(
        SamplingController, both.model, both.objective, normalise=True, temperature=0.3
    )
    own = PolicyProposal(both.policy)
    scaled = PolicyProposal(both.policy, both.strengths, both.quiet)
    return {
        "still": ConstantController(),
        "policy": policy,
        **{f"policy times {factor}": Times(policy, factor) for factor in FACTORS},
        "planner: noise": sampling(proposal=noise, horizon=15, samples=128),
        "planner: gradient": alone,
        "both: mixture": sampling(
            proposal=cast(Any, MixtureProposal(own, noise)), horizon=15, samples=128
        ),
        "both: strengths": sampling(proposal=scaled, horizon=20, samples=96, execute="best"),
        "both: gradient": both,
        **{name: Watched(both, metric) for name, metric in SIGNALS.items()},
    }


def varied(both: Any, name: str) -> Any:
    """`both` with the fields of a name such as "tail=20 horizon=10"."""
    pairs = [each.split("=") for each in name.split()]
    values = {key: json.loads(value) for key, value in pairs}
    return replace(both, **{k: tuple(v) if isinstance(v, list) else v for k, v in values.items()})


def measured(
    trained: Trained, goals: dict[str, Any], controller: Any, episodes: int
) -> dict[str, np.ndarray]:
    """Means [S] of `controller`, made for the first of the goals, on each of them.

    They are of returns, or of a Watched controller's metric.
    """
    known = tuple(goals.values())

    def one(params: Any, keys: Array) -> Array:
        def on(index: Array) -> Array:
            goal = OneOf(known, index)
            episode = replace_part(trained.episode, known[0], goal)
            acts = replace_part(controller, known[0], goal)
            env, control, _ = advance(
                episode, acts, params, begin(episode, acts, keys), jnp.int32(episode.steps)
            )
            if isinstance(acts, Watched):
                return control[1] / env.clock.decision
            return scores(env)["return"]

        return jax.vmap(on)(jnp.arange(len(known)))

    got = every(trained, episodes, one).mean(-1)
    return dict(zip(goals, got.T, strict=True))


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    run = load(given["run"])
    named = split_names(given["goals"])
    there = [retargeted(run, overrides(name)) for name in named]
    first = replace(there[0], episode=replace(there[0].episode, steps=given["steps"]))
    goals = [each.episode.reward for each in there]
    known = rows(there[0])
    wanted = split_names(given["rows"]) or list(known)
    if given["env"]:
        first, goals = in_another(first, goals, given["env"])
        known = rows(first)
    by_name = dict(zip(named, goals, strict=True))

    def each() -> Iterator[Row]:
        for name in wanted:
            controller = known.get(name) or varied(first.controllers["full"], name)
            yield name, measured(first, by_name, controller, given["episodes"])

    write(given["out"], first, {"steps": given["steps"], "goals": named}, each())


def overrides(name: str) -> list[str]:
    """The overrides of a goal: REWARD, REWARD TARGET, or REWARD QUANTITY TARGET."""
    reward, *rest = name.split()
    keys = ("target",) if len(rest) == 1 else ("quantity", "target")
    return [f"reward={reward}", *(f"reward.{k}={v}" for k, v in zip(keys, rest, strict=False))]


def in_another(trained: Trained, goals: list[Any], change: str) -> tuple[Trained, list[Any]]:
    """`trained` and goals in an environment with another value of a field."""
    old: Any = trained.episode.env
    key, _, text = change.partition("=")
    if not hasattr(old, key):
        raise UsageError(f"env={change}: the environment has no {key}")
    new = replace(old, **{key: json.loads(text)})
    there = {name: replace_part(c, old, new) for name, c in trained.controllers.items()}
    episode = replace_part(trained.episode, old, new)
    return replace(trained, episode=episode, controllers=there), [
        replace_part(goal, old, new) for goal in goals
    ]


if __name__ == "__main__":
    command.run(main)
