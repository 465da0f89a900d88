"""Koopman operators in learned features: figure 7-4.

    cart_pendulum  the iterations until it is stabilised: until all greedy episodes of an evaluation
                   are whole
    two_link       distance to its target at the end of the attempt of each iteration [rad], and the
                   share of greedy attempts that end within 0.05 rad

An iteration is `eval_every` decisions. The label of a run is the name of its folder.
"""

from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.analysis.curves import plural
from hybrid_rl.analysis.results import RunFolder, find
from hybrid_rl.analysis.style import blank, legend_below, line_styles, plain_log, words
from hybrid_rl.errors import UsageError
from hybrid_rl.thesis.studies.dots import dots
from hybrid_rl.thesis.studies.recorded import read

CART, ARM = "cart_pendulum", "two_link"
SUCCESS = "eval/policy_success"
ANGLES, TARGETS = [0, 2], [4, 5]  # of the arm, in an observation [rad]
MARK = 100  # iterations by which the share of stabilised carts is reported
EARLY = 5  # iterations of the thesis' claim about the arm


def embedding(pattern: str) -> tuple[Any, dict[str, Any]]:
    """Iterations of the carts, distances of the arms."""
    folders = find(pattern)
    numbers: dict[str, Any] = {CART: {}, ARM: {}}
    for folder in folders:
        run = RunFolder(folder)
        task = run.settings.get("task")
        if task not in numbers:
            raise UsageError(f"runs={folder}: needs a run of {CART} or {ARM}")
        label = _label(folder, folders)
        numbers[task][label] = (cart if task == CART else arm)(run)
    return draw(numbers), numbers


def _label(folder: Path, folders: list[Path]) -> str:
    """The folder's name, with its parent's if another folder of its task has that name."""
    task = RunFolder(folder).settings.get("task")
    same = [
        other
        for other in folders
        if other.name == folder.name and RunFolder(other).settings.get("task") == task
    ]
    return folder.name if len(same) == 1 else f"{folder.parent.name}/{folder.name}"


def evaluated(run: RunFolder) -> tuple[np.ndarray, np.ndarray]:
    """Iterations [G] and the success [S, G] of their evaluations; NaN where it has none."""
    interval = run.settings["eval_every"]
    rows = [row for row in run.rows if row.get(SUCCESS) is not None]
    if not rows:
        raise UsageError(f"runs={run.path}: has no {SUCCESS}; train with eval_modes=[policy]")
    steps, seeds = (sorted({row[name] for row in rows}) for name in ("step", "seed"))
    values = np.full((len(seeds), len(steps)), np.nan)
    for row in rows:
        values[seeds.index(row["seed"]), steps.index(row["step"])] = row[SUCCESS]
    return np.array(steps) / interval, values


def stabilised(iterations: np.ndarray, success: np.ndarray) -> np.ndarray:
    """[S] the first iteration whose success [S, G] is 1; inf: none."""
    whole = success == 1
    return np.where(whole.any(1), iterations[whole.argmax(1)], np.inf)


def cart(run: RunFolder) -> dict[str, Any]:
    """The numbers of a run of the cart."""
    iterations, success = evaluated(run)
    first = stabilised(iterations, success)
    low, middle, high = np.quantile(first, [0.25, 0.5, 0.75], method="inverted_cdf")
    return {
        "trials": len(first),
        "iterations": [middle, low, high],  # infinite where fewer are stabilised
        "iterations_of_trials": first,
        "share_by_100": float((first <= MARK).mean()),
        "share_at_the_end": float((success[:, -1] == 1).mean()),
        "last_iteration": iterations[-1],
    }


def arm(run: RunFolder) -> dict[str, Any]:
    """The numbers of a run of the arm."""
    iterations, success = evaluated(run)
    made = read(run.path, ARM).made
    ends = np.flatnonzero(made.truncated[0])
    if not (made.truncated == made.truncated[:1]).all() or not len(ends):
        raise UsageError(f"runs={run.path}: needs episodes of equal length")
    distance = distances(made.next_obs[:, ends])
    return {
        "trials": len(distance),
        "attempts": np.arange(1, len(ends) + 1),
        "distance": np.quantile(distance, [0.5, 0.25, 0.75], axis=0),
        "evaluations": iterations,
        "share_within": np.nanmean(success, axis=0),
        "share_within_by_5": float(np.nanmean(success[:, np.searchsorted(iterations, EARLY)]))
        if iterations[-1] >= EARLY
        else None,
    }


def distances(obs: np.ndarray) -> np.ndarray:
    """[...] distance between angles and targets of observations [..., 6]."""
    return np.linalg.norm(obs[..., ANGLES] - obs[..., TARGETS], axis=-1)


def lines(numbers: dict[str, Any]) -> list[str]:
    """A line for each run."""
    result = []
    for label, one in numbers[CART].items():
        shown = [f"{x:g}" if np.isfinite(x) else "never" for x in one["iterations"]]
        middle, low, high = shown
        result.append(
            f"{CART} {label}, {plural(one['trials'], 'trial')}: stabilised after {middle} "
            f"[{low}, {high}] iterations, {one['share_by_100']:.0%} by {MARK}, "
            f"{one['share_at_the_end']:.0%} at the end"
        )
    for label, one in numbers[ARM].items():
        middle, low, high = (row[-1] for row in one["distance"])
        result.append(
            f"{ARM} {label}, {plural(one['trials'], 'trial')}: last distance {middle:.3g} "
            f"[{low:.3g}, {high:.3g}] rad, within 0.05 rad {one['share_within'][-1]:.0%} at the end"
        )
    return result


def draw(numbers: dict[str, Any]) -> Any:
    """A row of trials per method of the cart, curves of distance of the arm."""
    drawn = {task: numbers[task] for task in (CART, ARM) if numbers[task]}
    most = max(map(len, drawn.values()))
    figure = blank(4.5 * len(drawn), 2.6 + 0.25 * most)
    panels = figure.subplots(1, len(drawn), squeeze=False)[0]
    for axes, (task, methods) in zip(panels, drawn.items(), strict=True):
        (_carts if task == CART else _arms)(axes, methods)
    return figure


def _carts(axes: Any, methods: dict[str, Any]) -> None:
    """The first stable iteration of each trial; those that never were are at the right edge."""
    end = max(one["last_iteration"] for one in methods.values())
    axes.set(xscale="log", xlim=(0.8, None), xlabel="Iterations (grey: never)")
    dots(axes, {label: one["iterations_of_trials"] for label, one in methods.items()}, end)
    axes.set_title("Cart pendulum: until stabilised")
    plain_log(axes.xaxis)


def _arms(axes: Any, methods: dict[str, Any]) -> None:
    """Median and quartiles of the distance at the end of each attempt."""
    styles = line_styles(methods)
    for label, one in methods.items():
        (middle, low, high), style = one["distance"], styles[label] | {"marker": None}
        axes.plot(one["attempts"], middle, label=words(label), **style)
        axes.fill_between(one["attempts"], low, high, color=style["color"], alpha=0.1, lw=0)
    axes.set(xlabel="Iterations", yscale="log", title="Arm: distance after 2 s [rad]")
    plain_log(axes.yaxis)
    legend_below(axes)
