"""From overrides to parts: compose conf/, check it, build a run."""

import logging
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, fields, is_dataclass, replace
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, Union, get_args, get_origin

from hydra import compose, initialize_config_dir
from hydra.core.global_hydra import GlobalHydra
from hydra.errors import InstantiationException
from hydra.utils import get_object, instantiate
from omegaconf import DictConfig, ListConfig, OmegaConf

from hybrid_rl.envs.mujoco.physics import IMPLEMENTATIONS, resolve
from hybrid_rl.errors import UsageError
from hybrid_rl.overrides import (
    SHOW,
    plain,
    reached,
    refuse_new_keys,
    refuse_unused,
    search_path,
)
from hybrid_rl.protocols import Controller
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.episode import Episode

HERE = Path(__file__).parent
CONF = next(p for p in (HERE / "conf", HERE.parent / "conf") if (p / "train.yaml").exists())

COUNTS = (
    "num_seeds",
    "num_envs",
    "total_steps",
    "eval_every",
    "eval_episodes",
    "checkpoint_every",
    "log_every",
)

SEEDS = 2**32  # distinct seeds of JAX's generator
SECTIONS = ("env", "episode", "replay", "controllers", "learners")
READ = (  # the keys that a run reads, and with them all keys that they refer to
    *(*COUNTS, *SECTIONS, "expert", "task", "algo", "seed", "random_steps", "pretrain"),
    *("physics", "run_dir", "resume", "eval_modes", "checkpoint_replay", "compile_cache"),
    *("matmul_precision", "distributed", "logger"),
)

NEEDS = {  # words of a part's message -> a method of the environments that it accepts
    "needs an analytic environment": "dynamics",
    "needs an environment with an equilibrium": "equilibrium",
    "needs an environment with a known reward": "reward_of",
    "needs an environment with a reference": "reference",
}
MODES = ("full", "policy", "planner")
PRECISIONS = ("highest", "high", "default")
KINDS = {  # type of a part's field -> its name in messages
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    str: "a word",
    tuple: "a list",
    NoneType: "null",
}


@dataclass(frozen=True)
class Run:
    """A configuration and the parts built from it."""

    config: DictConfig
    agent: Agent
    controllers: dict[str, Controller]  # mode -> controller without exploration

    @property
    def seeds(self) -> tuple[int, ...]:
        """One seed per learner."""
        return tuple(range(self.config.seed, self.config.seed + self.config.num_seeds))


def load(overrides: Sequence[str] = (), config_dir: str | Path | None = None) -> DictConfig:
    """The resolved configuration of `python -m hybrid_rl.train OVERRIDES`.

    config_dir: a folder with configuration groups of the user, as for `--config-dir`.

    Raises:
        hydra.errors.HydraException: if an override fits nothing in conf/.
        UsageError: if one names a key that does not exist or that the method does not use.
    """
    if not GlobalHydra.instance().is_initialized():
        with initialize_config_dir(str(CONF), version_base="1.3"):
            return load(overrides, config_dir)
    more = [] if config_dir is None else [search_path(config_dir)]
    refuse_new_keys(overrides, more)
    composed = compose("train", [*more, *overrides])
    refuse_unused([composed], overrides, READ)
    return resolved(composed)


def resolved(config: DictConfig) -> DictConfig:
    """A copy with every interpolation replaced by its value.

    Single values at the root that no section of the run refers to are left out.
    """
    read = reached(plain(config), READ)
    values: Any = OmegaConf.to_container(config, resolve=True)
    used = {key: value for key, value in values.items() if key in read or isinstance(value, dict)}
    made: Any = OmegaConf.create(used)
    OmegaConf.set_struct(made, True)
    return made


