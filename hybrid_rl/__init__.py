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
    from hybrid_rl import fields as fields
    from hybrid_rl import protocols as protocols
    from hybrid_rl import types as types
    from hybrid_rl.analysis import style as style
    from hybrid_rl.analysis.curves import Curve as Curve
    from hybrid_rl.analysis.curves import area as area
    from hybrid_rl.analysis.curves import curves as curves
    from hybrid_rl.analysis.curves import spread as spread
    from hybrid_rl.analysis.curves_picture import plot as plot
    from hybrid_rl.analysis.read_back import decisions as decisions
    from hybrid_rl.analysis.read_back import expert as expert
    from hybrid_rl.analysis.read_back import film as film
    from hybrid_rl.analysis.read_back import names as names
    from hybrid_rl.analysis.read_back import newest as newest
    from hybrid_rl.analysis.read_back import rebuilt as rebuilt
    from hybrid_rl.analysis.read_back import runs as runs
    from hybrid_rl.analysis.results import RunFolder as RunFolder
    from hybrid_rl.analysis.results import differences as differences
    from hybrid_rl.analysis.tables import metrics as metrics
    from hybrid_rl.api import load as load
    from hybrid_rl.api import make as make
    from hybrid_rl.cli import arguments as arguments
    from hybrid_rl.cli import command as command
    from hybrid_rl.core import adjoint as adjoint
    from hybrid_rl.core import fisher as fisher
    from hybrid_rl.core import least_squares as least_squares
    from hybrid_rl.core import lifting as lifting
    from hybrid_rl.core import riccati as riccati
    from hybrid_rl.core import sampling as sampling
    from hybrid_rl.core import statistics as statistics
    from hybrid_rl.envs.analytic.state import fully_observed as fully_observed
    from hybrid_rl.envs.mujoco import scenery as scenery
    from hybrid_rl.envs.mujoco.body import Body as Body
    from hybrid_rl.envs.mujoco.physics import Physics as Physics
    from hybrid_rl.envs.mujoco.physics import PhysicsState as PhysicsState
    from hybrid_rl.envs.trial import check as check
    from hybrid_rl.errors import CheckpointError as CheckpointError
    from hybrid_rl.errors import DivergenceError as DivergenceError
    from hybrid_rl.errors import UsageError as UsageError
    from hybrid_rl.evaluate import evaluate as evaluate
    from hybrid_rl.fields import part as part
    from hybrid_rl.networks import precision as precision
    from hybrid_rl.outside import lag as lag
    from hybrid_rl.run.machine import provenance as provenance
    from hybrid_rl.run.machine.jax_settings import prepare as prepare
    from hybrid_rl.run.online import OnlineLearner as OnlineLearner
    from hybrid_rl.run.retarget import retargeted as retargeted
    from hybrid_rl.run.saved import Trained as Trained
    from hybrid_rl.settings.build import Run as Run
    from hybrid_rl.settings.build import build as build
    from hybrid_rl.settings.build import load as _load
    from hybrid_rl.train import train as train
    from hybrid_rl.training import rollout as rollout
    from hybrid_rl.training.agent import Agent as Agent
    from hybrid_rl.training.episode import Episode as Episode
    from hybrid_rl.training.loop import Loop as Loop
    from hybrid_rl.types import EnvState as EnvState
    from hybrid_rl.types import Spec as Spec

    compose = _load

_MODULES = (  # that are public, by their last name; train and evaluate can be called
    "analysis.style cli.arguments cli.command core.adjoint core.fisher core.least_squares "
    "core.lifting core.riccati core.sampling core.statistics envs.mujoco.scenery evaluate fields "
    "networks.precision outside.lag protocols run.machine.provenance train training.rollout types"
)
_MEMBERS = {  # module -> its public names
    "api": "load make",
    "analysis.read_back": "decisions expert film names newest rebuilt runs",
    "analysis.curves": "Curve area curves spread",
    "analysis.curves_picture": "plot",
    "analysis.results": "RunFolder differences",
    "analysis.tables": "metrics",
    "envs.analytic.state": "fully_observed",
    "envs.mujoco.body": "Body",
    "envs.mujoco.physics": "Physics PhysicsState",
    "envs.trial": "check",
    "errors": "CheckpointError DivergenceError UsageError",
    "fields": "part",
    "run.machine.jax_settings": "prepare",
    "run.online": "OnlineLearner",
    "run.retarget": "retargeted",
    "run.saved": "Trained",
    "settings.build": "Run build",
    "training.agent": "Agent",
    "training.episode": "Episode",
    "training.loop": "Loop",
    "types": "EnvState Spec",
}
_PUBLIC = {  # name -> its module and, of a member, the name there
    **{module.rpartition(".")[2]: (module, "") for module in _MODULES.split()},
    **{name: (module, name) for module, names in _MEMBERS.items() for name in names.split()},
    "compose": ("settings.build", "load"),
}
__all__ = sorted(_PUBLIC)  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    """A public name, imported when it is first used."""
    if name not in _PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, member = _PUBLIC[name]
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
