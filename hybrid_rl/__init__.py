"""hybrid_rl: learned models and policies meet optimal control, in JAX and MuJoCo.

Begin with a task and a method by name, as on the command line (`python -m hybrid_rl.list`):

    import hybrid_rl as hr

    result = hr.train(["task=pendulum", "algo=sac", "num_seeds=2"], on_row=print)
    policy = result.load().policy(seed=0)  # action = policy(obs)
    (curve,) = hr.curves(result.folder, "eval/return")  # curve.x [G], curve.each [S, G]

Public are the names in `__all__`: `train`, `evaluate`, `load`, `curves`, `metrics`, `make` and
`compose` by name; `Agent`, `Episode`, `Loop`, `EnvState`, `Spec` and `check` for methods and worlds
of your own; `OnlineLearner` for a loop of your own, such as a robot's; the planning cores
`sampling` and `adjoint`, whose `plan` takes any `step(x, u)`; and two errors. Parts are in their
modules, such as `hybrid_rl.learners.sac.SAC`. What is public changes only with a line in the
changelog; the rest may change without one. docs/python.md has an example of each.

Importing this package imports neither JAX nor MuJoCo: each name is imported at its first use.
"""

import os
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hybrid_rl.analysis.curves import curves
    from hybrid_rl.analysis.dataframes import metrics
    from hybrid_rl.config import load as compose
    from hybrid_rl.core import adjoint, sampling
    from hybrid_rl.envs.contract import check
    from hybrid_rl.errors import DivergenceError, UsageError
    from hybrid_rl.evaluate import evaluate
    from hybrid_rl.named import load, make
    from hybrid_rl.online import OnlineLearner
    from hybrid_rl.train import train
    from hybrid_rl.training.agent import Agent
    from hybrid_rl.training.episode import Episode
    from hybrid_rl.training.loop import Loop
    from hybrid_rl.types import EnvState, Spec

__version__ = "0.3.0.dev0"

__all__ = [
    "Agent",
    "DivergenceError",
    "EnvState",
    "Episode",
    "Loop",
    "OnlineLearner",
    "Spec",
    "UsageError",
    "adjoint",
    "check",
    "compose",
    "curves",
    "evaluate",
    "load",
    "make",
    "metrics",
    "sampling",
    "train",
]

_MODULES = {  # train and evaluate can be called
    "adjoint": "core.adjoint",
    "evaluate": "evaluate",
    "sampling": "core.sampling",
    "train": "train",
}
_MEMBERS = {  # public name -> module and name there
    "Agent": ("training.agent", "Agent"),
    "DivergenceError": ("errors", "DivergenceError"),
    "EnvState": ("types", "EnvState"),
    "Episode": ("training.episode", "Episode"),
    "Loop": ("training.loop", "Loop"),
    "OnlineLearner": ("online", "OnlineLearner"),
    "Spec": ("types", "Spec"),
    "UsageError": ("errors", "UsageError"),
    "check": ("envs.contract", "check"),
    "compose": ("config", "load"),
    "curves": ("analysis.curves", "curves"),
    "load": ("named", "load"),
    "make": ("named", "make"),
    "metrics": ("analysis.dataframes", "metrics"),
}


def __getattr__(name: str) -> Any:
    """A public name, imported when it is first used."""
    if name in _MODULES:
        return import_module(f"hybrid_rl.{_MODULES[name]}")
    if name in _MEMBERS:
        module, member = _MEMBERS[name]
        return getattr(import_module(f"hybrid_rl.{module}"), member)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """The public names."""
    return [*__all__, "__version__"]


# OpenBLAS, which factorises JAX's matrices on a CPU, reads this when it is loaded. Many small
# matrices are factorised at once, and its threads wait for one another: up to 30 times slower.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# In a checkout `envs/` stands beside this package; in a wheel it is inside it.
if not os.path.isdir(os.path.join(os.path.dirname(__file__), "envs")):
    __path__ = [*__path__, os.path.dirname(os.path.dirname(__file__))]
