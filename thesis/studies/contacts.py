"""Runs in which a robot feels contact: the trials, and how good their maps and poses are.

objects   touched: a twentieth of their outline lies within 5 cm of a true contact
outline   share of the outlines within 5 cm of a true contact
iou       intersection over union of p > 1/2, holes filled, and the positions d < r of contact
cells     share of 10 x 10 free cells in which the path was
position  distance [m] of the mean pose; angle: difference [rad]; good: below 3 cm and 0.1 rad
first     time until a pose is good, found: until it stays good to the end
stuck     half of the last 10 s in one cell of 10 cm
"""

import re
from dataclasses import replace
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from contourpy import contour_generator  # a part of matplotlib
from scipy import ndimage, stats

from hybrid_rl.analysis.results import find
from hybrid_rl.core import poses
from hybrid_rl.core.batching import repeat
from hybrid_rl.errors import UsageError
from hybrid_rl.thesis.studies.recorded import Recorded, labels, one_episode, read

TASKS = ("contact_plane", "sprk", "sawyer_probe")
GRID = 128  # cells a side of a map
POINTS = 256  # of the outlines
CLOSE, TOUCHED = 0.05, 0.05  # [m] from a contact; share of an object's outline
CELLS = 10  # a side, of the visited share
GOOD = 0.03, 0.1  # [m] and [rad] of a pose that is found
CELL, LAST = 0.1, 10.0  # [m] of a cell and [s] at the end, of a robot that is stuck


class Trials(NamedTuple):
    """The trials of one run: S trials of T decisions."""

    label: str
    recorded: Recorded
    world: Any
    start: np.ndarray  # [S, 4]
    s: np.ndarray  # [S, T, 2] positions after each decision
    y: np.ndarray  # [S, T] measured contacts
    touch: np.ndarray  # [S, T] measured contacts that are true
    rows: dict[str, np.ndarray]  # metric -> [S, T] of metrics.jsonl


def trials(pattern: str, names: str = "method") -> list[Trials]:
    """The trials of all runs that match, named by method or by folder, without its number."""
    folders = find(pattern)
    if names == "folder":
        words = [re.sub(r"^\d+_", "", path.name) for path in folders]
    else:
        words = labels(folders)
    return [_of(read(path, *TASKS), word) for path, word in zip(folders, words, strict=True)]


def _of(recorded: Recorded, label: str) -> Trials:
    made = one_episode(recorded)
    world = recorded.run.agent.episode.env
    s, y = made.next_obs[..., :2], made.reward
    rows = _rows(recorded, y.shape)
    true = rows.get("world/touch", np.full(y.shape, np.nan))  # an idle robot has no such row
    touch = y * np.where(np.isnan(true), y, true)
    return Trials(label, recorded, world, made.obs[:, 0], s, y, touch, rows)


def _rows(recorded: Recorded, shape: tuple[int, ...]) -> dict[str, np.ndarray]:
    """Metrics of poses [S, T]; NaN where a row has none."""
    result: dict[str, np.ndarray] = {}
    order = {seed: i for i, seed in enumerate(recorded.run.seeds)}
    for row in recorded.folder.rows:
        for name, value in row.items():
            if name.startswith(("belief/", "world/pose", "world/touch")) and row["step"] > 0:
                column = result.setdefault(name, np.full(shape, np.nan))
                column[order[row["seed"]], row["step"] - 1] = value
    return result


def grid(world: Any) -> np.ndarray:
    """Positions [GRID, GRID, 2], first index along x."""
    sides = [np.linspace(a, b, GRID) for a, b in zip(world.low, world.high, strict=True)]
    return np.stack(np.meshgrid(*sides, indexing="ij"), -1).astype(np.float32)


def distances(world: Any, s: np.ndarray, pose: np.ndarray | None = None) -> np.ndarray:
    """Signed distance [...] to the objects at s [..., 2]."""
    each = jax.jit(jax.vmap(lambda s: world.distance(s, pose)))
    return np.asarray(each(jnp.asarray(s.reshape(-1, 2)))).reshape(s.shape[:-1])