def build(config: DictConfig) -> Run:
    """The parts that `config` names.

    Raises:
        UsageError: if a value is out of range.
    """
    check(config)
    rounds = -(-config.total_steps // config.num_envs)
    whole(config.replay, "capacity", "replay.")
    with _usage(config):
        parts = _on_this_machine(config)
        controllers = {mode: _instantiate(node) for mode, node in parts.controllers.items()}
        replay = _instantiate(parts.replay)
        longest = (rounds + replay.num_demonstrated(config.num_envs)) * config.num_envs
        agent = Agent(
            Episode(_instantiate(parts.env), config.episode.steps, config.episode.action_repeat),
            controllers["full"],
            {name: _instantiate(node) for name, node in parts.learners.items() if node},
            replace(
                replay, capacity=min(replay.capacity, max(longest, replay.num_demonstrated(1)))
            ),
            config.num_envs,
            config.random_steps,
            config.pretrain,
        )
        agent.check(rounds * config.num_envs)
    return Run(config, agent, {mode: c.greedy() for mode, c in controllers.items()})


def expert(config: DictConfig) -> Controller:
    """The scripted expert of the task.

    Raises:
        UsageError: if it has none.
    """
    if config.get("expert") is None:
        raise UsageError(
            f"task={config.task}: has no scripted expert; give expert=babble or run=DIR"
        )
    with _usage(config):
        return _instantiate(config.expert)


def physics(config: DictConfig) -> str | None:
    """The physics of the world, with `auto` resolved; None if the world has no such field."""
    value = config.env.get("physics")
    if not isinstance(value, str):
        return None
    return resolve(value, config.num_seeds * config.num_envs)


def _on_this_machine(config: DictConfig) -> DictConfig:
    """The sections, in which every copy of the world has its physics resolved."""
    parts: Any = OmegaConf.masked_copy(config, list(SECTIONS))
    name = physics(config)

    def visit(node: Any) -> None:
        for key, value in node.items() if isinstance(node, DictConfig) else enumerate(node):
            if key == "physics" and value == config.env.physics:
                node[key] = name
            elif isinstance(value, (DictConfig, ListConfig)):
                visit(value)

    if name is not None:
        visit(parts)
    return parts


def _instantiate(node: Any) -> Any:
    return instantiate(node, _convert_="all")


@contextmanager
def _usage(config: DictConfig) -> Iterator[None]:
    """Turn a ValueError that a part raises about its fields into a UsageError."""
    try:
        yield
    except (InstantiationException, ValueError) as error:
        cause = error.__cause__ if isinstance(error, InstantiationException) else error
        if not isinstance(cause, (ValueError, TypeError)):
            raise
        line = str(cause)
        for needs, method in NEEDS.items():
            if needs in line:
                names = ", ".join(tasks_with(method))
                line = f"task={config.task}: {config.algo} {needs}; choose one of {names}"
        field = line.partition("=")[0]  # a field of the world is typed as env.FIELD
        raise UsageError(f"env.{line}" if _of_world(config, field) else line) from error


def _of_world(config: DictConfig, field: str) -> bool:
    return field in config.env and field not in config


def tasks_with(method: str, conf: Path = CONF) -> list[str]:
    """Tasks whose environment has this method: `dynamics` if it is analytic, `equilibrium`."""
    names = []
    for path in sorted((conf / "task").glob("*.yaml")):
        task: Any = OmegaConf.load(path)
        with suppress(ImportError, KeyError, AttributeError):  # an unfinished task of the user
            names += [path.stem] if hasattr(part_class(task.env._target_), method) else []
    return names


def check(config: DictConfig) -> None:
    """Raise UsageError for a value that no run accepts; parts check their own ranges."""
    for key in SECTIONS:
        if not isinstance(config.get(key), DictConfig):
            raise UsageError(f"{key}={config.get(key)}: must be a group of keys; {SHOW}")
    for key in COUNTS:
        whole(config, key)
    if type(config.seed) is not int or config.seed < 0:
        raise UsageError(f"seed={config.seed}: must be a whole number, 0 or more")
    if config.seed + config.num_seeds > SEEDS:
        raise UsageError(
            f"seed={config.seed}: must be at most {SEEDS - config.num_seeds} with "
            f"num_seeds={config.num_seeds}: JAX takes seeds of 32 bits"
        )
    modes = config.eval_modes
    if not isinstance(modes, ListConfig) or not set(modes) <= set(MODES):
        raise UsageError(f"eval_modes={modes}: must be a list of {', '.join(MODES)}")
    for key in ("checkpoint_replay", "distributed"):
        if type(config.get(key, False)) is not bool:
            raise UsageError(f"{key}={config[key]}: must be true or false")
    for key, known in (("matmul_precision", PRECISIONS), ("physics", IMPLEMENTATIONS)):
        if config[key] not in known:
            raise UsageError(f"{key}={config[key]}: choose one of {', '.join(known)}")
    _check_kinds(OmegaConf.create({"env": config.env}))  # first, as other parts hold copies of it
    _check_kinds(config)


def _check_kinds(node: DictConfig, where: str = "") -> None:
    """Raise UsageError for a value in `node` that the field of its part cannot hold."""
    kinds = _kinds(node, where)
    for key, value in node.items():
        each = value if isinstance(value, ListConfig) else [value]
        if any(isinstance(item, float) and not math.isfinite(item) for item in each):
            raise UsageError(f"{where}{key}={value}: must be finite")
        if isinstance(value, DictConfig):
            _check_kinds(value, f"{where}{key}.")
            continue
        kind = tuple if isinstance(value, ListConfig) else type(value)
        wanted = kinds.get(str(key), {kind})
        if kind not in wanted and not (kind is int and float in wanted):
            called = " or ".join(KINDS[each] for each in KINDS if each in wanted)
            raise UsageError(f"{where}{key}={value}: must be {called}")


def part_class(target: str) -> Any:
    """The object that a `_target_` names; Hydra's own log lines are suppressed."""
    logging.getLogger("hydra").addHandler(logging.NullHandler())
    return get_object(target)


def _kinds(node: DictConfig, where: str) -> dict[str, set[type]]:
    """Field -> the types that it accepts, for those fields of a part whose types are in KINDS."""
    if "_target_" not in node:
        return {}
    try:
        part = part_class(node._target_)
    except (ImportError, ValueError) as error:
        hint = "is its folder on PYTHONPATH?"
        line = f"{where}_target_={node._target_}: cannot be imported ({error.__cause__ or error})"
        raise UsageError(f"{line}; {hint}") from error
    kinds = {}
    for field in fields(part) if is_dataclass(part) else ():
        several = get_origin(field.type) in (Union, UnionType)
        each = get_args(field.type) if several else (field.type,)
        wanted = {get_origin(kind) or kind for kind in each}
        if wanted <= set(KINDS):
            kinds[field.name] = wanted
    return kinds


def whole(config: Any, key: str, where: str = "") -> int:
    """The value at `key`, a whole number, 1 or more.

    Raises:
        UsageError: if it is anything else.
    """
    value = config[key]
    if not isinstance(value, int) or isinstance(value, bool) or value < 1:
        raise UsageError(f"{where}{key}={value}: must be a whole number, 1 or more")
    return value
