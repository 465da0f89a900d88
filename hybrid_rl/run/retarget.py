"""A trained run on another reward, with a constraint or another planner.

    evaluate run=DIR reward=speed reward.target=5
    evaluate run=DIR constraint=speed constraint.most=2 constraint.chance=0.1
    evaluate run=DIR planner=sampling planner.samples=256
    evaluate run=DIR planner.horizon=5

`reward=NAME` is one of conf/reward, or one of yours. The environment pays it, and a planner
maximises it in the learned model, from roll-outs of the policy (conf/retarget.yaml). A method
without a learned model keeps its policy, which knows nothing of the reward; a note says so.

`constraint=NAME` is one of conf/constraint. The environment counts its violations, and the planner
`gradient` keeps it, for the new reward or for that of the training.

`planner.KEY=VALUE` alone changes the planner of the run, also one of yours. Nothing is trained.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import jax
from omegaconf import DictConfig, OmegaConf

from hybrid_rl.envs.adapters.robot import Outside, Robot
from hybrid_rl.envs.adapters.unstepped import ALONE
from hybrid_rl.errors import UsageError
from hybrid_rl.files.targets import part_class
from hybrid_rl.protocols import Controller
from hybrid_rl.protocols.contract import has_users
from hybrid_rl.run.saved import Trained, load_named
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings.complete import complete, require
from hybrid_rl.settings.groups import search_path
from hybrid_rl.settings.words import forced, plain, typed_values, value_of
from hybrid_rl.training.contract import check_acting
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.history import acting as acting_in

GOALS = ("reward", "constraint", "planner")  # arguments of commands
PLANNERS = ("planner", "model_planner")
UNLEARNED = dict.fromkeys(("model", "reward_model", "policy"))  # where a run has none
SOFT = ("world", "price", "chance", "width")  # of a constraint: not what it limits
GROUPS = (*GOALS, "proposal")  # of conf/retarget.yaml
KEYS = (*configuration.PAID, *PLANNERS)  # of conf/retarget.yaml, which a user may change


def load_changed(
    given: Mapping[str, Any], changes: Mapping[str, str]
) -> tuple[Trained, dict[str, str]]:
    """The run or policy that a command names, as its other arguments change it, and these.

    given: run, policy and GOALS; changes: group.KEY=VALUE of CHANGES, of the command line.
    """
    trained = load_named(given)
    if isinstance(trained.episode.env, Robot | Outside):
        raise UsageError(f"{trained.task}: {ALONE}")
    changed = {key: given[key] for key in GOALS if given[key]} | dict(changes)
    words = [f"{key}={value}" for key, value in changed.items()]
    return retargeted(trained, words, given["config_dir"]), changed


def retargeted(
    trained: Trained, overrides: Sequence[str], config_dir: str | Path | None = None
) -> Trained:
    """`trained` on another goal, with another planner, or in another body.

        slow = retargeted(load("halfcheetah"), ["reward=speed", "reward.target=2", "env.mass=1.5"])

    overrides: as of `evaluate`: of reward, constraint, planner, env.KEY and episode.KEY.
    config_dir: a folder with groups of the user, as for `--config-dir`.

    Raises:
        UsageError: for a name, a key or a value that does not exist or does not fit the task, or a
            planner where no model was learned.
    """
    worlds = [text for text in overrides if text.startswith(("env.", "episode."))]
    goal = [text for text in overrides if text not in worlds]
    now = _aimed(trained, goal, config_dir)
    if not worlds:
        return now
    episode = disturbed(now.config, typed_values(worlds))
    episode, acting = acting_in(episode, now.controllers)
    return replace(now, episode=episode, controllers=acting)


def _aimed(
    trained: Trained, overrides: Sequence[str], config_dir: str | Path | None = None
) -> Trained:
    """`trained` on another goal or with another planner."""
    if not overrides:
        return trained
    config = plain(trained.config, resolve=True)
    named = {text.partition("=")[0]: text for text in overrides}
    if "controllers" in config and all(key.startswith("planner.") for key in named):
        return _adjusted(trained, overrides)
    words = [*overrides, *([search_path(config_dir)] if config_dir else [])]
    found = plain(configuration.composed("retarget", forced(words, GROUPS)))
    composed = {**dict.fromkeys(configuration.PAID), **found}
    typed = [key for key in named if "." in key]
    raw = complete({**UNLEARNED, **config, **composed}, [*composed], typed)
    for key in typed:
        group = key.partition(".")[0]
        goal = configuration.PAID if group == "planner" else ()  # they bring one
        if not {group, *goal} & {*named}:
            raise UsageError(f"{named[key]}: is a key of {group}=NAME; give that with it")
        require({**raw, "algo": config.get("algo")}, key)
    goal = _fitting(config, OmegaConf.create({key: raw[key] for key in composed}))
    for text in overrides:
        if (key := re.split("[.=]", text)[0]) in PLANNERS and key not in goal:
            raise UsageError(f"{text}: there is no learned model to plan with")
    kept = {key: value for key, value in config.items() if key not in {*KEYS, *goal}}
    changed: Any = OmegaConf.merge({"controllers": {}}, kept, goal)
    OmegaConf.resolve(changed)
    episode, controllers = configuration.acting(changed)
    notes = trained.notes
    if "planner" not in goal:
        unaware = f"what acts knows nothing of {' '.join(overrides)}"
        notes = (*notes, f"{trained.task}: there is no learned model to plan with; {unaware}")
    acting = {**trained.controllers, **_greedy(trained, episode, controllers)}
    return replace(trained, episode=episode, controllers=acting, notes=notes, config=changed)


def _adjusted(trained: Trained, overrides: Sequence[str]) -> Trained:
    """`trained` with other values of keys of the planner that acts in it, planner.KEY=VALUE."""
    acting = [text.replace("planner", "controllers.full", 1) for text in overrides]
    config = _with(trained.config, typed_values(acting))
    try:
        episode, controllers = configuration.acting(config)
    except UsageError as error:
        raise UsageError(str(error).replace("controllers.full", "planner", 1)) from error
    return replace(trained, controllers=_greedy(trained, episode, controllers), config=config)


def _greedy(
    trained: Trained, episode: Episode, controllers: Mapping[str, Controller]
) -> dict[str, Controller]:
    """The controllers without exploration."""
    if has_users([*controllers.values()]):
        one: Any = jax.tree.map(lambda leaf: leaf[0], trained.params)
        check_acting(episode, controllers.values(), controllers.values(), one)
    return {mode: controller.greedy() for mode, controller in controllers.items()}


def _fitting(config: dict[Any, Any], goal: DictConfig) -> DictConfig:
    """The parts of `goal` that a run with this configuration can use."""
    own = goal.reward is None and "objective" in config
    if goal.reward is None and "reward_model" in config:  # learned in training
        goal.goal_reward = "${reward_model}"
    if own:  # the planner maximises that of the training
        goal.planner.objective = "${objective}"
        alone = "model_objective" if "model_objective" in config else "objective"
        goal.model_planner.objective = f"${{{alone}}}"
    for name in configuration.PAID:
        goal[name] = goal[name] or config.get(name)
    for planner in (goal[name] for name in PLANNERS if "priced" in goal[name]):
        planner.priced = own and _priced(config, plain(goal)["constraint"])
    if "proposal" in config or "policy" not in config:
        del goal.proposal
    if not {"model", "reward_model"} <= {*config}:
        return OmegaConf.masked_copy(goal, [*configuration.PAID])
    if "policy" not in config:
        goal.planner = goal.model_planner
        goal.controllers = dict.fromkeys(("full", "planner"), "${planner}")
    return goal


def _priced(config: dict[Any, Any], limit: dict[Any, Any] | None) -> bool:
    """True if the reward of a run was learned with the price of this limit.

    That price stays, also if `constraint.price` is another one now.
    """
    before, now = (
        {key: value for key, value in (each or {}).items() if key not in SOFT}
        for each in (config.get("constraint"), limit)
    )
    learned = "reward_model" in config and part_class(config["reward_model"]["_target_"])
    return bool(before) and before == now and hasattr(learned, "init")


def disturbed(config: DictConfig, changes: Mapping[str, str]) -> Episode:
    """The episodes of `config` with other values of env.KEY and episode.KEY."""
    return configuration.episodes(_with(config, changes))


def _with(config: DictConfig, changes: Mapping[str, str]) -> DictConfig:
    """A copy of `config` with other values, as typed, at these keys."""
    changed: Any = OmegaConf.create(plain(config, resolve=True))
    for key, value in changes.items():
        OmegaConf.update(changed, key, value_of(value))
    return changed
