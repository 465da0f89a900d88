"""What a motion tells about the parameters, and the directions about which it tells nothing.

    I = J' J / sigma^2,   I v_k = lambda_k v_k,   std_k = 1 / sqrt(lambda_k)

A direction is weak if its std is more than the range that is known before. Its name is that of the
parameters in it; `scale` if everything of a force goes up together, which no log of positions sees.
"""

from dataclasses import dataclass

import numpy as np

from hybrid_rl.tools.identify.simulation import FINE, Motion, measured, simulate
from hybrid_rl.tools.identify.system import System

NAMED = 0.25  # share of the largest entry from which a parameter belongs to a direction
SCALE = 0.9  # cosine from which a direction is the scale of all forces
NOTHING = 1e-4  # of what the forces change alone: all of them together change nothing


def jacobian(system: System, theta: np.ndarray, motion: Motion, t: np.ndarray) -> np.ndarray:
    """J [T n, P] by central secants."""
    directions = np.vstack((np.eye(system.size), system.scale(theta)))
    z = system.z(theta) + FINE * np.concatenate((directions, -directions))
    values = system.theta(z)
    models, delays = map(system.model, values), map(system.delay, values)
    x, sensors = simulate([*models], [*delays], [motion])
    y = measured(system, x, sensors, motion.begin, t).reshape(2, len(directions), -1)
    J = (y[0] - y[1]).T / (2 * FINE)
    return without_scale(system.scale(theta), J[:, :-1], J[:, -1])


def without_scale(s: np.ndarray, J: np.ndarray, together: np.ndarray) -> np.ndarray:
    """J [N, P] without the errors of secants along s [P], if a step along it changes nothing."""
    most = np.linalg.norm(J[:, s != 0], axis=0).max(initial=0.0)
    if np.linalg.norm(together) > NOTHING * most:
        return J
    return J - np.outer(J @ s, s) / max(s @ s, 1e-12)


@dataclass(frozen=True)
class Weak:
    """A direction of the coordinates that the data leave open."""

    std: float
    text: str


def widths(system: System) -> np.ndarray:
    """[P] what is known before: the standard deviation of the range of each coordinate."""
    return (system.z(system.high) - system.z(system.low)) / np.sqrt(12)


def weak(system: System, information: np.ndarray) -> list[Weak]:
    """The directions that an information matrix [P, P] leaves wider than the ranges do."""
    w = widths(system)
    values, vectors = np.linalg.eigh(information * w[:, None] * w)  # 1: as much as the range says
    found = []
    for value, vector in zip(values, (vectors * w[:, None]).T, strict=True):
        if value < 1:
            std = float(np.linalg.norm(vector) / np.sqrt(max(value, 1e-30)))
            found.append(Weak(std, _named(system, vector / np.linalg.norm(vector))))
    return found


def _named(system: System, v: np.ndarray) -> str:
    """The parameters of a direction [P], and how they go together."""
    v = v * np.sign(v[np.argmax(abs(v))])
    if system.forces.sum() > 1 and v @ system.forces / np.sqrt(system.forces.sum()) > SCALE:
        forces = ", ".join(np.array(system.names)[system.forces])
        known = "leave out one that you know, or log a force"
        return f"scale: {forces}, all by one factor, move nothing; {known}"
    order = [i for i in np.argsort(-abs(v)) if abs(v[i]) > NAMED]
    up = [system.names[i] for i in order if v[i] > 0]
    down = [system.names[i] for i in order if v[i] < 0]
    if len(order) == 1:
        return f"{up[0]} alone"
    return f"{', '.join(up)} up" + (f" against {', '.join(down)} down" if down else "")


def covariance(system: System, information: np.ndarray) -> np.ndarray:
    """[P, P] of the coordinates after data with this information [P, P], and the ranges."""
    return np.linalg.inv(information + np.diag(1 / widths(system) ** 2))
