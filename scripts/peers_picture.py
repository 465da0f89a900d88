"""The picture of docs/results/default_speed.md: peers' own code beside ours on one GPU.

python -m scripts.peers_picture file=docs/results/peers.json out=docs/results/peers.png
"""

import json
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from hybrid_rl.analysis.curves import band, iqm
from hybrid_rl.analysis.style import BLACK, BLUE, GREEN, PINK, STYLE, VERMILION, thousands
from hybrid_rl.cli.arguments import Argument, read

ARGUMENTS = (
    Argument("file", "docs/results/peers.json", "returns and clocks of others, below h100"),
    Argument("ours", "docs/results/bf16.json", "returns of hybrid_stochastic, below tasks"),
    Argument("out", "peers.png", "the picture"),
)
SHOWN = {  # method -> its name, ink and marker
    "hybrid_stochastic": ("hybrid_rl's default (10 seeds)", VERMILION, "o"),
    "CrossQ": ("CrossQ of SBX (5)", GREEN, "s"),
    "SAC": ("SAC of SBX (5)", BLUE, "^"),
    "TD-MPC2": ("TD-MPC2 of TorchRL (3, to 15,000)", PINK, "D"),
}
UNCLOCKED = {"TD-MPC2"}  # its minutes are those of a trainer, without torch.compile
PUBLISHED = "DHMBPO, published (5)"
ROBOT = "half-cheetah"
FONTS: dict[Any, Any] = {
    "font.size": 11,
    "axes.titlesize": 12,
    "legend.fontsize": 11,
    "legend.handlelength": 2,
}
SIZE, DPI = (7.6, 3.9), 210  # [in]


def minutes(clock: dict[str, float], decisions: np.ndarray) -> np.ndarray:
    """[G] of a program that has made so many decisions [G] of each learner, without evaluations."""
    after = clock["learners"] * (decisions - clock["first"]) / clock["rate"]
    return (clock["first_s"] + after) / 60


def evaluated(returns: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Decisions [G] and returns [S, G] of the keys that are numbers."""
    steps = [step for step in returns if step.isdigit()]
    return np.array(steps, float), np.array([returns[step] for step in steps]).T


def draw(others: dict[str, Any], ours: dict[str, Any]) -> Figure:
    """Returns of the robot over decisions, and over minutes of one learner."""
    with matplotlib.rc_context(STYLE | FONTS):
        picture = Figure(figsize=SIZE, layout="constrained")
        left, right = picture.subplots(1, 2, sharey=True)
        for method, (name, ink, marker) in SHOWN.items():
            returns = ours[ROBOT] if method == "hybrid_stochastic" else others[ROBOT][method]
            x, each = evaluated(returns)
            panels = [(left, x)]
            if method not in UNCLOCKED:
                panels.append((right, minutes(others["clocks"][method], x)))
            for axes, at in panels:
                axes.plot(at, iqm(each), color=ink, marker=marker, ms=5, lw=2, label=name)
                axes.fill_between(at, *band(each), color=ink, alpha=0.15, lw=0)
        published(left, others["published"]["DHMBPO"][ROBOT])
        left.set_ylabel(f"{ROBOT}: return")
        left.set_xlim(0, 52_000)
        for axis in (left.xaxis, left.yaxis):
            axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
            axis.set_major_formatter(FuncFormatter(thousands))
        right.set_xlim(0, 5.2)
        left.set_xlabel("decisions (actions of one robot)")
        right.set_xlabel("minutes on one H100, one robot")
        picture.legend(*left.get_legend_handles_labels(), loc="outside upper left", ncols=2)
    return picture


def published(axes: Any, means: dict[str, float]) -> None:
    """Published means, within the axes of the others' decisions."""
    points = [(int(step), mean) for step, mean in means.items() if int(step) <= 50_000]
    axes.plot(*zip(*points, strict=True), "x", color=BLACK, ms=7, mew=2, label=PUBLISHED)


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    others, ours = (json.loads(Path(given[key]).read_text()) for key in ("file", "ours"))
    draw(others["h100"], ours["tasks"]).savefig(given["out"], dpi=DPI)


if __name__ == "__main__":
    main()
