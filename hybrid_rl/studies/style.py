"""The style of all pictures: colours, legends, notes, and tick labels."""

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = (  # Okabe and Ito: distinct for colour-blind readers, too
    "#0072B2",
    "#D55E00",
    "#009E73",
    "#CC79A7",
    "#E69F00",
    "#56B4E9",
    "#000000",
)
STROKES = ("-", "--", "-.", ":")  # when the colours are used up
ENTRY = 0.15  # [in] height of a line of a legend or of a note
LEGEND_WIDTH, FIGURE_WIDTH = 55, 130  # [characters] under a panel and under a figure of 9 in
BELOW, BELOW_TICKS = 34, 20  # [pt] from the axes to a legend: below the x label, below the ticks
NOTE_WIDTH = 78  # [characters] under a panel
MOST_NOTES = 8
STYLE: dict[Any, Any] = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": f"cycler('color', {list(COLOURS)})",
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "legend.handlelength": 3,  # shows dashes beside the marker
    "pdf.fonttype": 42,  # text stays text
    "svg.fonttype": "none",
    "svg.hashsalt": "hybrid_rl",  # equal numbers give equal files
    "text.parse_math": False,  # names in run folders may hold a $
}


def wrapped(notes: Sequence[str], width: int) -> list[str]:
    """The distinct notes as lines of at most `width` characters; the last line counts those cut."""
    shown = list(dict.fromkeys(notes))[:MOST_NOTES]
    lines = [
        line for note in shown for line in textwrap.wrap(textwrap.shorten(note, 3 * width), width)
    ]
    more = len(set(notes)) - len(shown)
    return [*lines, f"and {more} more notes, in the JSON next to this picture"] if more else lines


def write_notes(figure: Any, lines: Sequence[str]) -> None:
    """Write lines in small print at the lower edge of a figure or subfigure."""
    if lines:
        figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=6.5, color="#444444")


def legend_below(axes: "Axes") -> None:
    """A legend below the label of the x axis, where it covers no curve."""
    from matplotlib.transforms import ScaledTranslation

    handles, texts = axes.get_legend_handles_labels()
    texts = [textwrap.fill(text, LEGEND_WIDTH) for text in texts]
    columns = int(LEGEND_WIDTH / (max(map(len, texts), default=1) + 7))
    down = (BELOW if axes.get_xlabel() else BELOW_TICKS) / 72
    lower = ScaledTranslation(0, -down, axes.figure.dpi_scale_trans)
    axes.legend(
        handles,
        texts,
        loc="upper left",
        bbox_to_anchor=(0, 0),
        bbox_transform=axes.transAxes + lower,
        borderaxespad=0,
        borderpad=0,
        frameon=False,
        fontsize=8,
        ncols=max(1, min(len(texts), columns)),
    )


def legend_outside(axes: "Axes") -> None:
    """A legend of these axes below all axes of their figure, whose layout is constrained."""
    handles, labels = axes.get_legend_handles_labels()
    columns = int(FIGURE_WIDTH / (max(map(len, labels), default=1) + 7))
    below: Any = "outside lower center"
    figure: Any = axes.get_figure()
    figure.legend(handles, labels, loc=below, ncols=max(1, min(len(labels), columns)))


def plain_log(axis: Any) -> None:
    """A few tick labels, as plain numbers, on a logarithmic axis; call it after plotting."""
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

    low, high = axis.get_view_interval()
    parts = (1, 2, 5) if high < 2000 * low else (1,)  # of a decade
    axis.set_major_locator(LogLocator(subs=parts) if high > 8 * low else MaxNLocator(5))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(thousands))


def thousands(value: float, _: int | None = None) -> str:
    """-12,500 or 0.25, with a true minus sign."""
    return f"{value:,.10g}".replace("-", "\N{MINUS SIGN}")
