"""Frames of one trial: maps that fill up (figure 5-6), poses that close in (5-4, 5-7)."""

from typing import Any

import numpy as np

from hybrid_rl.analysis.style import blank, legend_outside
from hybrid_rl.errors import UsageError
from hybrid_rl.thesis.studies import contacts
from hybrid_rl.thesis.studies.belief_frames import Drawn, beliefs, trial_of, truth
from hybrid_rl.thesis.studies.belief_panel import Panel
from hybrid_rl.thesis.studies.contact_maps_picture import marks_of

COLUMNS = 6
SIDE = 1.5  # [in] of a panel


def frames(pattern: str, times: str, trial: int) -> tuple[Any, dict[str, Any]]:
    """The belief of one trial at each time, and its errors.

    A map has two rows: path and outline, then p(y = 1 | s); a pose has one, with the target's
    density.

    Raises:
        UsageError: unless one run matches, which has this trial.
    """
    runs = contacts.trials(pattern)
    if len(runs) > 1:
        raise UsageError(f"runs={pattern}: view=frames draws one run, and {len(runs)} match")
    (run,) = runs
    seeds = run.recorded.run.seeds
    if trial >= len(seeds):
        raise UsageError(f"trial={trial}: the run has trials 0 to {len(seeds) - 1}")
    one = trial_of(run.recorded, seeds[trial])
    marks = marks_of(times, len(one.s), run.world.spec.dt)
    is_map = hasattr(one.learner.belief, "decision")
    drawn = Drawn(one, contacts.GRID, "predicted" if is_map else "target")
    states = list(beliefs(one, marks))
    views = [drawn.view(state, mark) for state, mark in zip(states, marks, strict=True)]
    seconds = [mark * run.world.spec.dt for mark in marks]
    measured = _of_map(run, trial, views, marks) if is_map else _of_pose(one, states)
    numbers = {"label": run.label, "trial": trial, "seed": seeds[trial], "times": seconds}
    numbers["contacts"] = [len(view.contacts) for view in views]
    return _picture(drawn, views, seconds, 1 + is_map), numbers | measured


def _picture(drawn: Drawn, views: list[Any], seconds: list[float], rows: int) -> Any:
    """Blocks of `rows` panels above each other, at most COLUMNS side by side."""
    blocks, true = -(-len(views) // COLUMNS), truth(drawn.trial)
    columns = -(-len(views) // blocks)
    (a, b), (c, d) = drawn.low, drawn.high
    side = SIDE if columns > 4 else 1.5 * SIDE
    size = side * columns, side * (d - b) / (c - a) * rows * blocks + 0.25 * blocks + 0.4
    figure = blank(*size)
    panels = figure.subplots(rows * blocks, columns, squeeze=False)
    for axes in panels.flat:
        axes.set_axis_off()
    for i, (view, time) in enumerate(zip(views, seconds, strict=True)):
        block, column = divmod(i, columns)
        for row in range(rows):
            axes = panels[rows * block + row, column]
            axes.set_axis_on()
            panel = Panel(axes, drawn.low, drawn.high, true, drawn.limits(views))
            panel.show(_part(view, row, rows))
            if i == 0 and row == 0:
                panel.name(drawn.outlines)
        panels[rows * block, column].set_title(f"{time:g} s", fontsize=8)
    legend_outside(panels[0, 0])
    return figure


def _part(view: Any, row: int, rows: int) -> Any:
    """All of a view in one row; in two, first path and outlines, then the shading."""
    if rows == 1:
        return view
    nothing = view.path[:0]
    return (
        view._replace(values=None)
        if row == 0
        else view._replace(outlines=[], path=nothing, contacts=nothing)
    )


def _of_map(run: contacts.Trials, trial: int, views: list[Any], marks: list[int]) -> dict[str, Any]:
    """The quality of a map at each time."""
    here = slice(trial, trial + 1)
    alone = run._replace(s=run.s[here], y=run.y[here], touch=run.touch[here])
    p = np.stack([view.values for view in views])[None]
    measured = contacts.quality(alone, p - 0.5, marks)
    return {name: values[0] for name, values in measured.items()}


def _of_pose(one: Any, states: list[Any]) -> dict[str, Any]:
    """Errors of the mean pose at each time [m, rad], and the belief's own spread."""
    reports = [one.learner.belief.report(state) for state in states]
    result: dict[str, Any] = {
        "position": [],
        "angle": [],
        "spread": [],
        "pose": np.asarray(one.theta),
    }
    for report in reports:
        mean = np.array([report[f"belief/mean_{axis}"] for axis in ("x", "y", "angle")])
        apart = mean - np.asarray(one.theta)
        result["position"].append(float(np.hypot(*apart[:2])))
        result["angle"].append(float(abs((apart[2] + np.pi) % (2 * np.pi) - np.pi)))
        result["spread"].append(float(report["belief/spread_position"]))
    return result


def lines(numbers: dict[str, Any]) -> list[str]:
    """The trial, and its errors at the last time."""
    start = f"{numbers['label']}, seed {numbers['seed']}, {numbers['times'][-1]:g} s: "
    if "iou" in numbers:
        return [f"{start}intersection over union {numbers['iou'][-1]:.2f}"]
    return [f"{start}{numbers['position'][-1]:.4f} m, {numbers['angle'][-1]:.4f} rad"]
