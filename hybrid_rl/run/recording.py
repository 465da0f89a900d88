"""The decisions of an expert, and the policy of a run, as the files of `demonstrate`."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import jax
import numpy as np

from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.core.lifting import is_identity
from hybrid_rl.data.trained import save
from hybrid_rl.errors import UsageError
from hybrid_rl.files.reading import json_file
from hybrid_rl.protocols import Controller
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.run.saved import OBJECTIVES, Trained, load
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings.words import plain
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Params, Transition


@dataclass(frozen=True)
class Recording:
    """The decisions of an expert: N decisions, of M episodes."""

    decisions: Transition  # [N, ...]
    episode: np.ndarray  # [N] 0, 0, ..., M - 1
    returns: np.ndarray  # [M]
    success: np.ndarray | None  # [M] 1 if it succeeded at the end; None: the task has no measure


def record(
    episode: Episode, controller: Controller, params: Params, episodes: int, seed: int = 0
) -> Recording:
    """`episodes` episodes of a controller with `params`, whose rewards no violation reduces."""
    episode = replace(episode, constraint=None)
    keys = jax.random.split(jax.random.key(seed), episodes)
    one = partial(rollout_with_actions, episode, controller, params, steps=episode.steps)
    actions, states = jax.tree.map(np.asarray, jax.jit(jax.vmap(one))(keys))
    before, after = (jax.tree.map(lambda a, s=s: a[:, s], states) for s in np.s_[:-1, 1:])
    flags = after.reward, after.terminated, after.truncated
    rows = Transition(before.obs, actions, *flags, after.obs)
    lived = ~before.done  # [M, T]
    success = states.metrics.get("success")
    return Recording(
        Transition(*(row[lived] for row in rows)),
        np.nonzero(lived)[0],
        states.clock.total[:, -1],
        None if success is None else success[:, -1],
    )


def scripted_expert(
    given: Mapping[str, Any], changes: Mapping[str, str]
) -> tuple[Episode, Controller, Params]:
    """A task, as `changes` make it, and its scripted expert, which has no parameters.

    given: task, expert and config_dir, of the command line.
    """
    named = {key: given[key] for key in ("task", "expert") if given[key]}
    values = [f"{key}={value}" for key, value in {**named, **changes}.items()]
    config = configuration.load(["algo=sac", *values], given["config_dir"] or None)
    prepare(config)
    expert = configuration.expert(config)
    return configuration.build(config).agent.episode, expert, Params()


def save_policy(
    file: Path, folder: Path, seed: int | None, command: str, models: bool
) -> tuple[str, int]:
    """Write the policy of a run to a file; (task, number of parameters).

    seed: of the learner; None: the first. command: how it was trained. models: also the parameters
    to plan with.
    """
    run = load(folder)
    seed = run.seeds[0] if seed is None else seed
    _, params = run.learner(seed, next(iter(run.controllers)), world=True)
    if not jax.tree.leaves(params.policy):
        raise UsageError(f"run={folder}: has no policy with parameters")
    about = _description(folder, run, command, seed)
    known = _models(folder, run, params, about) if models else {}
    save(file, run.task, run.episode.spec, params.policy, about, known)
    return run.task, sum(leaf.size for leaf in jax.tree.leaves((params.policy, known)))


def _models(
    folder: Path, run: Trained, params: Params, about: dict[str, Any] | None
) -> dict[str, Any]:
    """The parameters to plan with, whose parts are added to `about`."""
    config = plain(run.config)
    parts = {"model": params.model, "reward_model": params.reward}
    if about is None or any(value is None or not config.get(n) for n, value in parts.items()):
        raise UsageError(f"models=true: {folder} has no policy with a learned model and reward")
    known = [*parts]
    if params.critic is not None:
        parts["critic"] = params.critic
        known += ["critic", *(name for name in OBJECTIVES if name in config)]
    about |= {name: _anywhere(config[name]) for name in known}
    return parts


def _anywhere(node: Any) -> Any:
    """`node` of a configuration, with the physics of whatever machine reads it."""
    if isinstance(node, list):
        return list(map(_anywhere, node))
    if not isinstance(node, dict):
        return node
    own = {"physics": "auto"} if isinstance(node.get("physics"), str) else {}
    return {key: _anywhere(value) for key, value in node.items()} | own


def _description(folder: Path, trained: Trained, command: str, seed: int) -> dict[str, Any] | None:
    """`about` of the policy of the learner of `seed` of the run in `folder`.

    None if its controller `policy` is not a policy of observations alone.
    """
    config = plain(trained.config)
    controller: Any = trained.controllers.get("policy")
    if not isinstance(controller, PolicyController):
        return None
    model = trained.learner(mode="policy")[1].model
    if not is_identity(controller.model, model, trained.episode.spec.obs):
        return None
    named = [name for name in ("env", *configuration.PAID) if config.get(name) is not None]
    summary = json_file(folder / "summary.json", optional=True)
    return {
        "episode": config["episode"],
        "policy": config["controllers"]["policy"]["policy"],
        **{name: _anywhere(config[name]) for name in named},
        **{"algo": config["algo"], "seed": seed, "step": trained.step, "command": command},
        "evaluation": _evaluation(folder, trained.step, trained.seeds.index(seed)),
        **{key: summary.get(key) for key in ("device", "versions", "git_commit")},
    }


def _evaluation(folder: Path, step: int, number: int) -> dict[str, Any] | None:
    """Mean and returns of a seed in evaluation_policy.json of this step, if there are."""
    values = json_file(folder / "evaluation_policy.json", optional=True)
    if values.get("step") != step:
        return None
    return {"mean": values["mean"][number], "returns": values["returns"][number]}
