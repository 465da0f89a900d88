"""From overrides to parts: composes conf/, checks it, builds a run."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hydra import compose, initialize_config_dir
from hydra.core.global_hydra import GlobalHydra
from hydra.errors import InstantiationException
from hydra.utils import instantiate
from omegaconf import DictConfig, OmegaConf

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

MODES = ("full", "policy", "planner")


class UsageError(ValueError):
    """What the user asked for makes no run; the message is one line that says what would."""


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


def load(overrides: Sequence[str] = ()) -> DictConfig:
    """The resolved configuration of `python -m hybrid_rl.train OVERRIDES`.

    Raises:
        hydra.errors.HydraException: where an override fits nothing in conf/.
    """
    if GlobalHydra.instance().is_initialized():
        return resolved(compose("train", list(overrides)))
    with initialize_config_dir(str(CONF), version_base="1.3"):
        return resolved(compose("train", list(overrides)))


def resolved(config: DictConfig) -> DictConfig:
    """A copy with every interpolation replaced by its value."""
    config = OmegaConf.create(OmegaConf.to_container(config, resolve=True))
    OmegaConf.set_struct(config, True)
    return config


def build(config: DictConfig) -> Run:
    """The parts that `config` names.

    Raises:
        UsageError: where a value is out of range.
    """
    check(config)
    rounds = -(-config.total_steps // config.num_envs)
    capacity = min(_whole(config.replay, "capacity", "replay."), rounds * config.num_envs)
    with _usage():
        controllers = {mode: _instantiate(node) for mode, node in config.controllers.items()}
        env = _instantiate(config.env)
        agent = Agent(
            Episode(env, config.episode.steps, config.episode.action_repeat),
            controllers["full"],
            {name: _instantiate(node) for name, node in config.learners.items()},
            _instantiate({**config.replay, "capacity": capacity}),
            config.num_envs,
            config.random_steps,
        )
    return Run(config, agent, {mode: c.greedy() for mode, c in controllers.items()})


def _instantiate(node: Any) -> Any:
    return instantiate(node, _convert_="all")


@contextmanager
def _usage() -> Iterator[None]:
    """A part's ValueError about its fields becomes the user's."""
    try:
        yield
    except InstantiationException as error:
        if isinstance(error.__cause__, (ValueError, TypeError)):
            raise UsageError(str(error.__cause__)) from error
        raise
    except ValueError as error:
        raise UsageError(str(error)) from error


def check(config: DictConfig) -> None:
    """Raise UsageError for a count that is not a positive whole number."""
    for key in COUNTS:
        _whole(config, key)
    if not isinstance(config.seed, int) or config.seed < 0:
        raise UsageError(f"seed={config.seed}: must be a whole number, 0 or more")
    for mode in config.eval_modes:
        if mode not in MODES:
            raise UsageError(f"eval_modes={mode}: choose among {', '.join(MODES)}")


def _whole(config: Any, key: str, where: str = "") -> int:
    value = config[key]
    if not isinstance(value, int) or isinstance(value, bool) or value < 1:
        raise UsageError(f"{where}{key}={value}: must be a whole number, 1 or more")
    return value
