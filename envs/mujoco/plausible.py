"""What MuJoCo allows and few mean: degrees for radians, no rotation, controls off their range.

    2 pi in degrees, 0.11 rad, <= range of a hinge <= 4 pi,
    |quaternion(0)| = 1,   ctrl in [ctrlrange] of each actuator, which MuJoCo clips

Source: the MJCF reference of MuJoCo, "compiler/angle", "joint/range", "general/ctrlrange".
"""

from collections.abc import Iterator, Sequence

import jax
import mujoco
import numpy as np
from jax.extend.core import ClosedJaxpr, Jaxpr

from hybrid_rl.envs.mujoco import mjcf, native
from hybrid_rl.envs.mujoco.physics import PhysicsState

RANGE = np.deg2rad(2 * np.pi), 4 * np.pi  # [rad] of a hinge: narrowest and widest
NEAR = 1e-3  # of a norm, and of a control: what counts as within
QUATERNION = {  # its first entry in qpos of a joint
    mujoco.mjtJoint.mjJNT_FREE.value: 3,
    mujoco.mjtJoint.mjJNT_BALL.value: 0,
}


def of_start(states: Sequence[PhysicsState]) -> Iterator[str]:
    """Lines about the joints of a first state, if there is one."""
    for state in states[:1]:
        model, qpos = mjcf.load(state.asset), np.asarray(state.qpos)
        for i, kind in enumerate(model.jnt_type):
            name, (low, high) = model.joint(i).name or i, model.jnt_range[i]
            if kind in QUATERNION:
                first = model.jnt_qposadr[i] + QUATERNION[kind]
                norm = np.linalg.norm(qpos[first : first + 4])
                if abs(norm - 1) > NEAR:
                    yield f"joint {name} has a quaternion of norm {norm:.3g}; it must be 1"
            hinge = kind == mujoco.mjtJoint.mjJNT_HINGE and model.jnt_limited[i]
            if hinge and not RANGE[0] <= high - low <= RANGE[1]:
                turns = f"joint {name} turns from {low:.3g} to {high:.3g} rad"
                yield f'{turns}; MJCF has degrees, unless <compiler angle="radian"/>'


def of_controls(actions: np.ndarray, states: Sequence[PhysicsState]) -> Iterator[str]:
    """Lines about the controls that led to `states`, if some are cut off, or no range is used.

    actions: [N, m] in [-1, 1], that of each state.
    """
    if not states or states[0].ctrl is None:
        return
    model, ctrl = mjcf.load(states[0].asset), np.array([state.ctrl for state in states])
    low, high = model.actuator_ctrlrange.T
    outside = (ctrl < low - NEAR) | (ctrl > high + NEAR)
    if len(cut := np.flatnonzero(model.actuator_ctrllimited * outside.any(0))):
        names, i = ", ".join(str(model.actuator(k).name or k) for k in cut), cut[0]
        given = f"{ctrl[outside[:, i], i][0]:.3g} where {low[i]:.3g} to {high[i]:.3g} is allowed"
        yield f"random actions give actuator {names} controls outside ctrlrange, as {given}; " + (
            "MuJoCo cuts them off: map [-1, 1] to the range"
        )
    wide = model.actuator_ctrllimited * ((low < -1 - NEAR) | (high > 1 + NEAR))
    plain = (ctrl == actions).all(0) if ctrl.shape == actions.shape else False
    if len(left := np.flatnonzero(wide * plain)):
        names, i = ", ".join(str(model.actuator(k).name or k) for k in left), left[0]
        given = f"the actions as they are, where {low[i]:.3g} to {high[i]:.3g} is allowed"
        yield f"controls of actuator {names} are {given}; map [-1, 1] to the range"


def of_clock(dt: float, step: ClosedJaxpr) -> Iterator[str]:
    """A line if MuJoCo C simulates another time in a decision than dt [s]; `step`: a program.

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
    for each in program.eqns:
        if each.primitive.name == "ffi_call":
            called = native.call_of(each.params["target_name"])
            yield from [(called.asset, called.steps, once)] if called and called.steps else []
        straight = each.primitive.name in ("jit", "pjit") or each.params.get("branches_platforms")
        for inner in jax.tree.leaves(list(each.params.values())):
            if isinstance(inner, ClosedJaxpr | Jaxpr):
                inside = inner.jaxpr if isinstance(inner, ClosedJaxpr) else inner
                yield from _physics(inside, once and bool(straight))
