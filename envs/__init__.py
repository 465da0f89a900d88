"""Environments: one file a task; `analytic` in closed form, the others simulated by `mujoco`.

`check(env)` checks one of your own, in half a second.
"""

from hybrid_rl.envs.contract import check

__all__ = ["check"]
