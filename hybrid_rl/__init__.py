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

import ast
import os
from importlib import import_module
from pathlib import Path
from typing import Any

from hybrid_rl.version import __version__ as __version__

_LISTED = ast.parse(Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8")).body
_PUBLIC = {  # name -> its module and its name there
    str(node.names[0].asname).lstrip("_"): (str(node.module), node.names[0].name)
    for node in _LISTED
    if isinstance(node, ast.ImportFrom)
}
__all__ = sorted(_PUBLIC)  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    """A public name, imported when it is first used; of a package it is a module."""
    if name not in _PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, member = _PUBLIC[name]
    home = import_module(module)
    if "__path__" in vars(home):
        return import_module(f"{module}.{member}")
    return home if module == f"hybrid_rl.{name}" else getattr(home, member)  # train can be called


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
