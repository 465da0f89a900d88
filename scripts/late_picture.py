"""The picture of docs/results/real_time.md: returns by how late actions act, and in real time.

python -m scripts.late_picture file=docs/results/late.json out=docs/results/late.png
"""

import json
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hybrid_rl.analysis.curves import band, iqm
from hybrid_rl.analysis.style import STYLE
from hybrid_rl.cli.arguments import Argument, read

ARGUMENTS = (
    Argument("file", "docs/results/late.json", "returns by robot and delay"),
    Argument("out", "late.png", "the picture"),
)
TITLES = {"halfcheetah": "half-cheetah", "hopper": "hopper", "cartpole": "cartpole"}  # simulated
EPISODE = 1000  # decisions of a half-cheetah in real time
REAL = {  # run in real time -> its name, colour, decisions per second
    "halfcheetah, two cores each": ("20 Hz", "#000000", 20),
    "halfcheetah, late, two cores each": ("20 Hz, 20 ms each way", "#009E73", 20),
    "halfcheetah, 30 Hz": ("30 Hz", "#666666", 30),
    "halfcheetah, 30 Hz, 133 ms late": ("30 Hz, 66 ms each way", "#D55E00", 30),
}
SHOWN = {  # what ends the name of an arm -> its name, colour, mark
    "": ("predicted, held back", "#000000", "o-"),
    ", past actions observed": ("past actions observed", "#56B4E9", "s"),
    ", not known": ("not known", "#D55E00", "^"),
}


def delay(arm: str) -> float:
    """Of an arm [decisions]."""
    return 0.0 if arm == "not late" else float(arm.split()[0])


def draw(found: dict[str, Any]) -> Figure:
    """Interquartile mean and band of the seeds: of each robot by delay, and by minutes."""
    tasks = found["tasks"]
    with matplotlib.rc_context(STYLE):
        picture = Figure(figsize=(15, 3.2), layout="constrained")
        *panels, last = picture.subplots(1, 1 + len(TITLES))
        in_real_time(last, found["real time"])
        for axes, (task, title) in zip(panels, TITLES.items(), strict=True):
            for end, (name, ink, mark) in SHOWN.items():
                arms = [arm for arm in tasks[task]["arms"] if arm.partition("late")[2] == end]
                each = [np.array(tasks[task]["arms"][arm]["returns"])[:, None] for arm in arms]
                if not arms:
                    continue
                x, middles = [*map(delay, arms)], [float(iqm(one)[0]) for one in each]
                ends = np.array([[float(side[0]) for side in band(one)] for one in each]).T
                axes.plot(x, middles, mark, color=ink, label=name)
                axes.vlines(x, *ends, color=ink, lw=2, alpha=0.5)
            axes.set(title=f"{title}, simulated", xlabel="late by [decisions]", ylabel="return")
            axes.axhline(0, color="0.8", lw=1)
        shown = panels[0].get_legend_handles_labels()
        panels[-1].legend(*shown, loc="center right", frameon=True, fontsize="small")
    return picture


def in_real_time(axes: Axes, runs: dict[str, Any]) -> None:
    """Training returns of half-cheetahs over the minutes of their lives."""
    for run, (name, ink, rate) in REAL.items():
        returns = np.array(runs[run]["training"])
        minutes = EPISODE / rate / 60 * np.arange(1, 1 + returns.shape[1])
        axes.plot(minutes, iqm(returns), color=ink, label=name)
        axes.fill_between(minutes, *band(returns), color=ink, alpha=0.2, lw=0)
    axes.set(title="half-cheetah in real time", xlabel="minutes", ylabel="training return")
    axes.axhline(0, color="0.8", lw=1)
    axes.legend(frameon=False, fontsize="small")


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    draw(json.loads(Path(given["file"]).read_text())).savefig(given["out"], dpi=150)


if __name__ == "__main__":
    main()
