"""The style of all pictures: colours, legends, notes and tick labels."""

import itertools
import math
import re
import textwrap
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = (  # Okabe and Ito, wine of Tol: distinct for colour-blind readers, too
    "#0072B2",
    "#D55E00",
    "#009E73",
    "#CC79A7",
    "#E69F00",
    "#56B4E9",
    "#882255",
    "#7F7F7F",
    "#000000",
)
BLUE, VERMILION, GREEN, PINK, ORANGE, SKY, WINE, GREY, BLACK = COLOURS
COLOUR_OF = {  # beginnings of labels that have a colour in every picture, plain methods first
    BLUE: "sac, bc, ddpg, fourier_ergodic, Fourier, direct_bayesopt, direct_model_learning, "
    "koopman_direct, DAgger, nie, policy alone, the policy alone, without the planner",
    VERMILION: "hybrid_stochastic, hybrid_bc, the default, today's default, default, all three, "
    "all velocities, settings=light, settings=quick, make train, its policy alone, kle3, KL, D, "
    "DAIL, fisher, koopman_active, gain",
    GREEN: "nn_mppi, deterministic_mpc, planner alone, entropy, lqr_bayesopt, ou_noise, noise, "
    "koopman_noise, residual, minie, settings=annealed",
    PINK: "flash_sac, informative paths, disagreement, koopman_norm, norm",
    ORANGE: "settings=mbpo, hybrid_deterministic, normal_noise, koopman_babble, features",
    SKY: "one_step_mpc, uniform_noise, gp_active, RQ-DAgger, joint_pd",
    WINE: "settings=fast, A_step, author, product, z15",
    GREY: "none, sb3_sac, bayesopt, behaviour cloning, starts of the flip, thesis",
    BLACK: "exact model, koopman_known, oracle, computed_torque",
}
METHODS = {name: colour for colour, names in COLOUR_OF.items() for name in names.split(", ")}
WORDS = {  # label or its beginning -> what a reader sees
    "sb3_sac_ours": "SAC of Stable-Baselines3, our world",
    "sb3_sac_gymnasium": "SAC of Stable-Baselines3, Gymnasium's world",
    "A_step_printed": "A-optimal by step, as printed",
    "D_weight": "D-optimal, weight",
    "D": "D-optimal",
    "full": "D-optimal, full matrix",
    "z15_gain": "z 15, information gain",
    "z15": "z 15,",
    "gain": "information gain",
    "norm": "norm of actions",
    "noise": "noise",
    "none": "none",
    "computed_torque": "computed torque",
    "no_feedforward": "no feed-forward",
    "thesis_weights": "thesis' weights",
    "joint_pd": "PD control of the joints",
    "koopman_track decisions=[100, 500]": "K updated",
    "koopman_track decisions=[100, 0]": "K frozen",
    "halfcheetah": "half-cheetah",
    "walker2d": "walker",
    "sawyer_push": "Sawyer pushes",
    "panda_stack": "Panda stacks",
}
STROKES: tuple[Any, ...] = ("-", "--", ":", "-.", (0, (6, 1, 1, 1, 1, 1)), (0, (9, 3)))
MARKERS = ("o", "s", "^", "D")
ENTRY = 0.15  # [in] height of a line of a legend or of a note
LEGEND_WIDTH, FIGURE_WIDTH = 55, 130  # [characters] under a panel of 4.4 in, a figure of 9 in
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
    "legend.handlelength": 4,  # shows dashes beside the marker
    "pdf.fonttype": 42,  # text stays text
    "svg.fonttype": "none",
    "svg.hashsalt": "hybrid_rl",  # equal numbers give equal files
    "text.parse_math": False,  # names in run folders may hold a $
}


