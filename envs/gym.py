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

TASKS = Path(__file__).parents[1] / "conf" / "task"
ADAPTER = "hybrid_rl.envs.adapters.gymnasium"


@cache
def limits() -> dict[str, int]:
    """The time limit of each task by the full name of its environment's class.

    It counts steps of the environment, of which a decision of a task may be several. Of tasks that
    write out `env` and `episode`, as those of this package do.
    """
    found = {}
    for file in sorted(TASKS.glob("*.yaml")):
        match yaml.safe_load(file.read_text("utf-8")):
            case {
                "env": {"_target_": str(target)},
                "episode": {"steps": int(steps), "action_repeat": int(repeat)},
            } if steps and ".adapters." not in target:
                found[target] = steps * repeat
    return found


def time_limit(env: Any) -> int:
    """The time limit of `env` in its steps, if it belongs to a task of this package."""
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
