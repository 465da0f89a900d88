"""Values of a configuration that no part checks itself: counts, choices, types of fields."""

import math
from collections.abc import Collection, Mapping
from numbers import Integral
from typing import Any

from omegaconf import DictConfig

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.envs.adapters.unstepped import Unstepped
from hybrid_rl.envs.mujoco.physics import IMPLEMENTATIONS
from hybrid_rl.errors import UsageError, printable
from hybrid_rl.fields import as_yaml
from hybrid_rl.files import targets as parts
from hybrid_rl.networks.precision import PRECISIONS
from hybrid_rl.settings.groups import MODES
from hybrid_rl.settings.words import plain
from hybrid_rl.types import NAME

COUNTS = (
    *("num_seeds", "num_envs", "total_steps", "eval_every", "eval_episodes"),
    *("checkpoint_every", "log_every"),
)
SECTIONS = ("env", "episode", "replay", "controllers", "learners")
PAID = ("reward", "constraint")  # what the world pays and asks for; a run may lack the keys
KNOWN = {"precision": PRECISIONS, "physics": IMPLEMENTATIONS, "logger": (None, "wandb")}
TRUE_MODEL = "hybrid_rl.models.world.World"
STEPS = 2**31  # decisions, fewer of which are counted
SEEDS = 2**32  # distinct seeds of JAX's generator


def check(config: DictConfig) -> None:
    """Raise UsageError for a value that no run accepts; parts check their own ranges."""
    for key in SECTIONS:
        if not isinstance(config[key], DictConfig):
            hint = f"; did you mean task={config[key]}?" if key == "env" else ""
            raise UsageError(f"{key}={as_yaml(config[key])}: must be a group of keys{hint}")
    values = plain(config)
    parts.check(values)
    for key in ("task", "algo"):  # which become folders, or overrides
        if not NAME.fullmatch(str(config.get(key))):
            raise UsageError(f"{key}={printable(config[key])}: must be letters, digits, _, . and -")
    plans = TRUE_MODEL in {name for _, name in parts.targets(values)}
    if plans and issubclass(parts.part_class(config.env._target_), Unstepped):
        line = "plans on the true dynamics, and this task steps outside JAX; take one that learns"
        raise UsageError(f"task={config.task}: {config.algo} {line}")
    for key in COUNTS:
        whole(key, config[key])
    whole("replay.capacity", config.replay.capacity)
    whole("num_envs", config.num_envs, 1, STEPS - 1)
    whole("total_steps", config.total_steps, 1, STEPS - config.num_envs)  # with the last round
    whole("seed", config.seed, 0, SEEDS - config.num_seeds)
    for mode in [None] if config.eval_modes is None else config.eval_modes:
        one_of("eval_modes", mode, MODES)
    for key, known in KNOWN.items():
        one_of(key, config[key], known)


def time_limit(env: External | Robot, given: Mapping[str, Any]) -> dict[str, int]:
    """The time limit of an environment on the host [decisions], if `given` has none."""
    own = ("lag", *PAID) if isinstance(env, Robot) else ()
    noise = "sensor_noise", "action_noise"
    for key in ("delay", "jitter", "loss", *own, *noise, "observe", "randomise"):
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


def shortened(values: Mapping[str, Any], given: Mapping[str, str]) -> dict[str, Any]:
    """`values`; a run that overrides `given` shorten is half random, and evaluated ten times."""
    found, total = dict(values), values["total_steps"]
    named = {"random_steps" if key == "model_random_steps" else key for key in given}
    if "total_steps" in named and type(total) is int:
        for key, parts in {"random_steps": 2, "eval_every": 10}.items():
            if key not in named and type(found[key]) is int:
                found[key] = min(found[key], -(-total // parts))
    return found


def set_schedules(learners: DictConfig, decisions: int) -> None:
    """Give schedules that lack one the run's length."""
    for learner in filter(None, learners.values()):
        schedule = learner.get("schedule")
        if schedule is not None and schedule.get("decisions", decisions) is None:
            schedule.decisions = decisions


def whole(key: str, value: Any, least: int = 1, most: int | None = None) -> int:
    """The value at `key`, a whole number, which may be one of NumPy's."""
    number = isinstance(value, Integral) and not isinstance(value, bool)
    if not number or not least <= int(value) <= (math.inf if most is None else most):
        limits = f"{least} or more" if most is None else f"from {least} to {most}"
        raise UsageError(f"{key}={as_yaml(value)}: must be a whole number, {limits}")
    return int(value)


def one_of(key: str, value: Any, known: Collection[Any]) -> Any:
    """The value at `key`."""
    if type(value) not in map(type, known) or value not in known:
        words = ", ".join(str(as_yaml(word)) for word in known)
        raise UsageError(f"{key}={as_yaml(value)}: choose one of {words}")
    return value