def blank(width: float, height: float) -> "Figure":
    """A figure [in] without panels, in which panels and legends make room for each other."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def colours(labels: Iterable[str]) -> dict[str, str]:
    """The colour of each label of a picture.

    A method has that of METHODS, unless one before it there has it in this picture. Other labels
    have the colours that are left; one that begins with another label has the same.
    """
    distinct = list(dict.fromkeys(labels))
    family = {each: beginning(each, METHODS) or beginning(each, distinct, min) for each in distinct}
    of_family: dict[str, str] = {}
    for name in filter({*family.values()}.__contains__, METHODS):
        if " " in name or METHODS[name] not in of_family.values():  # words name a part of a method
            of_family[name] = METHODS[name]
    spare = itertools.cycle([each for each in COLOURS if each not in of_family.values()] or COLOURS)
    for name in family.values():
        if name not in of_family:
            of_family[name] = next(spare)
    return {label: of_family[name] for label, name in family.items()}


def line_styles(labels: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Colour, dashes and marker of each line of a picture; no two have both colour and dashes.

    The colours are those of `colours` while there are dashes left. Beyond all pairs of colours and
    dashes the markers differ.
    """
    wanted = colours(labels)
    used: dict[str, int] = dict.fromkeys(COLOURS, 0)
    styles: dict[str, dict[str, Any]] = {}
    plain = {name: i for i, name in enumerate(METHODS)}  # these are whole lines
    for label in sorted(wanted, key=lambda each: plain.get(each, len(plain))):
        colour = wanted[label]
        if used[colour] >= len(STROKES):
            colour = min(COLOURS, key=lambda each: used[each])
        turn, stroke = divmod(used[colour], len(STROKES))
        used[colour] += 1
        marker = MARKERS[(stroke + turn) % len(MARKERS)]
        styles[label] = {"color": colour, "linestyle": STROKES[stroke], "marker": marker}
    return {label: styles[label] for label in wanted}


def beginning(label: str, names: Iterable[str], best: Callable[..., str] = max) -> str:
    """The longest (best=min: shortest) name whose words a label (or algo=) begins with, or ""."""
    found = [name for name in names if re.match(rf"(algo=)?{re.escape(name)}(?![^\W_])", label)]
    return best(found, key=len, default="")


def words(label: str) -> str:
    """A label as a reader has it: "koopman_active prior=1e-06" is "koopman_active, prior 1e-6"."""
    if label.startswith(("algo=", "settings=")):
        return label  # as one types it
    name, first = beginning(label, WORDS), label.split(" ")[0]
    kept = name or ("" if "=" in first else first.rstrip(","))
    rest = label[len(kept) :].replace("_frozen", ", K frozen")
    rest = re.sub(r"[, ]*([\w.]+)=", r", \1 ", rest).replace("_", " ")
    rest = re.sub(r"(\de-)0+(?=\d)", r"\1", rest)
    return WORDS.get(name, kept) + (rest if kept else rest.removeprefix(", "))


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


def legend_below(axes: "Axes", width: int = LEGEND_WIDTH) -> None:
    """A legend of `width` characters below the label of the x axis, where it covers no curve."""
    from matplotlib.transforms import ScaledTranslation

    handles, texts = axes.get_legend_handles_labels()
    texts = [textwrap.fill(text, width) for text in texts]
    columns = int(width / (max(map(len, texts), default=1) + 7))
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


def legend_outside(*panels: "Axes") -> None:
    """A legend of these axes below all axes of their figure, whose layout is constrained."""
    named = [zip(*reversed(axes.get_legend_handles_labels()), strict=True) for axes in panels]
    of = dict(itertools.chain(*named))  # label -> handle
    columns = max(1, min(len(of), int(FIGURE_WIDTH / (max(map(len, of), default=1) + 7))))
    figure: Any = panels[0].get_figure()
    figure.legend([*of.values()], [*of], loc="outside lower center", ncols=columns)


def plain_log(axis: Any, narrow: bool = False) -> None:
    """A few tick labels, as plain numbers, on a logarithmic axis; call it after plotting.

    narrow: an axis along which fewer labels have room.
    """
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

    low, high = axis.get_view_interval()
    inside = math.floor(math.log10(high)) - math.ceil(math.log10(low)) + 1  # powers of ten
    whole = inside > 1 if narrow else high >= 2000 * low
    parts = (1,) if whole else (1, 2, 5)  # of a decade
    decades = LogLocator(subs=parts, numticks=5 if narrow else None)
    axis.set_major_locator(decades if high > 8 * low else MaxNLocator(3 if narrow else 5))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(thousands))


def thousands(value: float, _: int | None = None) -> str:
    """-12,500 or 0.25, with a true minus sign."""
    return f"{value:,.10g}".replace("-", "\N{MINUS SIGN}")
