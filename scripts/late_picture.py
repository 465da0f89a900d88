"""The picture of docs/results/real_time.md: returns by how late actions act.

python -m scripts.late_picture file=docs/results/late.json out=docs/results/late.png
"""

import json
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from hybrid_rl.analysis.curves import band, iqm
from hybrid_rl.analysis.style import STYLE
from hybrid_rl.cli.arguments import Argument, read

ARGUMENTS = (
    Argument("file", "docs/results/late.json", "returns by robot and delay"),
    Argument("out", "late.png", "the picture"),
)
TITLES = {"halfcheetah": "half-cheetah", "hopper": "hopper"}
SHOWN = {  # what ends the name of an arm -> its name, colour, mark
    "": ("whole decisions, held back", "#000000", "o-"),
    ", interpolated": ("parts of a decision, by a straight line", "#56B4E9", "s"),
    ", not known": ("not known", "#D55E00", "^"),
}


def delay(arm: str) -> float:
    """Of an arm [decisions]."""
    return 0.0 if arm == "not late" else float(arm.split()[0])


def draw(tasks: dict[str, Any]) -> Figure:
    """A panel for each robot: interquartile mean and band of the seeds at each delay."""
    with matplotlib.rc_context(STYLE):
        picture = Figure(figsize=(4.2 * len(TITLES), 3.2), layout="constrained")
        for axes, (task, title) in zip(picture.subplots(1, 2), TITLES.items(), strict=True):
            for end, (name, ink, mark) in SHOWN.items():
                arms = [arm for arm in tasks[task]["arms"] if arm.partition("late")[2] == end]
                each = [np.array(tasks[task]["arms"][arm]["returns"])[:, None] for arm in arms]
                if not arms:
                    continue
                x, middles = [*map(delay, arms)], [float(iqm(one)[0]) for one in each]
                ends = np.array([[float(side[0]) for side in band(one)] for one in each]).T
                axes.plot(x, middles, mark, color=ink, label=name)
                axes.vlines(x, *ends, color=ink, lw=2, alpha=0.5)
            axes.set(title=title, xlabel="actions are late by [decisions]", ylabel="return")
            axes.axhline(0, color="0.8", lw=1)
        axes.figure.axes[0].legend(frameon=False, fontsize="small")
    return picture


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    draw(json.loads(Path(given["file"]).read_text())["tasks"]).savefig(given["out"], dpi=150)


if __name__ == "__main__":
    main()
