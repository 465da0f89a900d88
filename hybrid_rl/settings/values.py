"""Checks of a configuration: counts, choices, kinds of values, fields of parts."""

import inspect
from collections.abc import Collection, Mapping
from dataclasses import fields, is_dataclass
from numbers import Integral
from types import NoneType
from typing import Any, get_origin

from omegaconf import DictConfig, ListConfig, OmegaConf

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.envs.adapters.unstepped import Unstepped
from hybrid_rl.envs.mujoco.physics import IMPLEMENTATIONS
from hybrid_rl.errors import UsageError, printable, relative
from hybrid_rl.fields import as_yaml, choices, plain
from hybrid_rl.files import targets as parts
from hybrid_rl.networks.precision import PRECISIONS
from hybrid_rl.settings.complete import nearest
from hybrid_rl.settings.groups import MODES
from hybrid_rl.settings.words import SHOW
from hybrid_rl.types import NAME

COUNTS = (
    *("num_seeds", "num_envs", "total_steps", "eval_every", "eval_episodes"),
    *("checkpoint_every", "log_every"),
)
SECTIONS = ("env", "episode", "replay", "controllers", "learners")
PAID = ("reward", "constraint")  # what the world pays and asks for; a run may lack the keys
STEPS = 2**31  # decisions, fewer of which are counted
FINITE = 3.4e38  # the largest number of 32 bits
SEEDS = 2**32  # distinct seeds of JAX's generator
KINDS = {  # type of a part's field -> its name in messages
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    str: "a word",
    tuple: "a list",
    NoneType: "null",
}


def check_words(config: DictConfig) -> None:
    """Raise UsageError for a word that becomes a folder, or an override, and is no plain one."""
    for key in ("task", "algo", "policy_learning"):
        if not NAME.fullmatch(str(config.get(key))):
            line = "must be letters, digits, _, . and -"
            raise UsageError(f"{key}={printable(config[key])}: {line}")


def check(config: DictConfig) -> None:
    """Raise UsageError for a value that no run accepts; parts check their own ranges."""
    for key in SECTIONS:
        if not isinstance(config.get(key), DictConfig):
            hint = f"did you mean task={config.get(key)}?" if key == "env" else SHOW
            raise UsageError(f"{key}={config.get(key)}: must be a group of keys; {hint}")
    if "_target_" not in config.env:
        raise UsageError("env: lacks _target_; write _target_: MODULE.CLASS, as in my_world.World")
    _check_parts(config)
    parts.check(OmegaConf.to_container(config))
    check_words(config)
    check_kinds(OmegaConf.create({"env": config.env}))  # first, as other parts hold copies of it
    _check_planned(config)
    for key in COUNTS:
        whole(key, config[key])
    countable(config)
    if config.get("run_dir") == "":
        raise UsageError("run_dir=: is empty; give a folder, or leave it out")
    whole("seed", config.seed, 0)
    if config.seed + config.num_seeds > SEEDS:
        raise UsageError(
            f"seed={config.seed}: must be at most {SEEDS - config.num_seeds} with "
            f"num_seeds={config.num_seeds}: JAX takes seeds of 32 bits"
        )
    modes = config.eval_modes
    if not isinstance(modes, ListConfig) or not set(modes) <= set(MODES):
        raise UsageError(f"eval_modes={as_yaml(modes)}: must be a list of {', '.join(MODES)}")
    if len(set(modes)) < len(modes):
        raise UsageError(f"eval_modes={modes}: has one of them twice")
    freeze = config.get("freeze", ListConfig([]))
    if not isinstance(freeze, ListConfig) or any(type(name) is not str for name in freeze):
        raise UsageError(f"freeze={freeze}: must be a list of learners, as in freeze=[policy]")
    for key in ("checkpoint_replay", "distributed"):
        if type(config.get(key, False)) is not bool:
            raise UsageError(f"{key}={config[key]}: must be true or false")
    for key, known in (("precision", PRECISIONS), ("physics", IMPLEMENTATIONS)):
        one_of(key, config[key], known)
    check_kinds(config)


def _check_parts(config: DictConfig) -> None:
    """Raise UsageError for a controller, a learner or a memory that is no part; null: none."""
    named = {name: config.get(name) for name in ("replay", "reward", "constraint")}
    for section in ("controllers", "learners"):
        named |= {f"{section}.{name}": node for name, node in config[section].items()}
    for key, node in named.items():
        if node is not None and not (isinstance(node, DictConfig) and "_target_" in node):
            raise UsageError(f"{key}={node}: must be a part, a group of keys with _target_")
    if config.controllers.get("full") is None:
        raise UsageError("controllers.full=null: must be a part, as it acts in training")


def _check_planned(config: DictConfig) -> None:
    """Raise UsageError for a method that plans on the true dynamics of what JAX cannot step."""
    kind, planned = parts.part_class(config.env._target_), "hybrid_rl.models.world.World"
    if isinstance(kind, type) and issubclass(kind, Unstepped) and planned in str(config):
        line = "plans on the true dynamics, and this task steps outside JAX; choose a method that"
        raise UsageError(f"task={config.task}: {config.algo} {line} learns its model, or sac")


