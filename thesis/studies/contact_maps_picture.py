"""Maps of contacts: pictures of the first trial, and measures over time."""

from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.analysis.curves import plural
from hybrid_rl.analysis.style import blank, legend_outside, line_styles, words
from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import replacing
from hybrid_rl.thesis.studies import false_contacts
from hybrid_rl.thesis.studies.belief_panel import HALF, Panel, View, level
from hybrid_rl.thesis.studies.contacts import (
    Trials,
    decisions,
    distances,
    grid,
    quality,
    touched_all,
    trials,
)
from hybrid_rl.thesis.studies.numbers import band_of, banded

NAMES = {
    "objects": "objects touched",
    "outline": "outline covered",
    "iou": "intersection over union",
    "cells": "free cells visited",
}
WIDTH, ABOVE = 9.0, 3  # [in]; runs above each other at most


def marks_of(times: str, length: int, dt: float) -> list[int]:
    """Decisions at `times` [s], with commas between; empty: at thirds of the trial.

    Raises:
        UsageError: for words, or times outside of the trial.
    """
    if not times:
        return [length // 3, 2 * length // 3, length]
    try:
        marks = [round(float(word) / dt) for word in times.split(",")]
    except ValueError:
        raise UsageError(f"times={times}: must be numbers with commas between") from None
    if marks != sorted(marks) or marks[0] < 1 or marks[-1] > length:
        raise UsageError(f"times={times}: must rise, up to {length * dt:g} s")
    return marks


def maps(
    pattern: str, names: str, times: str, trial: int, map_out: str
) -> tuple[Any, dict[str, Any]]:
    """Maps of the first trial of every run, and measures of all trials at the same times."""
    runs = trials(pattern, names)
    dt, length = runs[0].world.spec.dt, min(run.y.shape[1] for run in runs)
    marks = marks_of(times, length, dt)
    fine = sorted({*marks, *np.linspace(length / 12, length, 12).round().astype(int).tolist()})
    figure, panels, below = _panels(len(runs), len(marks))
    numbers: dict[str, Any] = {"times": [mark * dt for mark in fine], "methods": {}}
    styles = line_styles([run.label for run in runs])
    for i, run in enumerate(runs):
        f = decisions(run, fine)
        measured = quality(run, f, fine)
        numbers["methods"][run.label] = {
            **_reported(measured),
            **speed(run, measured["iou"], np.array(fine) * dt),
            "false": false_contacts.measures(run, f[:, -1]),
        }
        for axes, mark in zip(panels[i], marks, strict=True):
            panel = _map(axes, run, f[0, fine.index(mark)], mark)
            axes.set_title(f"{mark * dt:g} s", fontsize=7, loc="left")
            if (i, mark) == (0, marks[0]):
                panel.name(HALF)
        panels[i][0].set_title(f"{run.label}\n{marks[0] * dt:g} s", fontsize=7, loc="left")
        line = styles[run.label] | {"marker": None, "label": words(run.label)}
        for axes, (name, title) in zip(below, NAMES.items(), strict=True):
            middle, low, high = banded(measured[name])
            axes.plot(np.array(fine) * dt, middle, **line)
            axes.fill_between(np.array(fine) * dt, low, high, alpha=0.2, color=line["color"])
            axes.set(title=title, xlabel="Time [s]")
        if map_out and i == 0:
            _save(run, f[:, -1], trial, map_out)
    for axes in below:
        axes.set_ylim(0, None)
    legend_outside(panels[0][0])
    legend_outside(below[0])
    return figure, numbers


def _panels(runs: int, times: int) -> tuple[Any, Any, Any]:
    """A figure with panels [runs, times] for maps and a row of four below.

    More than ABOVE runs are in two columns.
    """
    across = 1 if runs <= ABOVE else 2
    rows, columns = -(-runs // across), across * times
    height = rows * (min(WIDTH / columns, 2.6) + 0.25) + 0.3
    figure: Any = blank(WIDTH, height + 3)
    upper, lower = figure.subfigures(2, 1, height_ratios=[height, 3])
    panels = upper.subplots(rows, columns, squeeze=False).reshape(-1, times)
    for axes in panels[runs:].flat:
        axes.set_axis_off()
    return figure, panels, lower.subplots(1, len(NAMES))


def _map(axes: Any, run: Trials, f: np.ndarray, mark: int) -> Panel:
    """p, its outline, the true outline, the path and the contacts of the first trial."""
    world = run.world
    belief: Any = run.recorded.run.agent.learners["belief"]
    p = 1 / (1 + np.exp(-belief.belief.slope * f))
    box = world.low, world.high
    panel = Panel(axes, *box, level(distances(world, grid(world)), *box, world.radius))
    path = np.concatenate([run.start[:1, :2], run.s[0, :mark]])
    contacts = run.s[0, :mark][run.y[0, :mark] > 0.5]
    panel.show(View(p, level(p, *box, 0.5), path, contacts))
    return panel


def _reported(measured: dict[str, np.ndarray]) -> dict[str, Any]:
    """IQM and band of each measure at each time; the trials that touched every object."""
    result: dict[str, Any] = {"trials": len(measured["objects"])}
    for name, values in measured.items():
        result[name] = {**band_of(values), "median": np.median(values, 0)}
    result["objects"]["each"] = measured["objects"]
    return result


def speed(run: Trials, iou: np.ndarray, times: np.ndarray) -> dict[str, Any]:
    """Mean over time of iou [S, times], which is 0 at first; seconds until all are touched."""
    shown = run.y[:, : round(times[-1] / run.world.spec.dt)]
    area = np.trapezoid(np.pad(iou, ((0, 0), (1, 0))), np.pad(times, (1, 0)), axis=1)
    mean = area / times[-1]
    seconds = touched_all(run._replace(s=run.s[:, : shown.shape[1]], y=shown))
    known = np.where(np.isnan(seconds), np.inf, seconds)
    median = float(np.median(known))
    return {
        "mean_iou": {**band_of(mean), "each": mean},
        "seconds_to_all": {
            "median": median if np.isfinite(median) else None,
            "trials": int(np.isfinite(known).sum()),
            "each": [float(each) if np.isfinite(each) else None for each in known],
        },
    }


def _save(run: Trials, f: np.ndarray, trial: int, out: str) -> None:
    """Write the map of one trial, f [S, GRID, GRID]."""
    if trial >= len(f):
        raise UsageError(f"trial={trial}: the run has trials 0 to {len(f) - 1}")
    if Path(out).suffix != ".npz":
        raise UsageError(f"map_out={out}: must end in .npz")
    belief: Any = run.recorded.run.agent.learners["belief"]
    columns = {"f": f[trial], "low": run.world.low, "high": run.world.high}
    columns |= {"slope": belief.belief.slope}
    arrays: dict[str, Any] = {k: np.asarray(v, np.float32) for k, v in columns.items()}
    with replacing(Path(out)) as draft, draft.open("wb") as opened:
        np.savez_compressed(opened, **arrays)


def lines(numbers: dict[str, Any]) -> list[str]:
    """A line per method at the last time."""
    result = []
    for label, one in numbers["methods"].items():
        most = max(max(row) for row in np.asarray(one["objects"]["each"]).tolist())
        touched = sum(row[-1] == most for row in np.asarray(one["objects"]["each"]).tolist())
        parts = [
            f"{NAMES[name]} {one[name]['iqm'][-1]:.2f} "
            f"[{one[name]['low'][-1]:.2f}, {one[name]['high'][-1]:.2f}]"
            for name in ("outline", "iou", "cells")
        ]
        parts.append(f"its mean over time {one['mean_iou']['iqm']:.2f}")
        if one["seconds_to_all"]["median"] is not None:
            parts.append(f"all touched after {one['seconds_to_all']['median']:.0f} s")
        line = f"{label}, {plural(one['trials'], 'trial')} of {numbers['times'][-1]:g} s: "
        result.append(f"{line}{most:.0f} objects in {touched}, {', '.join(parts)}")
        if one["false"]:
            result.append(_of_false(label, one["false"]))
    return result


def _of_false(label: str, one: dict[str, Any]) -> str:
    """The line of a method's false contacts."""
    words = [
        f"{100 * one['wrong']['iqm']:.1f}% of readings wrong",
        f"{100 * one['rejected']['iqm']:.0f}% of false contacts below p = 1/2 at the end",
        *(
            f"time near {what} {one[name]['iqm']:.2f} of the expected"
            for name, what in (("returned", "them"), ("elsewhere", "other positions"))
            if name in one
        ),
    ]
    return f"{label}: {', '.join(words)}"
