"""Make parts of overrides: compose conf/, check it, build a run."""

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Any

from hydra import compose, initialize_config_dir
from hydra.core.global_hydra import GlobalHydra
from omegaconf import DictConfig, ListConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from hybrid_rl.envs.adapters.external import External, check_world
from hybrid_rl.envs.adapters.robot import PENDING, Robot
from hybrid_rl.envs.mujoco.physics import resolve as resolve_physics
from hybrid_rl.errors import PartError, UsageError
from hybrid_rl.fields import FieldError
from hybrid_rl.files.targets import build as build_part
from hybrid_rl.protocols import Controller
from hybrid_rl.settings.complete import complete, require
from hybrid_rl.settings.compose import (
    UNCOMPOSED,
    adopt_planner,
    complete_names,
    explain,
    settings_keys,
    typed_keys,
)
from hybrid_rl.settings.groups import CONF, groups, register, search_path
from hybrid_rl.settings.values import (
    COUNTS,
    PAID,
    SECTIONS,
    check,
    set_schedules,
    shortened,
    time_limit,
)
from hybrid_rl.settings.words import forced, listed, name, plain, typed_values
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.history import acting as acting_in

READ = (  # the keys that a run reads, and with them all keys that they refer to
    *(*COUNTS, *SECTIONS, *PAID, "expert", "task", "algo", "seed", "random_steps", "pretrain"),
    *("physics", "run_dir", "resume", "eval_modes", "checkpoint_replay", "compile_cache"),
    *("precision", "logger", "run", "freeze"),
)
register()  # before Hydra composes anything
OmegaConf.register_new_resolver("ratio", lambda a, b: a / b, replace=True)  # ${ratio:A,B}
OmegaConf.register_new_resolver("pick", lambda key, of: of[key], replace=True)  # ${pick:A,{A: 1}}
SENSED = "hybrid_rl.training.wrappers.Sensed"
COMPOSING = Lock()  # Hydra composes in one thread at a time


@dataclass(frozen=True)
class Run:
    """A configuration and the parts built from it."""

    config: DictConfig
    agent: Agent
    controllers: dict[str, Controller]  # mode -> controller without exploration
    notes: tuple[str, ...] = ()  # lines for the console

    @property
    def seeds(self) -> tuple[int, ...]:
        """One seed per learner."""
        return tuple(range(self.config.seed, self.config.seed + self.config.num_seeds))


def load(overrides: Sequence[str] = (), config_dir: str | Path | None = None) -> DictConfig:
    """The resolved configuration of `python -m hybrid_rl.train OVERRIDES`.

    config_dir: a folder with configuration groups of the user, as for `--config-dir`.

    Raises:
        UsageError: if an override fits nothing in conf/, or names a key that does not exist or that
            the method does not use; if the user's own task file is incomplete; for run, sweep.
    """
    config = compose_raw(overrides, config_dir)
    for key in (key for key in ("run", "sweep") if config[key]):
        raise UsageError(f"{key}={config[key]}: only the command and hybrid_rl.train take it")
    return resolve(config, overrides)


def compose_raw(overrides: Sequence[str], config_dir: str | Path | None = None) -> DictConfig:
    """What a run of these overrides reads, with its references; errors as `load`."""
    words = forced(listed(overrides), groups(config_dir))
    if config_dir is not None:
        own = search_path(config_dir)
        others = [text for text in words if name(text) == "hydra.searchpath"]
        paths = ",".join(text.partition("=[")[2].rstrip("]") for text in (own, *others))
        words = [f"hydra.searchpath=[{paths}]", *(text for text in words if text not in others)]
    config = composed("train", words, return_hydra_config=True)
    return read(config, config.hydra)


def composed(name: str, words: list[str], **options: Any) -> DictConfig:
    """What Hydra composes from conf/NAME.yaml and overrides; an error is one line."""
    try:
        with COMPOSING:
            known = GlobalHydra.instance().is_initialized()
            with nullcontext() if known else initialize_config_dir(str(CONF), version_base="1.3"):
                return compose(name, words, **options)
    except UNCOMPOSED as error:
        raise UsageError(explain(error)) from error


def read(config: DictConfig, hydra: DictConfig) -> DictConfig:
    """What a run reads: its sections and all that they refer to, parts complete.

    config: as Hydra composed it; hydra: Hydra's own part. UsageError for a typed key that it lacks.
    """
    config = config.copy()
    OmegaConf.set_struct(config, False)  # it gets keys
    complete_names(config, hydra)
    adopt_planner(config, hydra)
    raw = plain(config)
    raw.pop("hydra", None)
    typed = typed_keys(hydra) if raw["resume"] is None else []
    # a part that lacks a key of `settings` keeps what it has
    raw = complete(raw, (*READ, "sweep"), [*typed, *settings_keys(hydra)])
    for path in typed:
        require(raw, path, hydra.runtime.choices.get(path))
    sources = (each.path for each in hydra.runtime.config_sources if each.schema == "file")
    raw["config_dir"] = next((path for path in sources if Path(path) != CONF), None)  # the user's
    return OmegaConf.create(raw, flags={"struct": True})