def decisions(run: Trials, marks: list[int]) -> np.ndarray:
    """f [S, marks, GRID, GRID] of the support vector machine after these numbers of decisions.

    Raises:
        UsageError: for a run whose belief is no map.
    """
    learner: Any = run.recorded.run.agent.learners["belief"]
    belief = learner.belief
    if not hasattr(belief, "decision"):
        raise UsageError(f"runs={run.recorded.folder.path}: its belief is no map of contacts")
    points = jnp.asarray(grid(run.world).reshape(-1, 2))

    def learn(state: Any, measured: Any) -> Any:
        def one(state: Any, measured: Any) -> tuple[Any, None]:
            return belief.add(state, *measured, None), None

        return jax.lax.scan(one, state, measured)[0]

    part = jax.jit(jax.vmap(learn))
    values = jax.jit(
        lambda state: jax.lax.map(lambda s: belief.decision(state, s), points, batch_size=1024)
    )
    first = belief.init(jax.random.key(0), run.recorded.run.agent.spec)
    state = repeat(first, len(run.y))
    result = []
    for begin, end in zip([0, *marks], marks, strict=False):
        state = part(state, (jnp.asarray(run.s[:, begin:end]), jnp.asarray(run.y[:, begin:end])))
        each = [values(jax.tree.map(lambda a, i=i: a[i], state)) for i in range(len(run.y))]
        result.append(np.stack(each).reshape(-1, GRID, GRID))
    return np.stack(result, 1)


def quality(run: Trials, f: np.ndarray, marks: list[int]) -> dict[str, np.ndarray]:
    """Measures [S, marks] of the maps f [S, marks, GRID, GRID] and of the paths so far."""
    world = run.world
    inside = distances(world, grid(world)) < world.radius
    outline, owner = _outline(world)
    free = _free(world)
    result: dict[str, list[list[float]]] = {}
    for trial, maps in enumerate(f):
        row: dict[str, list[float]] = {}
        for count, one in zip(marks, maps, strict=True):
            s, touch = run.s[trial, :count], run.touch[trial, :count]
            apart = np.linalg.norm(outline[:, None] - s[touch > 0.5][None], axis=-1)
            near = apart.min(1, initial=np.inf) < CLOSE
            touched = [near[owner == i].mean() >= TOUCHED for i in range(len(world.objects))]
            for name, value in {
                "objects": float(sum(touched)),
                "outline": float(near.mean()),
                "iou": _iou(ndimage.binary_fill_holes(one > 0), inside),
                "iou_raw": _iou(one > 0, inside),
                "cells": _visited(world, free, s),
            }.items():
                row.setdefault(name, []).append(value)
        for name, values in row.items():
            result.setdefault(name, []).append(values)
    return {name: np.array(values) for name, values in result.items()}


def touched_all(run: Trials) -> np.ndarray:
    """Time [S] [s] at which every object was touched; NaN if one never was."""
    outline, owner = _outline(run.world)
    result = []
    for s, touch in zip(run.s, run.touch, strict=True):
        when = np.flatnonzero(touch > 0.5)
        near = np.linalg.norm(outline[:, None] - s[when][None], axis=-1) < CLOSE
        first = np.where(near, when[None] + 1.0, np.inf).min(1, initial=np.inf)  # of each point
        each = [np.sort(first[owner == i]) for i in range(len(run.world.objects))]
        last = max(times[int(np.ceil(TOUCHED * len(times))) - 1] for times in each)
        result.append(last * run.world.spec.dt if np.isfinite(last) else np.nan)
    return np.array(result)


