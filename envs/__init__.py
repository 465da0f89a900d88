"""Environments: one file a task; `analytic` in closed form, the others simulated by `mujoco`.

`check(env)` checks one of your own, in a second.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hybrid_rl.envs.trial import check

__all__ = ["check"]


def __getattr__(name: str) -> Any:
    """`check`, imported with JAX when it is first needed: ids of Gymnasium need no JAX."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from hybrid_rl.envs.trial import check

    return check
