"""What a search found, how far it strayed from its equilibrium, and where it measured.

    python -m hybrid_rl.studies.bayesian_optimisation runs="runs/*/*bayesopt/*" out=fig_6_4.png
    python -m hybrid_rl.studies.bayesian_optimisation runs="runs/*/kle3_bayesopt/*" group=explorer.level out=guard.png

Best value over measurements and the Lyapunov function over time, median and range over trials;
and the measurements of the first trial of each method. The numbers are written beside it, as JSON;
the best value of each method, how soon it had it and how far it strayed are printed.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import json
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import Argument, output, read
from hybrid_rl.studies.curves import Curve, curves, spread

BEST, V, WHERE, VALUE = "belief/best", "planner/lyapunov", "belief/place", "belief/value"
FEW = 10  # points up to which each has a marker
SUFFIXES = (".png", ".pdf", ".svg")
RUNS = 'runs="GLOB", such as runs="runs/*/*bayesopt/*"'
ARGUMENTS = (
    Argument("runs", "", "pattern of the run folders, in quotes", needed=RUNS),
    Argument("out", "searching.png", f"the picture: {', '.join(SUFFIXES)}; numbers beside it"),
    Argument("group", "algo", "key of the configuration with a curve for each of its values"),
)


def _by_label(runs: str, metric: str, group: str) -> dict[str, Curve]:
    return {curve.label: curve for curve in curves(runs, metric, group=group)}


def _seconds(curve: Curve) -> np.ndarray:
    """Time [s] of a curve's points."""
    from omegaconf import OmegaConf

    from hybrid_rl.config import build

    config: Any = OmegaConf.load(Path(curve.runs[0]) / "config.yaml")
    return curve.x * build(config).agent.spec.dt


def _band(axes: Any, x: np.ndarray, each: np.ndarray, name: str, colour: str) -> None:
    """Median and range of each [S, G] over trials; few points are markers."""
    label = f"{name} ({len(each)} trial{'s' * (len(each) != 1)})"
    marker = "o" if len(x) <= FEW else None
    axes.plot(x, np.nanmedian(each, 0), color=colour, marker=marker, ms=4, label=label)
    low, high = np.nanmin(each, 0), np.nanmax(each, 0)
    axes.fill_between(x, low, high, color=colour, alpha=0.15, lw=0)
    if len(x) == 1:  # a band has no width there
        axes.vlines(x, low, high, color=colour, lw=1)


def plot(runs: str, group: str = "algo") -> tuple[Any, dict[str, Any], list[str]]:
    """The figure, what it says in numbers, and the notes of its curves."""
    import matplotlib
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    from hybrid_rl.studies.style import (
        COLOURS,
        ENTRY,
        NOTE_WIDTH,
        STYLE,
        legend_below,
        plain_log,
        wrapped,
    )

    best, strayed = _by_label(runs, BEST, group), _by_label(runs, V, group)
    at, value = _by_label(runs, WHERE, group), _by_label(runs, VALUE, group)
    colours = {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(best)}
    every = [note for found in (best, strayed) for curve in found.values() for note in curve.notes]
    notes = list(dict.fromkeys(every))
    lines = wrapped(notes, 2 * NOTE_WIDTH)
    heights = (3.2 + ENTRY * len(best), 1.9 * len(best) + ENTRY * len(lines))
    numbers: dict[str, Any] = {}
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(11.5, sum(heights)), layout="constrained")
        halves: Any = figure.subfigures(2, 1, height_ratios=heights)
        above, below = halves
        found, stray = above.subplots(1, 2)
        rows = below.subplots(len(best), 2, squeeze=False)
        for (name, curve), (where, when) in zip(best.items(), rows, strict=True):
            count = np.arange(1, curve.each.shape[1] + 1)
            _band(found, count, curve.each, name, colours[name])
            _measurements(where, when, at[name].each[0], value[name].each[0], name)
            numbers[name] = summarise(curve.each)
        for name, curve in strayed.items():
            _band(stray, _seconds(curve), curve.each, name, colours[name])
            peaks = np.nanmax(curve.each, 1)
            numbers[name] |= {"V_peak": [round(float(peak), 1) for peak in peaks]}
            numbers[name] |= {"V_median": round(float(np.nanmedian(curve.each)), 2)}
        found.set(xlabel="Measurements", title="Best value")
        stray.set(xlabel="Time [s]", title="Lyapunov function V", yscale="log")
        plain_log(stray.yaxis)
        for axes in (found, *rows[:, 1]):
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        for axes in (found, stray):
            legend_below(axes)
        if lines:
            below.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=6.5, color="#444444")
    return figure, numbers, notes


def _measurements(where: Any, when: Any, s: np.ndarray, y: np.ndarray, name: str) -> None:
    """The measurements of one trial: values over coordinate, and coordinate over number."""
    count, few = np.arange(1, len(s) + 1), len(s) <= FEW
    where.scatter(s, y, c=count, s=30 if few else 8, cmap="viridis")
    where.set(title=f"{name}: measurements, late ones light", xlim=(-1, 1), ylim=(0, 1.1))
    when.plot(count, s, ".-", lw=0.6, ms=8 if few else 3)
    when.set(title=f"{name}: coordinate of each measurement", ylim=(-1, 1))


def summarise(each: np.ndarray) -> dict[str, Any]:
    """Of the best values [S, G] of all trials after each of G measurements."""
    marks = [n for n in (10, 20, 40, 60, 80, each.shape[1]) if n <= each.shape[1]]
    late = [int(np.argmax(one > 0.95)) + 1 if np.nanmax(one) > 0.95 else None for one in each]
    return {
        "trials": len(each),
        "median_best_after": {n: round(float(np.nanmedian(each[:, n - 1])), 4) for n in marks},
        "measurements_to_95_percent": late,
        "best": [round(float(value), 4) for value in np.nanmax(each, 1)],
    }


def line(name: str, numbers: dict[str, Any]) -> str:
    """One method in words."""
    trials, soon = numbers["trials"], numbers["measurements_to_95_percent"]
    reached = [number for number in soon if number is not None]
    parts = [
        f"best value {spread(np.array(numbers['best']))} after {max(numbers['median_best_after'])}",
        f"above 95% in {len(reached)} of {trials}",
    ]
    if reached:
        parts[-1] += f", after {np.median(reached):g} measurements (median)"
    if "V_peak" in numbers:
        parts.append(f"greatest V {spread(np.array(numbers['V_peak']))}")
    return f"{name}, {trials} trial{'s' * (trials != 1)}: {'; '.join(parts)}"


def main() -> None:
    """The command."""
    given, _ = read(__doc__, ARGUMENTS)
    out = output("out", given["out"], SUFFIXES, ".json")
    figure, numbers, notes = plot(given["runs"], given["group"])
    out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=130)
    out.with_suffix(".json").write_text(json.dumps(numbers, indent=1) + "\n", encoding="utf-8")
    print("\n".join(line(name, found) for name, found in numbers.items()))
    for note in notes:
        print(f"note: {note}")
    print(f"{out} and {out.with_suffix('.json')}")


if __name__ == "__main__":
    command.guarded(main)