def time_limit(env: External | Robot, given: Mapping[str, Any]) -> dict[str, int]:
    """The time limit of an environment on the host [decisions], if `given` has none."""
    for key in ("delay", "sensor_noise", "action_noise", "randomise", *PAID):
        value = given.get(key)
        if isinstance(value, dict):  # of names and ranges
            value = {name: each for name, each in value.items() if each is not None}
        if value:
            line = "is for the environments in JAX; put a Gymnasium wrapper around this one"
            where = key if key in PAID else f"episode.{key}={value}"
            raise UsageError(f"{where}: {line}")
    if given.get("steps") is not None:
        return {}
    if isinstance(env, Robot) or env.known.steps is None:
        raise UsageError(f"episode.steps: {env.name} has no time limit; give one, in decisions")
    return {"steps": -(-env.known.steps // given.get("action_repeat", 1))}


def random_decisions(values: Mapping[str, Any], given: Mapping[str, str]) -> Any:
    """`random_steps`: half of `total_steps` at most, where the user gave these and not those.

    values: of the configuration; given: overrides of the user, key -> value.
    """
    random, total = values["random_steps"], values["total_steps"]
    if "total_steps" not in given or {"random_steps", "model_random_steps"} & given.keys():
        return random
    return min(random, (total + 1) // 2) if type(random) is type(total) is int else random


def set_length(learners: DictConfig, decisions: int) -> None:
    """Give schedules the length of the run, unless they have one."""
    for learner in filter(None, learners.values()):
        schedule = learner.get("schedule")
        if schedule is not None and schedule.get("decisions", decisions) is None:
            schedule.decisions = decisions


def countable(config: DictConfig) -> None:
    """Raise UsageError for more decisions than their counter holds, the last round included."""
    if config.total_steps + config.num_envs > STEPS:
        most = STEPS - config.num_envs
        if most < 1:
            raise UsageError(f"num_envs={config.num_envs}: must be at most {STEPS - 1}")
        line = f"total_steps={config.total_steps}: must be at most {most}"
        raise UsageError(f"{line}: decisions are counted in 32 bits")


def check_kinds(node: DictConfig, where: str = "") -> None:
    """Raise UsageError for a value in `node` that the field of its part cannot hold."""
    kinds = _kinds(node, where)
    for key, value in node.items():
        each = value if isinstance(value, ListConfig) else [value]
        if any(isinstance(item, float) and not abs(item) <= FINITE for item in each):
            raise UsageError(f"{where}{key}={value}: must be finite")
        if isinstance(value, DictConfig):
            check_kinds(value, f"{where}{key}.")
        if isinstance(value, DictConfig) and key not in kinds:
            continue
        kind = tuple if isinstance(value, ListConfig) else type(value)
        wanted = kinds.get(str(key), {kind})
        if kind not in wanted and not (kind is int and float in wanted):
            called = " or ".join(KINDS[each] for each in KINDS if each in wanted)
            raise UsageError(f"{where}{key}={as_yaml(value)}: must be {called}")


def check_fields(node: DictConfig, part: Any, where: str) -> None:
    """Raise UsageError for a key of `node` that is no argument of `part`, or an argument it lacks.

    part: a class or a function.
    """
    try:
        takes = inspect.signature(part).parameters
    except (TypeError, ValueError):  # of a built-in
        return
    called = getattr(part, "__name__", part)
    if not part.__module__.startswith("hybrid_rl."):
        called = f"{called} in {relative(inspect.getsourcefile(part) or part.__module__)}"
    for name, each in takes.items():
        many = each.kind in (each.VAR_POSITIONAL, each.VAR_KEYWORD)
        given = many or each.default is not each.empty or name in node
        if not given and (where, name) != ("episode.", "env"):
            raise UsageError(f"{where}{name}: is missing; {called} has no default for it")
    if any(each.kind is each.VAR_KEYWORD for each in takes.values()):
        return
    for key in node:
        name = str(key)
        if name in takes or name.startswith("_") or OmegaConf.is_missing(node, key):
            continue
        if isinstance(part, type) and not is_dataclass(part) and not takes:
            called = f"{called} is no dataclass (@dataclass(frozen=True)), and"
        names = [name for name in takes if (where, name) != ("episode.", "env")]
        near = nearest(name, names)
        hint = f"; did you mean {near}?" if near else ""
        known = f"has {', '.join(names)}" if names else "has no fields"
        raise UsageError(f"{where}{name}: {called} {known}{hint}")


def _kinds(node: DictConfig, where: str) -> dict[str, set[type]]:
    """Field -> the types that it accepts, for those fields of a part whose types are in KINDS."""
    if "_target_" not in node:
        return {}
    try:
        part = parts.part_class(node._target_)
    except ValueError as error:
        raise UsageError(f"{where}_target_={node._target_}: {error}") from error
    check_fields(node, part, where)
    kinds = {}
    for field in fields(part) if is_dataclass(part) else ():
        each = map(plain, choices(field.type))
        wanted = {get_origin(kind) or kind for kind in each}
        if wanted <= set(KINDS):
            kinds[field.name] = wanted
    return kinds


def whole(key: str, value: Any, least: int = 1) -> int:
    """The value at `key`, a whole number, which may be one of NumPy's."""
    if not isinstance(value, Integral) or isinstance(value, bool) or value < least:
        raise UsageError(f"{key}={as_yaml(value)}: must be a whole number, {least} or more")
    return int(value)


def one_of(key: str, value: Any, known: Collection[str]) -> str:
    """The value at `key`."""
    if value not in known:
        raise UsageError(f"{key}={value}: choose one of {', '.join(known)}")
    return value
