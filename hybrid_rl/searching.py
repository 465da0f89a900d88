"""What a search found, how far it strayed from its equilibrium, and where it looked.

    python -m hybrid_rl.searching runs="runs/*/*bayesopt/*" out=fig_6_4.png
    python -m hybrid_rl.searching runs="runs/*/kle3_bayesopt/*" group=explorer.level out=guard.png

Best value over measurements and the Lyapunov function over time, median and range over trials;
and the measurements of the first trial of each method. The numbers are written beside it, as JSON.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl import command
from hybrid_rl.config import UsageError
from hybrid_rl.curves import Curve, curves

DEFAULTS = {"runs": "", "out": "searching.png", "group": "algo"}
BEST, V, PLACE, VALUE = "belief/best", "planner/lyapunov", "belief/place", "belief/value"
SUFFIXES = (".png", ".pdf", ".svg")


def _by_label(runs: str, metric: str, group: str) -> dict[str, Curve]:
    return {curve.label: curve for curve in curves(runs, metric, group=group)}


def _seconds(curve: Curve) -> np.ndarray:
    """Time [s] of a curve's points."""
    from omegaconf import OmegaConf

    from hybrid_rl.config import build

    config: Any = OmegaConf.load(Path(curve.runs[0]) / "config.yaml")
    return curve.x * build(config).agent.spec.dt


def _band(axes: Any, x: np.ndarray, each: np.ndarray, name: str, colour: str) -> None:
    """Median and range of each [S, G] over trials."""
    axes.plot(x, np.median(each, 0), color=colour, label=f"{name} ({len(each)} trials)")
    axes.fill_between(x, each.min(0), each.max(0), color=colour, alpha=0.15, lw=0)


def plot(runs: str, group: str = "algo") -> tuple[Any, dict[str, Any]]:
    """The figure, and what it says in numbers."""
    import matplotlib
    from matplotlib.figure import Figure

    from hybrid_rl.plotting import COLOURS, STYLE

    best, strayed = _by_label(runs, BEST, group), _by_label(runs, V, group)
    place, value = _by_label(runs, PLACE, group), _by_label(runs, VALUE, group)
    colours = {name: COLOURS[i % len(COLOURS)] for i, name in enumerate(best)}
    numbers: dict[str, Any] = {}
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(11.5, 3.2 + 1.9 * len(best)), layout="constrained")
        halves: Any = figure.subfigures(2, 1, height_ratios=(3.2, 1.9 * len(best)))
        above, below = halves
        found, stray = above.subplots(1, 2)
        looks = below.subplots(len(best), 2, squeeze=False)
        for (name, curve), (where, when) in zip(best.items(), looks, strict=True):
            count = np.arange(1, curve.each.shape[1] + 1)
            _band(found, count, curve.each, name, colours[name])
            s, y = place[name].each[0], value[name].each[0]
            where.scatter(s, y, c=count, s=8, cmap="viridis")
            where.set(title=f"{name}: measurements, late ones light", xlim=(-1, 1), ylim=(0, 1.1))
            when.plot(count, s, ".-", lw=0.6, ms=3)
            when.set(title="where, by number", ylim=(-1, 1))
            numbers[name] = _said(curve.each)
        for name, curve in strayed.items():
            _band(stray, _seconds(curve), curve.each, name, colours[name])
            peaks = curve.each.max(1)
            numbers[name] |= {"V_peak": [round(float(peak), 1) for peak in peaks]}
            numbers[name] |= {"V_median": round(float(np.median(curve.each)), 2)}
        found.set(xlabel="Measurements", title="Best value")
        stray.set(xlabel="Time [s]", title="Lyapunov function V", yscale="log")
        for axes in (found, stray):
            axes.legend()
    return figure, numbers


def _said(each: np.ndarray) -> dict[str, Any]:
    """Of the best values [S, G] of all trials."""
    marks = [n for n in (10, 20, 40, 60, 80, each.shape[1]) if n <= each.shape[1]]
    late = [int(np.argmax(one > 0.95)) + 1 if one[-1] > 0.95 else None for one in each]
    return {
        "trials": len(each),
        "median_best_after": {n: round(float(np.median(each[:, n - 1])), 4) for n in marks},
        "measurements_to_95_percent": late,
    }


def main() -> None:
    """The command."""
    given = command.arguments(DEFAULTS)
    said = DEFAULTS | given
    out = Path(said["out"])
    if "runs" not in given:
        raise UsageError('runs: not given; say runs="GLOB", such as runs="runs/*/*bayesopt/*"')
    if out.suffix not in SUFFIXES:
        raise UsageError(f"out={out}: must end in {', '.join(SUFFIXES)}")
    figure, numbers = plot(said["runs"], said["group"])
    out.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=130)
    out.with_suffix(".json").write_text(json.dumps(numbers, indent=1) + "\n", encoding="utf-8")
    print(f"{out} and {out.with_suffix('.json')}")


if __name__ == "__main__":
    command.guarded(main)
