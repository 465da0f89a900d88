"""Quadcopter flights in the replay memories of run folders, and what they cost."""

import itertools
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.analysis.results import RunFolder, differences, short
from hybrid_rl.data.replay import unpack
from hybrid_rl.envs.analytic.quadcopter_se3 import KT, MASS, THRUST, G, QuadcopterSE3
from hybrid_rl.thesis.studies.recorded import read as read_memory


class Flight(NamedTuple):
    """The flights of one method: S trials of T decisions."""

    label: str
    memory: Any  # [S, T, ...]
    obs: np.ndarray  # [S, T, 18]
    action: np.ndarray  # [S, T, 4]
    next_obs: np.ndarray  # [S, T, 18]
    terminated: np.ndarray  # [S, T]


def read(folder: Path) -> Flight:
    """The flight in the replay memory of the run in `folder`.

    Raises:
        UsageError: if the run has no complete memory of one quadcopter.
    """
    recorded = read_memory(folder, "quadcopter_se3")
    memory, full = recorded.memory, recorded.config.controllers.full
    strength = full.level if "kind" in full else full.controller.gain
    label = f"{recorded.config.algo} {strength:g}"
    return first(label, memory, len(memory.rows), recorded.decisions)


def read_all(folders: list[Path]) -> list[Flight]:
    """The flights of all runs in the order of their labels.

    Equal labels are extended by the settings that differ, or by the folders.
    """
    pairs = sorted(((read(folder), folder) for folder in folders), key=lambda pair: pair[0].label)
    flights = []
    for label, group in itertools.groupby(pairs, key=lambda pair: pair[0].label):
        members, paths = zip(*group, strict=True)
        more = short(differences([RunFolder(path) for path in paths]))
        if len(set(more)) < len(members):
            more = [str(path) for path in paths]
        flights += [
            flight._replace(label=f"{label} {words}".strip())
            for flight, words in zip(members, more, strict=True)
        ]
    return flights


def first(label: str, memory: Any, trials: int, length: int) -> Flight:
    """The first `length` decisions of the first `trials` in `memory` [S, ...]."""
    count = jnp.minimum(memory.count[:trials], length)
    memory = memory.replace(rows=memory.rows[:trials, :length], count=count)
    made: Any = unpack(memory.rows[:, :, 0], QuadcopterSE3().spec)
    made = jax.tree.map(np.asarray, made)
    return Flight(label, memory, made.obs, made.action, made.next_obs, made.terminated)


def equal_size(flights: list[Flight]) -> list[Flight]:
    """All flights cut to the fewest trials and to the shortest flight."""
    trials, length = (min(flight.obs.shape[axis] for flight in flights) for axis in (0, 1))
    return [first(flight.label, flight.memory, trials, length) for flight in flights]


def cost(flight: Flight) -> dict[str, np.ndarray]:
    """Per trial [S]: power loss [N], norm of u, furthest from the hover [m], whether lost."""
    thrust = KT * THRUST * flight.action.sum(-1)
    return {
        "power_loss": np.abs(thrust - MASS * G).mean(1),
        "norm_of_u": np.linalg.norm(flight.action, axis=-1).mean(1),
        "furthest": np.linalg.norm(flight.next_obs[..., :3], axis=-1).max(1),
        "lost": flight.terminated.max(1),
    }
