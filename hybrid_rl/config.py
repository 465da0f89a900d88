"""From overrides to parts: composes conf/, checks it, builds a run."""

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

from hybrid_rl.envs.mujoco.physics import resolve
from hybrid_rl.errors import UsageError
from hybrid_rl.overrides import SHOW, refuse_new_keys, refuse_unused, search_path
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Controller

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

SEEDS = 2**32  # that JAX's generator tells apart

SECTIONS = ("env", "episode", "replay", "controllers", "learners")
READ = (  # what a run reads, and with it all that these name by interpolation
    *(*COUNTS, *SECTIONS, "expert", "task", "algo", "seed", "random_steps", "pretrain"),
    *("physics", "run_dir", "resume", "eval_modes", "checkpoint_replay", "compile_cache"),
    *("matmul_precision", "distributed"),
)

MODES = ("full", "policy", "planner")
PRECISIONS = ("highest", "high", "default")
KINDS = {  # type of a part's field -> how its values are called
    int: "a whole number",
    float: "a number",
    bool: "true or false",
    str: "a word",
    tuple: "a list",
    NoneType: "null",
}
UNKNOWN = object()  # what OmegaConf selects where there is nothing


@dataclass(frozen=True)
class Run:
    """A configuration made into parts."""

    config: DictConfig
    agent: Agent
    controllers: dict[str, Controller]  # mode -> controller without exploration

    @property
    def seeds(self) -> tuple[int, ...]:
        """Of the learners."""
        return tuple(range(self.config.seed, self.config.seed + self.config.num_seeds))


def load(overrides: Sequence[str] = (), config_dir: str | Path | None = None) -> DictConfig:
    """The resolved configuration of `python -m hybrid_rl.train OVERRIDES`.

    config_dir: a folder with groups of your own, as of `--config-dir`.

    Raises:
        hydra.errors.HydraException: where an override fits nothing in conf/.
        UsageError: where one names a key that does not exist, or that the method does not use.
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
    """A copy with every interpolation replaced by its value."""
    made: Any = OmegaConf.create(OmegaConf.to_container(config, resolve=True))
    OmegaConf.set_struct(made, True)
    return made


def build(config: DictConfig) -> Run:
    """The parts that `config` names.

    Raises:
        UsageError: where a value is out of range.
    """
    check(config)
    rounds = -(-config.total_steps // config.num_envs)
    _whole(config.replay, "capacity", "replay.")
    with _usage(config):
        controllers = {mode: _instantiate(node) for mode, node in config.controllers.items()}
        env = _instantiate({**config.env, **physics(config)})
        replay = _instantiate(config.replay)
        longest = (rounds + replay.num_demonstrated(config.num_envs)) * config.num_envs
        agent = Agent(
            Episode(env, config.episode.steps, config.episode.action_repeat),
            controllers["full"],
            {name: _instantiate(node) for name, node in config.learners.items()},
            replace(
                replay, capacity=min(replay.capacity, max(longest, replay.num_demonstrated(1)))
            ),
            config.num_envs,
            config.random_steps,
            config.pretrain,
        )
    return Run(config, agent, {mode: c.greedy() for mode, c in controllers.items()})


def expert(config: DictConfig) -> Controller:
    """The task's expert that was written by hand.

    Raises:
        UsageError: where it has none.
    """
    if config.expert is None:
        raise UsageError(f"task={config.task}: nobody wrote an expert; give run=DIR, a trained one")
    with _usage(config):
        return _instantiate(config.expert)


def physics(config: DictConfig) -> dict[str, str]:
    """The world's `physics`, where it has any, with what auto means for the worlds of this run."""
    if not isinstance(config.env.get("physics"), str):
        return {}
    return {"physics": resolve(config.env.physics, config.num_seeds * config.num_envs)}


def _instantiate(node: Any) -> Any:
    return instantiate(node, _convert_="all")


@contextmanager
def _usage(config: DictConfig) -> Iterator[None]:
    """A part's ValueError about its fields becomes the user's."""
    try:
        yield
    except (InstantiationException, ValueError) as error:
        cause = error.__cause__ if isinstance(error, InstantiationException) else error
        if not isinstance(cause, (ValueError, TypeError)):
            raise
        line = str(cause)
        if "needs an analytic environment" in line:
            needs = f"task={config.task}: {config.algo} needs an analytic environment"
            line = f"{needs}; choose one of {', '.join(analytic_tasks())}"
        field = line.partition("=")[0]  # of the world, whose keys are typed as env.KEY
        raise UsageError(f"env.{line}" if _of_world(config, field) else line) from error


def _of_world(config: DictConfig, field: str) -> bool:
    return field in config.env and field not in config


def analytic_tasks(conf: Path = CONF) -> list[str]:
    """Tasks whose world is a formula, as the methods with an equilibrium need it."""
    found = []
    for path in sorted((conf / "task").glob("*.yaml")):
        task: Any = OmegaConf.load(path)
        with suppress(ImportError, KeyError, AttributeError):  # one of the user's, unfinished
            found += [path.stem] if hasattr(_class(task.env._target_), "equilibrium") else []
    return found


def check(config: DictConfig) -> None:
    """Raise UsageError for a value that no run can have; parts check their own ranges."""
    for key in SECTIONS:
        if not isinstance(config.get(key), DictConfig):
            raise UsageError(f"{key}={config.get(key)}: must be a group of keys; {SHOW}")
    for key in COUNTS:
        _whole(config, key)
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
    if config.matmul_precision not in PRECISIONS:
        known = ", ".join(PRECISIONS)
        raise UsageError(f"matmul_precision={config.matmul_precision}: choose one of {known}")
    _check_kinds(OmegaConf.create({"env": config.env}))  # first: other parts hold copies of it
    _check_kinds(config)


def _check_kinds(node: DictConfig, where: str = "") -> None:
    """Raise UsageError for a value of a part, here or below, that its field cannot hold."""
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


def _class(target: str) -> Any:
    """What a `_target_` names; Hydra would say in three lines more where there is nothing."""
    logging.getLogger("hydra").addHandler(logging.NullHandler())
    return get_object(target)


def _kinds(node: DictConfig, where: str) -> dict[str, set[type]]:
    """Field -> types it can hold, of the part that `node` names; fields of other types left out."""
    if "_target_" not in node:
        return {}
    try:
        part = _class(node._target_)
    except (ImportError, ValueError) as error:
        hint = "is its folder on PYTHONPATH?"
        line = f"{where}_target_={node._target_}: cannot be imported ({error.__cause__ or error})"
        raise UsageError(f"{line}; {hint}") from error
    found = {}
    for field in fields(part) if is_dataclass(part) else ():
        several = get_origin(field.type) in (Union, UnionType)
        each = get_args(field.type) if several else (field.type,)
        wanted = {get_origin(kind) or kind for kind in each}
        if wanted <= set(KINDS):
            found[field.name] = wanted
    return found


def _whole(config: Any, key: str, where: str = "") -> int:
    value = config[key]
    if not isinstance(value, int) or isinstance(value, bool) or value < 1:
        raise UsageError(f"{where}{key}={value}: must be a whole number, 1 or more")
    return value