def resolve(config: DictConfig, overrides: Sequence[str]) -> DictConfig:
    """A copy with every reference replaced by its value, composed from the overrides.

    config: as `compose_raw` gives it.
    """
    try:
        values: dict[str, Any] = plain(config, resolve=True)
    except OmegaConfBaseException as error:
        lacks = re.findall("key '(?:model_)?(.*)' not", str(error))  # model_objective: an objective
        asks = [text for text in overrides if name(text) == str(error.full_key).split(".")[0]]
        lines = [f"{text}: {config.algo} has no {key}" for text in asks for key in lacks]
        raise UsageError([explain(error), *lines][-1]) from error
    for helper in ("sweep", "policy_learning", "many_envs"):
        values.pop(helper, None)
    words = (text for text in overrides if not re.match(r"\+*(sweep|hydra)\.|-", text))
    values["recipe"] = [re.sub(r"\$\{([^}]*)\}", r"$(\1)", text) for text in words]  # no references
    values = shortened(values, typed_values(overrides))
    if values["task"] in ("gymnasium", "playground", "robot"):  # of many environments
        names = (values["env"].get(key) for key in ("make", "id", "name"))
        values["task"] = re.sub(r"[^A-Za-z0-9_.-]", "_", str(next(filter(None, names), "_")))
    return OmegaConf.create(values, flags={"struct": True})


def build(config: DictConfig) -> Run:
    """The parts that `config` names, with room in the memory for what another run gave."""
    check(config)
    rounds = -(-config.total_steps // config.num_envs)
    remembered = config.get("begun", {}).get("remembered", 0)  # decisions of each environment
    episode, controllers = acting(config)
    with _usage(config) as parts:
        set_schedules(parts.learners, config.total_steps)
        agent = Agent(
            episode,
            controllers["full"],
            {k: _instantiate(v, f"learners.{k}") for k, v in parts.learners.items() if v},
            _instantiate(parts.replay, "replay").within(rounds + remembered, config.num_envs),
            config.num_envs,
            config.random_steps,
            config.pretrain,
            -remembered * config.num_envs,
            tuple(config.get("freeze", ())),
        )
        agent.check(controllers.values())
    return Run(config, agent, {mode: c.greedy() for mode, c in controllers.items()})


def acting(config: DictConfig) -> tuple[Episode, dict[str, Controller]]:
    """The episodes of `config`, and its controllers as they act in training."""
    episode = episodes(config)  # first, as controllers may hold their reward, too
    with _usage(config) as parts:
        each = ((k, _instantiate(v, f"controllers.{k}")) for k, v in parts.controllers.items())
        return acting_in(episode, dict(each), PENDING * isinstance(episode.env, Robot))


def episodes(config: DictConfig) -> Episode:
    """The episodes of `config`, without its method."""
    with _usage(config) as parts:
        env = _instantiate(parts.env, "env")
        check_world(env)
        target = {"_target_": "hybrid_rl.training.episode.Episode", "env": env}
        given = target | _instantiate(parts.episode, "episode")
        given |= {name: _instantiate(parts.get(name) or None, name) for name in PAID}
        if isinstance(env, External | Robot):
            given |= time_limit(env, given)
        return build_part(given, where="episode")


def expert(config: DictConfig) -> Controller:
    """The scripted expert of the task."""
    if config.get("expert") is None:
        line = "has no scripted expert; give expert=babble or run=DIR"
        raise UsageError(f"task={config.task}: {line}")
    with _usage(config, "its expert"):
        return _instantiate(config.expert, "expert")


def physics(config: DictConfig) -> str | None:
    """The physics of the world, with `auto` resolved; None if the world has no such field."""
    value = config.env.get("physics")
    if not isinstance(value, str):
        return None
    return resolve_physics(value, config.num_seeds * config.num_envs)


def _on_this_machine(config: DictConfig) -> DictConfig:
    """The sections, in which every copy of the world has its physics resolved.

    Parts that read observations get a world of what is observed, which lacks what needs all of it.
    """
    sections = [key for key in (*SECTIONS, *PAID) if key in config]
    parts = OmegaConf.masked_copy(config, sections)
    chosen, observe = physics(config), config.episode.get("observe")

    def replace(node: Any, new: Callable[[Any, Any], Any]) -> None:
        """Put new(key, value), unless it is None, in place of every value at or below a node."""
        for key, value in node.items() if isinstance(node, DictConfig) else enumerate(node):
            if (made := new(key, value)) is not None:
                node[key] = made
            elif isinstance(value, (DictConfig, ListConfig)):
                replace(value, new)

    if chosen is not None:
        own = config.env.physics
        replace(parts, lambda key, value: chosen if key == "physics" and value == own else None)
    if observe is not None:
        seen = {"_target_": SENSED, "env": parts.env, "observe": observe}
        for name in ("controllers", "learners"):  # an Episode observes by itself
            node = parts.get(name) or {}
            replace(node, lambda key, value: seen if key != "env" and value == parts.env else None)
    return parts


def _instantiate(node: Any, where: str) -> Any:
    """The part at the key `where`."""
    values = plain(node, resolve=True) if OmegaConf.is_config(node) else node
    return build_part(values, where=where)


@contextmanager
def _usage(config: DictConfig, who: str | None = None) -> Iterator[DictConfig]:
    """The sections on this machine; what a part says of its fields, a ValueError, is a UsageError.

    who: what needs a kind of environment that the task is not; None: the method.
    """
    try:
        yield _on_this_machine(config)
    except PartError:  # names its file
        raise
    except FieldError as error:
        part, _, field = error.path.rpartition(".")
        node: Any = OmegaConf.select(config, part) if part else None
        if isinstance(node, DictConfig):  # policy_learner for learners.policy
            short = next((name for name, other in config.items() if other == node), part)
            error.path = f"{short}.{field}"
        line, method = error.line, config.get("algo") or "this"
        if error.lacks == "learner":
            chosen = [text for text in config.get("recipe", ()) if name(text) in ("planner", field)]
            line = f"{chosen[-1]}: {method} learns no {field}" if chosen else line
        elif field == "world" and error.lacks:
            who = part if part in PAID else who or method
            line = f"task={config.task}: {who} {error.must}; `python -m hybrid_rl.list` marks those"
        raise UsageError(line) from error
    except ValueError as error:
        raise UsageError(str(error)) from error
