"""A trained run on another reward, with a constraint or another planner; nothing is trained.

    evaluate run=DIR reward=speed reward.target=5
    evaluate run=DIR constraint=speed constraint.most=2 constraint.chance=0.1
    evaluate run=DIR planner=sampling planner.samples=256

`reward=NAME` is one of conf/reward, or one of yours. The environment pays it, and a planner
maximises it in the learned model, from roll-outs of the policy (conf/retarget.yaml). A method
without a learned model keeps its policy, which knows nothing of the reward.

`constraint=NAME` is one of conf/constraint. The environment counts its violations, and the planner
`gradient` keeps it, for the new reward or for that of the training.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from hydra import compose, initialize_config_dir
from hydra.errors import HydraException
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from hybrid_rl import config as configuration
from hybrid_rl.composition import CONF, explain
from hybrid_rl.errors import UsageError
from hybrid_rl.trained import Trained, built

PLANNERS = ("planner", "planner_alone")
KEYS = (*configuration.PAID, *PLANNERS)  # of conf/retarget.yaml, which a user may change


def retargeted(trained: Trained, overrides: Sequence[str]) -> Trained:
    """`trained` with the goal and the planner that the overrides name.

    overrides: reward=NAME, reward.KEY=VALUE, as of commands; also of constraint and planner.

    Raises:
        UsageError: for a name, a key or a value that does not exist or does not fit the task.
    """
    if not overrides:
        return trained
    assert trained.config is not None
    goal = _composed(overrides)
    if trained.agent is None:
        return _paid(trained, goal, overrides)
    config: Any = OmegaConf.to_container(trained.config, resolve=True)
    kept = {key: value for key, value in config.items() if key not in KEYS}
    changed: Any = OmegaConf.merge(kept, _fitting(config, goal))
    OmegaConf.resolve(changed)
    run = built(changed)
    return replace(trained, episode=run.agent.episode, controllers=run.controllers, config=changed)


def _fitting(config: dict[Any, Any], goal: DictConfig) -> DictConfig:
    """The parts of `goal` that a run with this configuration can use."""
    goal = goal.copy()
    if goal.reward is None:  # the planner maximises the reward of the training
        goal.planner.objective = "${objective}"
        goal.planner_alone.objective = "${model_objective}"
    for name in configuration.PAID:
        goal[name] = goal[name] or config.get(name)
    lacking = {"model", "reward_model"} - set(config)
    if lacking:
        names = configuration.PAID
    elif "policy" not in config:
        goal.controllers = dict.fromkeys(("full", "planner"), "${planner_alone}")
        names = ("goal_reward", "goal_objective", "planner_alone", "controllers")
        names = (*configuration.PAID, *names)
    else:
        names = tuple(map(str, goal))
    return OmegaConf.masked_copy(goal, list(names))


def _paid(trained: Trained, goal: DictConfig, overrides: Sequence[str]) -> Trained:
    """A policy from a file, in an environment that pays another reward or has a constraint."""
    if lost := [text for text in overrides if text.startswith("planner")]:
        raise UsageError(f"{lost[0]}: a policy's file holds no model to plan with; give run=DIR")
    paid = OmegaConf.masked_copy(goal, [*configuration.PAID])
    config: Any = OmegaConf.merge(trained.config, paid)
    OmegaConf.resolve(config)
    return replace(trained, episode=configuration.episodes(config), config=config)


def _composed(overrides: Sequence[str]) -> DictConfig:
    """conf/retarget.yaml with the overrides of a command."""
    words = [f"controller@{text}" if text.split("=")[0] in PLANNERS else text for text in overrides]
    try:
        with initialize_config_dir(str(CONF), version_base="1.3"):
            found: Any = compose("retarget", words)
    except (HydraException, OmegaConfBaseException) as error:
        raise UsageError(explain(error)) from error
    return OmegaConf.create({**dict.fromkeys(configuration.PAID), **found})
