"""Tables of the benchmark as pictures of at most one screen, one for each part."""

import math
import re
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hybrid_rl import style

Table = dict[str, Any]  # part, what, unit, rows of name and rate
WIDTH, BAR, HEAD = 4.2, 0.27, 0.5  # [in] of a panel; heights of a bar, and of a panel's title
TITLE = 44  # [characters] of a line of a title
MOST_ACROSS = 2  # panels
ASPECT = 1.6  # width over height of a screen


def draw(tables: Sequence[Table], out: Path) -> list[Path]:
    """Writes the picture `out`, or one for each part, such as benchmark_loop.png."""
    parts = list(dict.fromkeys(table["part"] for table in tables))
    paths = []
    for part in parts:
        path = out if len(parts) == 1 else out.with_stem(f"{out.stem}_{part}")
        _picture([table for table in tables if table["part"] == part], path)
        paths.append(path)
    return paths


def _picture(tables: Sequence[Table], out: Path) -> None:
    """A panel a table: bars from zero, each with its value."""
    from matplotlib import rc_context

    across = min(
        range(1, min(len(tables), MOST_ACROSS) + 1),
        key=lambda n: abs(math.log(_aspect(tables, n) / ASPECT)),
    )
    heights = _heights(tables, across)
    with rc_context(style.STYLE):
        size = (WIDTH * across, sum(heights) + HEAD)
        figure = style.blank(*size)
        grid = figure.subplots(len(heights), across, squeeze=False, height_ratios=heights)
        for i, (axes, table) in enumerate(zip(grid.flat, tables, strict=False)):
            _bars(axes, table, room=heights[i // across])
        for axes in list(grid.flat)[len(tables) :]:
            axes.remove()
        units = ", ".join(dict.fromkeys(table["unit"] for table in tables))
        figure.suptitle(f"{tables[0]['part']} [{units}]", fontsize=10)
        figure.savefig(out, dpi=150)


def _heights(tables: Sequence[Table], across: int) -> list[float]:
    """[in] of the rows of panels."""
    bars = [len(table["rows"]) for table in tables]
    return [BAR * max(bars[i : i + across]) + HEAD for i in range(0, len(bars), across)]


def _aspect(tables: Sequence[Table], across: int) -> float:
    return WIDTH * across / (sum(_heights(tables, across)) + HEAD)


def _bars(axes: Any, table: Table, room: float) -> None:
    """One table; room: height of the panel [in], so that all bars of a picture are as thick."""
    names = [re.sub(r"^1 (\w+)s\b", r"1 \1", row["name"]) for row in table["rows"]]
    rates = [row["rate"] for row in table["rows"]]
    compared = any(name.startswith("ours") for name in names)
    ours = [not compared or name.startswith("ours") for name in names]
    bars = axes.barh(
        names, rates, color=[style.VERMILION if own else style.GREY for own in ours], height=0.65
    )
    axes.bar_label(bars, list(map(rounded, rates)), padding=3, fontsize=8)
    axes.set_xlim(0, 1.35 * max(rates))  # room for the value at the longest bar
    axes.set_ylim((room - HEAD) / BAR - 0.4, -0.6)
    axes.grid(False)
    axes.set_xticks([])
    axes.spines["bottom"].set_visible(False)
    axes.tick_params(axis="y", length=0, labelsize=8)
    axes.set_title(textwrap.fill(table["what"], TITLE), loc="left", fontsize=8)


def rounded(rate: float) -> str:
    """Three digits: 0.123, 58,400, 216 million."""
    three = float(f"{rate:.3g}")
    return f"{three / 1e6:,g} million" if three >= 1e6 else f"{three:,g}"
