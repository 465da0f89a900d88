"""hybrid_rl: learned models and policies meet optimal control, in JAX and MuJoCo.

Begin with a task and a method by name, as on the command line (`python -m hybrid_rl.list`):

    import hybrid_rl as hr

    result = hr.train(["task=pendulum", "algo=sac", "num_seeds=2"], on_row=print)
    policy = result.load().policy(seed=0)  # action = policy(obs)
    (curve,) = hr.curves(result.folder, "eval/return")  # curve.x [G], curve.each [S, G]

Public are the names in `__all__` and the classes that YAML files of conf/ name by `_target_`, the
parts, such as `hybrid_rl.learners.sac.SAC`. What is public changes only with a line in the
changelog; the rest may change without one. docs/python.md lists both, with examples.

Importing this package imports neither JAX nor MuJoCo: each name is imported at its first use.
"""

import os
from importlib import import_module
from typing import TYPE_CHECKING, Any

from hybrid_rl.version import __version__ as __version__

if TYPE_CHECKING:
    from hybrid_rl import fields, protocols, types
    from hybrid_rl.analysis import style
    from hybrid_rl.analysis.curves import Curve, curves
    from hybrid_rl.analysis.tables import metrics
    from hybrid_rl.api import load, make
    from hybrid_rl.cli import arguments, command
    from hybrid_rl.core import (
        adjoint,
        fisher,
        least_squares,
        lifting,
        riccati,
        sampling,
        statistics,
    )
    from hybrid_rl.envs.analytic.state import fully_observed
    from hybrid_rl.envs.mujoco.body import Body
    from hybrid_rl.envs.mujoco.physics import Physics
    from hybrid_rl.envs.trial import check
    from hybrid_rl.errors import CheckpointError, DivergenceError, UsageError
    from hybrid_rl.evaluate import evaluate
    from hybrid_rl.fields import part
    from hybrid_rl.run.online import OnlineLearner
    from hybrid_rl.run.retarget import retargeted
    from hybrid_rl.run.saved import Trained
    from hybrid_rl.settings.build import load as compose
    from hybrid_rl.train import train
    from hybrid_rl.training.agent import Agent
    from hybrid_rl.training.episode import Episode
    from hybrid_rl.training.loop import Loop
    from hybrid_rl.types import EnvState, Spec

__all__ = [
    "Agent",
    "Body",
    "CheckpointError",
    "Curve",
    "DivergenceError",
    "EnvState",
    "Episode",
    "Loop",
    "OnlineLearner",
    "Physics",
    "Spec",
    "Trained",
    "UsageError",
    "adjoint",
    "arguments",
    "check",
    "command",
    "compose",
    "curves",
    "evaluate",
    "fields",
    "fisher",
    "fully_observed",
    "least_squares",
    "lifting",
    "load",
    "make",
    "metrics",
    "part",
    "protocols",
    "retargeted",
    "riccati",
    "sampling",
    "statistics",
    "style",
    "train",
    "types",
]

_PUBLIC = {  # name -> its module, or MODULE:NAME; train and evaluate can be called
    "Agent": "training.agent:Agent",
    "Body": "envs.mujoco.body:Body",
    "CheckpointError": "errors:CheckpointError",
    "Curve": "analysis.curves:Curve",
    "DivergenceError": "errors:DivergenceError",
    "EnvState": "types:EnvState",
    "Episode": "training.episode:Episode",
    "Loop": "training.loop:Loop",
    "OnlineLearner": "run.online:OnlineLearner",
    "Physics": "envs.mujoco.physics:Physics",
    "Spec": "types:Spec",
    "Trained": "run.saved:Trained",
    "UsageError": "errors:UsageError",
    "adjoint": "core.adjoint",
    "arguments": "cli.arguments",
    "check": "envs.trial:check",
    "command": "cli.command",
    "compose": "settings.build:load",
    "curves": "analysis.curves:curves",
    "evaluate": "evaluate",
    "fields": "fields",
    "fisher": "core.fisher",
    "fully_observed": "envs.analytic.state:fully_observed",
    "least_squares": "core.least_squares",
    "lifting": "core.lifting",
    "load": "api:load",
    "make": "api:make",
    "metrics": "analysis.tables:metrics",
    "part": "fields:part",
    "protocols": "protocols",
    "retargeted": "run.retarget:retargeted",
    "riccati": "core.riccati",
    "sampling": "core.sampling",
    "statistics": "core.statistics",
    "style": "analysis.style",
    "train": "train",
    "types": "types",
}


def __getattr__(name: str) -> Any:
    """A public name, imported when it is first used."""
    if name not in _PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, _, member = _PUBLIC[name].partition(":")
    found = import_module(f"hybrid_rl.{module}")
    return getattr(found, member) if member else found


def __dir__() -> list[str]:
    """The public names."""
    return [*__all__, "__version__"]


# OpenBLAS, which factorises JAX's matrices on a CPU, reads this when it is loaded. Many small
# matrices are factorised at once, and its threads wait for one another: up to 30 times slower.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# `python -m hybrid_rl.view` is tools/view. In a checkout `envs/` stands beside this package; in a
# wheel it is inside it.
_HERE = os.path.dirname(__file__)
__path__ = [*__path__, os.path.join(_HERE, "tools")]
if not os.path.isdir(os.path.join(_HERE, "envs")):
    __path__ = [*__path__, os.path.dirname(_HERE)]
