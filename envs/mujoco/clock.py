"""The time that MuJoCo C simulates in one decision, compared with that of the spec.

dt = n h,   h: timestep of the model, n: physics steps of a decision
"""

from collections.abc import Iterator

import jax
import numpy as np
from jax.extend.core import ClosedJaxpr, Jaxpr

from hybrid_rl.envs.mujoco import mjcf, native


def differs(dt: float, step: ClosedJaxpr) -> Iterator[str]:
    """A line if a decision takes another time than dt [s]; step: its program.

    Nothing where that is not certain, as physics steps stand in a loop or a branch.
    """
    calls = list(_physics(step.jaxpr))
    for asset in {asset for asset, _, _ in calls}:
        counts = [n for name, n, _ in calls if name == asset]
        h, n = mjcf.load(asset).opt.timestep, sum(counts)
        sure = all(once for name, _, once in calls if name == asset)
        if sure and not np.isclose([h * n, *(h * count for count in counts)], dt, rtol=1e-3).any():
            steps = f"{n} physics steps of {h:g} s, {h * n:g} s in all"
            yield f"makes {steps}, and spec.dt is {dt:g} s; write dt={h * n:g}, or other steps"


def _physics(program: Jaxpr, once: bool = True) -> Iterator[tuple[str, int, bool]]:
    """Model, physics steps, and whether it is made once, of each call of MuJoCo C in a program."""
    for equation in program.eqns:
        if equation.primitive.name == "ffi_call":
            called = native.call_of(equation.params["target_name"])
            yield from [(called.asset, called.steps, once)] if called and called.steps else []
        name, given = equation.primitive.name, equation.params
        straight = once and bool(name in ("jit", "pjit") or given.get("branches_platforms"))
        for inner in jax.tree.leaves(list(given.values())):
            if isinstance(inner, ClosedJaxpr | Jaxpr):
                inside = inner.jaxpr if isinstance(inner, ClosedJaxpr) else inner
                yield from _physics(inside, straight)
