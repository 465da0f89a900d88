"""The tasks in Gymnasium's registry, and their time limits.

    import gymnasium
    import hybrid_rl.envs.gym  # registers the ids

    env = gymnasium.make("hybrid_rl/HalfCheetah")
    envs = gymnasium.make_vec("hybrid_rl/HalfCheetah", num_envs=64)

An id is the class of a task's environment, and the environment's fields are keywords:
`gymnasium.make("hybrid_rl/Ant", reward="gymnasium")`. Ids have no version: the package has one.

Gymnasium loads no plug-ins since its version 1.0, so this module has to be imported. Where only
an id can be given, "hybrid_rl.envs.gym:hybrid_rl/HalfCheetah" imports it. The import reads
conf/task, and leaves JAX alone until an environment is made.

Source: Gymnasium's documentation, "Make and register".
"""

from functools import cache
from pathlib import Path
from typing import Any

import gymnasium
import yaml

from hybrid_rl.errors import UsageError

TASKS = Path(__file__).parents[1] / "conf" / "task"
ADAPTER = "hybrid_rl.envs.adapters.gymnasium"


@cache
def limits() -> dict[str, int]:
    """The time limit of each task by the full name of its environment's class.

    It counts steps of the environment, of which a decision of a task may be several. Of tasks with
    one environment that counts which is written out, without `defaults`.

    Raises:
        UsageError: for a task without an environment or the length of an episode, its own or of
            `defaults` that exist.
    """
    found = {}
    files = sorted(TASKS.glob("*.yaml"), key=lambda file: ("defaults" not in _read(file), file))
    for file in files:
        task = _composed(file)
        try:
            target, episode = task["env"]["_target_"], task["episode"]
            steps, repeat = episode["steps"], episode["action_repeat"]
        except KeyError as error:
            raise UsageError(
                f"{file}: has no {error.args[0]}; a task needs env._target_, episode.steps and "
                "episode.action_repeat, its own or by defaults: [/task@_global_: NAME, _self_]"
            ) from None
        if steps and ".adapters." not in target:
            found[target] = steps * repeat
    return found


def _read(file: Path) -> dict[str, Any]:
    return yaml.safe_load(file.read_text("utf-8")) or {}


def _composed(file: Path) -> dict[str, Any]:
    """The keys of a task with those of the tasks in its `defaults`, as Hydra composes them."""
    own, made = _read(file), {}
    names = own.pop("defaults", [])
    for name in names if "_self_" in names else [*names, "_self_"]:
        if name == "_self_":
            made = _merged(made, own)
        elif (other := _task(name)) is not None:
            if not (base := file.with_stem(other)).exists():
                raise UsageError(f"{file}: there is no {base.name} beside it")
            made = _merged(made, _composed(base))
    return made


def _task(name: Any) -> str | None:
    """The task that an entry of `defaults` names: NAME, /task: NAME or /task@_global_: NAME."""
    if not isinstance(name, dict):
        return str(name)
    group, other = next(iter(name.items()))
    return other if group.partition("@")[0] == "/task" else None


def _merged(old: Any, new: Any) -> Any:
    """`new` where it has a value, else `old`; key by key."""
    if not (isinstance(old, dict) and isinstance(new, dict)):
        return new
    return old | {key: _merged(old.get(key), value) for key, value in new.items()}


def time_limit(env: Any) -> int:
    """The time limit of `env` in its steps, if it belongs to a task of this package.

    Raises:
        ValueError: for an environment of another package.
    """
    kind = type(env)
    try:
        return limits()[f"{kind.__module__}.{kind.__qualname__}"]
    except KeyError:
        raise ValueError(
            f"steps: {kind.__name__} has no time limit of its own; give steps=N, its decisions "
            "until an episode is truncated, or steps=0 for episodes that no limit ends"
        ) from None


def _register() -> None:
    for target, steps in limits().items():
        gymnasium.register(
            f"hybrid_rl/{target.rsplit('.', 1)[1]}",
            entry_point=f"{ADAPTER}:make",
            vector_entry_point=f"{ADAPTER}:make_vec",
            max_episode_steps=steps,
            kwargs={"world": target},
        )


_register()
