"""What a motion tells about the parameters, and the directions about which it tells nothing.

    I = J' J / sigma^2,   I v_k = lambda_k v_k,   std_k = 1 / sqrt(lambda_k)

A direction is weak if its std is more than the range that is known before. Its name is that of the
parameters in it; `scale` if everything of a force goes up together, which no log of positions sees.
"""

from dataclasses import dataclass

import numpy as np

from hybrid_rl.tools.identify.simulation import SECANT, Motion, measured, simulate
from hybrid_rl.tools.identify.system import OF_FORCE, System

NAMED = 0.25  # share of the largest entry from which a parameter belongs to a direction
SCALE = 0.9  # cosine from which a direction is the scale of all forces
FINE = 0.01  # central secants, where the information of one motion is judged


def jacobian(
    system: System, theta: np.ndarray, motion: Motion, t: np.ndarray, step: float = FINE
) -> tuple[np.ndarray, np.ndarray]:
    """J [T n, P] by central secants, and the column of all other forces [T n]."""
    y = []
    for h in (step, -step):
        models, delays = columns(system, theta, h)
        x, sensors = simulate(models[1:], delays[1:], [motion])
        y.append(measured(system, x, sensors, motion.begin, t).reshape(len(x), -1))
    J = (y[0] - y[1]).T / (2 * step)
    return J[:, :-1], J[:, -1]


def columns(system: System, theta: np.ndarray, step: float = SECANT) -> tuple[list, list[float]]:
    """Models and delays at theta, a step along each of P coordinates, and of all other forces."""
    z = system.z(theta)
    values = system.theta(z + step * np.vstack((np.zeros(system.size), np.eye(system.size))))
    models = [system.model(value) for value in values]
    models.append(system.others(theta, np.exp(step)))
    return models, [system.delay(value) for value in (*values, theta)]


def mismatch(system: System, J: np.ndarray, others: np.ndarray) -> np.ndarray:
    """[...] the sum of the columns of forces [..., N, P], which should be 0, over the largest."""
    forces = J[..., system.forces]
    total = np.linalg.norm(forces.sum(-1) + others, axis=-1)
    most = np.maximum(np.linalg.norm(forces, axis=-2).max(-1, initial=0.0), 1e-9)
    return total / most


@dataclass(frozen=True)
class Weak:
    """A direction of the coordinates that the data leave open."""

    std: float
    text: str


def widths(system: System) -> np.ndarray:
    """[P] what is known before: the standard deviation of the range of each coordinate."""
    return (system.z(system.high) - system.z(system.low)) / np.sqrt(12)


def scale_open(system: System) -> bool:
    """Whether everything of a force is unknown, and no sensor sees one."""
    model, other = system.model(system.nominal), system.others(system.nominal, 2.0)
    known = (*((getattr(model, name), getattr(other, name)) for name in OF_FORCE),)
    return not system.sensors and all(np.allclose(a, b) for a, b in known)


def _seen(system: System, information: np.ndarray) -> np.ndarray:
    """An information matrix [P, P] without what errors of derivatives tell of an open scale."""
    if not scale_open(system):
        return information
    s = system.forces / np.sqrt(system.forces.sum())
    rest = np.eye(system.size) - np.outer(s, s)
    return rest @ information @ rest


def weak(system: System, information: np.ndarray) -> list[Weak]:
    """The directions that an information matrix [P, P] leaves wider than the ranges do."""
    w, information = widths(system), _seen(system, information)
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
    return np.linalg.inv(_seen(system, information) + np.diag(1 / widths(system) ** 2))
