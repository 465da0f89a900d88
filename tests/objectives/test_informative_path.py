"""The information that a path gathers, against NumPy and closed forms."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.core.domain import Box
from hybrid_rl.objectives.informative_path import InformativePath
from hybrid_rl.types import Params, Path, Spec

BOX = Box((0, 1), (0.0, 0.0), (2.0, 1.0), lattice=True)
SPEC = Spec(obs=4, act=2, dt=0.1)


@dataclass(frozen=True)
class Hill:
    """log p(s) = -|s - (1.5, 0.5)|^2 / (2 0.2^2)."""

    def log_density(self, params: Any, s: Any) -> Any:
        return -0.5 * jnp.sum((s - jnp.array([1.5, 0.5])) ** 2) / 0.04


OBJECTIVE = InformativePath(Hill(), BOX, samples=300, width=0.1, share=0.2, barrier=2.0, forget=0.9)


def states(s: Any) -> Any:
    """States [M, 4] at positions s [M, 2]."""
    return jnp.asarray(np.pad(np.asarray(s, np.float32), ((0, 0), (0, 2))))


@partial(jax.jit, static_argnums=0)
def _value(objective: InformativePath, past: Any, x: Any) -> Any:
    memory, u, key = objective.init(SPEC), jnp.zeros(2), jax.random.key(0)
    for before in past:
        memory = objective.prepare(Params(), memory, before, u, key)[1]
    of_path, _ = objective.prepare(Params(), memory, x[0], u, key)
    return of_path(Path(x, jnp.zeros((len(x) - 1, 2))))


def value_of(objective: InformativePath, past: Any, path: Any) -> float:
    """J of a path [T+1, 2] after positions [M, 2]."""
    return float(_value(objective, states(np.reshape(past, (-1, 2))), states(path)))


def test_j_is_the_sum_in_its_docstring() -> None:
    """With earlier positions, forgetting, a share and a position outside of the box."""
    rng = np.random.default_rng(0)
    past, path = rng.uniform(0, 1, (3, 2)), rng.uniform(0.5, 1.2, (4, 2))
    s = np.asarray(OBJECTIVE.points, float)
    g = np.exp(-0.5 * ((s - [1.5, 0.5]) ** 2).sum(1) / 0.04)
    g = 0.8 * g / g.sum() + 0.2 / 300

    def k(x: Any) -> Any:
        return np.exp(-0.5 * (((s - x) / [2.0, 1.0]) ** 2).sum(1) / 0.01)

    kept = np.ones(300)
    for x in past:
        kept = (kept * (1 - k(x))) ** 0.9
    missed = np.prod([1 - k(x) for x in path], 0)
    over = np.maximum(path - [2.0, 1.0], 0) / [2.0, 1.0]
    wanted = g @ (kept * (1 - missed)) - 2.0 * np.mean((over**2).sum(1))
    assert over.max() > 0
    assert value_of(OBJECTIVE, past, path) == pytest.approx(wanted, rel=1e-4)
