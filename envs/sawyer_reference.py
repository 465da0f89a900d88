"""Reference of `sawyer_torque`: joint angles with which the tip of the rod follows a path.

    p(t) = (0.8, 0.1 cos 2t, 0.1 sin 4t + 0.4) [m], of period pi s
    q(t) = argmin |q - n|^2 subject to p(q) = p(t),   n: neutral pose
    q <- n + J^+ (p(t) - p(q) + J (q - n)),   J = dp/dq [3, 7]

The iteration is least squares with the joints drawn to the neutral pose. q(t) is a Fourier series
through its solutions, which gives its rates and accelerations. A quintic polynomial of 1 s leads
from rest at the neutral pose to q(0) with its rates and accelerations; it is our choice.

Source: thesis section 7.5.2 (path); Rethink Robotics' sawyer_robot (neutral pose).
"""

from functools import cache

import mujoco
import numpy as np
from scipy.interpolate import BPoly

from hybrid_rl.envs.mujoco import mjcf

ASSET, SITE = "sawyer_torque.xml", "tip"
NEUTRAL = (0.0, -1.18, 0.0, 2.18, 0.0, 0.57, 3.3161)  # [rad]
PERIOD = np.pi  # [s]
BLEND = 1.0  # [s] from the neutral pose to the path
SOLUTIONS = 128  # in a period; coefficients of the series are below 1e-12 rad from the 20th on


def path(t: np.ndarray) -> np.ndarray:
    """p [N, 3] [m] at times t [N] [s]."""
    return np.stack([np.full_like(t, 0.8), 0.1 * np.cos(2 * t), 0.1 * np.sin(4 * t) + 0.4], 1)


def tip(data: mujoco.MjData, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Position [3] of the tip and its Jacobian [3, 7] at q [7], in float64."""
    model, jacobian = mjcf.load(ASSET), np.zeros((3, 7))
    data.qpos[:] = q
    mujoco.mj_fwdPosition(model, data)
    site = model.site(SITE).id
    mujoco.mj_jacSite(model, data, jacobian, None, site)
    return data.site_xpos[site].copy(), jacobian


@cache
def _coefficients() -> np.ndarray:
    """Fourier coefficients [SOLUTIONS / 2 + 1, 7] of q(t)."""
    data, neutral = mujoco.MjData(mjcf.load(ASSET)), np.array(NEUTRAL)
    q, solutions = neutral, []
    for point in path(np.arange(SOLUTIONS) * PERIOD / SOLUTIONS):
        change = np.inf
        while change > 1e-12:
            p, jacobian = tip(data, q)
            after = neutral + np.linalg.pinv(jacobian) @ (point - p + jacobian @ (q - neutral))
            change, q = np.abs(after - q).max(), after
        solutions.append(q)
    return np.fft.rfft(solutions, axis=0, norm="forward")


def joints(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """q, q', q'' [N, 7] of the path at times t [N] [s]."""
    c = _coefficients()
    w = 2 * np.pi / PERIOD * np.arange(len(c))
    twice = np.where(w > 0, 2.0, 1.0)  # negative frequencies
    waves = twice * np.exp(1j * np.outer(t, w))
    q, rate, acceleration = ((waves * (1j * w) ** k @ c).real for k in range(3))
    return q, rate, acceleration


@cache
def table(rounds: int, dt: float) -> np.ndarray:
    """(q, q', tip) [N, 17], one row every `dt` [s]: the blend, `rounds` of the path, then rest.

    The first row is the neutral pose at rest. The last one repeats the end of the path at rest.
    """
    blend = round(BLEND / dt)
    t = dt * np.arange(round(rounds * PERIOD / dt) + 1)
    q, rate, _ = joints(t)
    still = np.zeros(7)
    end = [part[0] for part in joints(t[:1])]
    quintic = BPoly.from_derivatives([0, BLEND], [[np.array(NEUTRAL), still, still], end])
    before = dt * np.arange(blend)
    q = np.concatenate([quintic(before), q, q[-1:]])
    rate = np.concatenate([quintic.derivative()(before), rate, still[None]])
    data = mujoco.MjData(mjcf.load(ASSET))
    return np.concatenate([q, rate, [tip(data, each)[0] for each in q]], 1)
