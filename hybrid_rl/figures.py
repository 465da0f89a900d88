"""Learning curves as a picture.

    python -m hybrid_rl.figures runs="runs/halfcheetah/*/*" metric=train/return out=figure.png

A panel for each task; a line for each algorithm and, where runs of it differ in their settings,
for each of these: the interquartile mean over seeds with its 95% bootstrap band (see
hybrid_rl.studies.curves). Several metrics, such as metric=train/return,planner/mode_insertion_gradient, are
one row of panels each. x=wall_s draws over time, x=KEY over a number that a sweep went through,
such as num_demonstrations. The numbers drawn are written beside the picture, as JSON;
runs=FILE.json draws them again. What they come to is printed: last value, mean over the run (the
area under the curve), decisions to threshold=, and who is ahead of whom. What is missing, and
which seeds failed, is written under the picture and in its JSON.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import itertools
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import Argument, number, output, read
from hybrid_rl.errors import UsageError
from hybrid_rl.studies.curves import (
    Curve,
    area,
    curves,
    from_json,
    improvement,
    iqm,
    spread,
    steps_to,
)
from hybrid_rl.studies.style import STYLE, plot

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUFFIXES = (".png", ".pdf", ".svg")
OF_X, OF_Y = " of steps (or seconds), 0 or more", " in the metric's unit"
RUNS = 'runs="GLOB", such as runs="runs/*/*/*"'
ARGUMENTS = (
    Argument("runs", "", "pattern of the run folders, in quotes; or a .json to draw", needed=RUNS),
    Argument("metric", "train/return", "metrics of metrics.jsonl, with commas between them"),
    Argument("out", "figure.png", f"the picture: {', '.join(SUFFIXES)}; numbers beside it"),
    Argument("x", "step", "step, wall_s, or a key that a sweep went through"),
    Argument("group", "algo", "key of the configuration with a curve for each of its values"),
    Argument("smooth", 0.0, "width of a moving mean, in units of x", number(0, OF_X)),
    Argument("threshold", None, "value of the metric: when is it reached?", number(what=OF_Y)),
)


def save(
    figure: "Figure",
    drawn: Sequence[Curve],
    out: str | Path,
    source: str | Path = "",
    **about: str,
) -> Path:
    """Writes the picture, and the numbers in it as JSON beside it.

    source: the JSON that `drawn` was read from; it is not written over.
    about: more to write into the JSON, such as metric="train/return".
    """
    import matplotlib

    out = Path(out)
    if out.suffix not in SUFFIXES:
        raise UsageError(f"out={out}: must end in {', '.join(SUFFIXES)}")
    out.parent.mkdir(parents=True, exist_ok=True)
    undated = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}.get(out.suffix)
    with matplotlib.rc_context(STYLE):
        figure.savefig(out, dpi=200, metadata=undated)
    if out.with_suffix(".json").resolve() == Path(source).resolve():
        return out
    numbers = {
        **about,
        "line": "interquartile mean over seeds",
        "band": "95% percentile bootstrap over seeds",
        "curves": [_numbers(curve) for curve in drawn],
    }
    out.with_suffix(".json").write_text(json.dumps(numbers, indent=1) + "\n", encoding="utf-8")
    return out


def _seeds(curve: Curve) -> str:
    return f"{len(curve.seeds)} seed{'s' * (len(curve.seeds) != 1)}"


def _numbers(curve: Curve) -> dict:
    """What is drawn of a curve, as JSON holds it."""
    arrays = {name: getattr(curve, name) for name in ("x", "iqm", "low", "high", "each")}
    return {
        "task": curve.task,
        "metric": curve.metric,
        "label": curve.label,
        "seeds": curve.seeds,
        "runs": curve.runs,
        "notes": curve.notes,
        **{name: _plain(array) for name, array in arrays.items()},
        "area": _plain(area(curve)),
    }


def _plain(array: np.ndarray) -> list:
    """Numbers as JSON holds them: in the digits of float32, null for what is not finite."""
    single = array.astype("float32").astype(object)
    single[~np.isfinite(array)] = None
    return single.tolist()


def summarise(drawn: Sequence[Curve], threshold: float | None = None) -> list[str]:
    """What the curves come to, a line each; then how often a method is ahead of another in area.

    Of each curve up to the last point that all its seeds have.
    """
    lines = []
    for curve in drawn:
        if not curve.shared.any():
            lines.append(f"{curve.task}, {curve.label}: no point that all its seeds have")
            continue
        last = np.flatnonzero(curve.shared)[-1]
        ends = spread(curve.each[:, last])
        if last < len(curve.x) - 1:
            ends += f" at {curve.x[last]:,.10g}"
        line = (
            f"{curve.task}, {curve.label}: {_seeds(curve)}, last {curve.metric} {ends}, "
            f"mean {spread(area(curve))}"
        )
        if threshold is not None:
            steps = steps_to(curve, threshold)
            line += f", {threshold:,.10g} reached by {np.isfinite(steps).sum()} of {len(steps)}"
            if np.isfinite(steps).all():
                line += f" at {iqm(steps):,.0f}"
        lines.append(line)
    for one, other in itertools.combinations(drawn, 2):
        both = one.shared.any() and other.shared.any()
        if both and (one.task, one.metric) == (other.task, other.metric):
            rate, low, high = improvement(area(one), area(other))
            lines.append(
                f"{one.task}, {one.metric}: {one.label} ahead of {other.label} "
                f"in {rate:.0%} [{low:.0%}, {high:.0%}] of pairs"
            )
    return lines


def main() -> None:
    """The command."""
    given, _ = read(__doc__, ARGUMENTS)
    output("out", given["out"], SUFFIXES, ".json")
    x, group, smooth = (given[name] for name in ("x", "group", "smooth"))
    about = {"metric": given["metric"], "x": x, "group": group}
    if given["runs"].endswith(".json"):
        drawn, about = from_json(given["runs"])
    else:
        metrics = [metric.strip() for metric in given["metric"].split(",")]
        each = [curves(given["runs"], metric, x, group, smooth) for metric in metrics]
        drawn = list(itertools.chain(*each))
    out = save(plot(drawn, about["x"]), drawn, given["out"], given["runs"], **about)
    print("\n".join(summarise(drawn, given["threshold"])))
    for note in (note for curve in drawn for note in curve.notes):
        print(f"note: {note}")
    print(f"{out} and {out.with_suffix('.json')}")


if __name__ == "__main__":
    command.guarded(main)