def _outline(world: Any) -> tuple[np.ndarray, np.ndarray]:
    """Positions of contact [M, 2], equally far along the outlines; the object [M] of each."""
    x, y = (np.linspace(a, b, 2 * GRID) for a, b in zip(world.low, world.high, strict=True))
    away = distances(world, np.stack(np.meshgrid(x, y), -1).astype(np.float32))
    lines: Any = contour_generator(x, y, away).lines(world.radius)
    lengths = [np.append(0, np.hypot(*np.diff(line, axis=0).T).cumsum()) for line in lines]
    apart = sum(length[-1] for length in lengths) / POINTS
    points = [
        np.stack([np.interp(np.arange(apart / 2, far[-1], apart), far, each) for each in line.T], 1)
        for line, far in zip(lines, lengths, strict=True)
    ]
    outline = np.concatenate(points).astype(np.float32)
    shapes = [replace(world, objects=(each,)) for each in world.objects]
    return outline, np.argmin([distances(shape, outline) for shape in shapes], 0)


def _iou(a: Any, b: Any) -> float:
    return float((a & b).sum() / max((a | b).sum(), 1))


def _free(world: Any) -> np.ndarray:
    """Which cells [CELLS, CELLS] have a free middle."""
    low, high = np.array(world.low), np.array(world.high)
    sides = [a + (b - a) * (np.arange(CELLS) + 0.5) / CELLS for a, b in zip(low, high, strict=True)]
    middles = np.stack(np.meshgrid(*sides, indexing="ij"), -1).astype(np.float32)
    return distances(world, middles) > world.radius


def _visited(world: Any, free: np.ndarray, s: np.ndarray) -> float:
    """Share of the `free` cells in which a path s [T, 2] was."""
    low, high = np.array(world.low), np.array(world.high)
    index = np.floor((s - low) / (high - low) * CELLS).astype(int)
    index = index[((index >= 0) & (index < CELLS)).all(1)]
    seen = np.zeros((CELLS, CELLS), bool)
    seen[tuple(index.T)] = True
    return float((seen & free).sum() / free.sum())


def errors(run: Trials, estimate: str = "mean") -> tuple[np.ndarray, np.ndarray]:
    """Position [m] and angle [rad] errors [S, T] of the mean or the best pose.

    Raises:
        UsageError: for a run whose belief is no pose, or with rows left out.
    """
    rows = run.rows
    if f"belief/{estimate}_x" not in rows:
        raise UsageError(f"runs={run.recorded.folder.path}: its belief is no pose")
    x, y, angle = (rows[f"belief/{estimate}_{axis}"] for axis in ("x", "y", "angle"))
    position = np.hypot(x - rows["world/pose_x"], y - rows["world/pose_y"])
    apart = np.abs(np.asarray(poses.wrap(jnp.asarray(angle - rows["world/pose_angle"]))))
    if np.isnan(position).any():
        raise UsageError(f"runs={run.recorded.folder.path}: train with log_every=1")
    return position, apart


def good(position: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Whether a pose is found, for errors [...]."""
    return (position < GOOD[0]) & (angle < GOOD[1])


def first(good: np.ndarray) -> np.ndarray:
    """Decisions [S] until good [S, T] first holds; infinite if never."""
    return np.where(good.any(1), good.argmax(1) + 1.0, np.inf)


def found(good: np.ndarray) -> np.ndarray:
    """Decisions [S] until good [S, T] first holds for the rest of the trial; infinite if never."""
    return first(np.flip(np.cumprod(np.flip(good, 1), 1), 1).astype(bool))


def stuck(s: np.ndarray, dt: float) -> np.ndarray:
    """Whether [S] half of the last positions of paths s [S, T, 2] lie in one cell."""
    last = np.floor(s[:, -round(LAST / dt) :] / CELL).astype(int)
    most = [np.unique(path, axis=0, return_counts=True)[1].max() for path in last]
    return np.array(most) >= last.shape[1] / 2


def sign_test(one: np.ndarray, other: np.ndarray) -> dict[str, float]:
    """Trials [S] in which `one` is sooner or later than `other`, and the p-value of both sides."""
    sooner, later = int((one < other).sum()), int((one > other).sum())
    p = stats.binomtest(sooner, sooner + later).pvalue if sooner + later else 1.0
    return {"sooner": sooner, "later": later, "p": float(p)}
