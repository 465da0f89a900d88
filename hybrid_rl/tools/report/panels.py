"""Panels of a report: learning curves as SVG whose colours are those of the page.

Text and axes have the page's colour of text, grids and lines its variables --grid, --c0, --c1, ...,
so that one drawing serves a light and a dark page.
"""

import html
import io
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from hybrid_rl import Curve, RunFolder, UsageError, curves, plot, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SECTIONS = {  # title -> beginnings of the metrics' names, in order
    "Return": ("eval/return", "eval/success", "train/return"),
    "Policy alone, planner alone": ("eval/policy_", "eval/planner_"),
    "Agreement of planner and policy": (
        "planner/mode_insertion_gradient",
        "planner/insertion_per_variance",
        "planner/policy_share",
        "planner/correction",
    ),
    "Exploration": ("exploration/",),
    "Safety": ("safety/", "planner/lyapunov", "planner/handed_over"),
    "Learning": ("model/", "belief/", "sac/", "ddpg/", "dagger/", "information/"),
}
GRID = "#dddddd"  # of STYLE, as SVG has it
INK = ("#000000", "#444444")  # of text and of notes


def metrics(runs: Sequence[RunFolder]) -> dict[str, list[str]]:
    """Title of each section -> the metrics of the runs that belong there."""
    names = sorted({name for run in runs for row in run.rows for name in row})
    sections = {}
    for title, beginnings in SECTIONS.items():
        found = [name for start in beginnings for name in names if name.startswith(start)]
        if found:
            sections[title] = list(dict.fromkeys(found))
    return sections


def found(runs: Sequence[Path], metric: str) -> list[Curve]:
    """The curves of a metric; [] if no value is finite."""
    try:
        return curves(runs, metric)
    except UsageError:
        return []


def panels(drawn: Sequence[Curve], labels: Sequence[str]) -> list[str]:
    """A drawing for each task of the curves of a metric, without notes.

    labels: of all curves of the page.
    """
    tasks = dict.fromkeys(curve.task for curve in drawn)
    each = [[curve for curve in drawn if curve.task == task] for task in tasks]
    return [
        svg(_panel(some, len(tasks), labels), f"{some[0].metric} {some[0].task}") for some in each
    ]


def _panel(drawn: Sequence[Curve], tasks: int, labels: Sequence[str]) -> "Figure":
    """The curves of a task under the name of their metric, and of the task where there are more."""
    figure = plot([replace(curve, notes=()) for curve in drawn], among=labels)
    axes = figure.axes[0]
    names = [axes.get_ylabel() or axes.get_xlabel(), axes.get_title()]
    axes.set_title(", ".join(names if tasks > 1 else names[:1]))
    axes.set_ylabel("")
    return figure


def svg(figure: "Figure", name: str) -> str:
    """A figure as an <svg> element of a page; name: in this page, for screen readers, too."""
    import matplotlib

    text = io.StringIO()
    with matplotlib.rc_context(style.STYLE):
        figure.savefig(text, format="svg", transparent=True, metadata={"Date": None})
    element = text.getvalue().partition("<svg")[2]
    element = re.sub(r"<metadata>.*?</metadata>", "", element, flags=re.DOTALL)
    element = re.sub(r' id="[\w.]+_\d+"| (?:width|height)="[\d.]+pt"', "", element)
    element = re.sub(r" font-family: [^;]+;", "", element)
    own = re.sub(r"\W", "-", name)
    element = re.sub(r'(id="|#)([mp][0-9a-f]{10})\b', rf"\1{own}-\2", element)
    colours = {colour.lower(): f"var(--c{i})" for i, colour in enumerate(style.COLOURS[:-1])}
    colours |= {GRID: "var(--grid)"} | dict.fromkeys(INK, "currentColor")
    for colour, of_page in colours.items():
        element = element.replace(colour, of_page)
    return f'<svg role="img" aria-label="{html.escape(name)}"{element}'
