"""The picture of docs/results/planning.md: who reaches rewards that no run was trained on.

python -m scripts.new_goals_picture file=docs/results/new_goals.json out=docs/results/new_goals.png
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
    Argument("file", "docs/results/new_goals.json", "numbers of scripts.new_goals, by robot"),
    Argument("out", "new_goals.png", "the picture"),
)
SHOWN = {  # row -> its name and colour
    "policy": ("policy", "#D55E00"),
    "planner: gradient": ("planner", "#56B4E9"),
    "both: gradient": ("both", "#000000"),
}
TITLES = {
    "halfcheetah": "half-cheetah",
    "ant": "ant",
    "quadcopter": "quadcopter",
    "walker2d": "walker",
    "sawyer_push": "Sawyer",
}
NAMES = {  # what a goal asks for, if the end of its name is no speed
    "level": "run, torso level",
    "thrifty": "run, effort x 10",
    "aim velocity [0,1]": "sideways at 1 m/s",
    "aim turning 1": "turn at 1 rad/s",
    "aim motion [0,0,0,0,0,1]": "rise at 1 m/s",
    "aim motion [0,0,0,1,0,0]": "forwards at 1 m/s",
    "aim motion [0,0,2,0,0,0]": "spin at 2 rad/s",
    "push [0.1,0]": "block 10 cm ahead",
    "push [0,0.1]": "block 10 cm to the left",
    "push [-0.1,0]": "block 10 cm back",
}


def title(goal: str) -> str:
    """What a goal asks for."""
    return NAMES.get(goal) or f"{goal.removeprefix('speed ')} m/s"


def draw(robots: dict[str, Any]) -> Figure:
    """A panel for each goal, a row of panels for each robot; dotted: standing still."""
    widest = max(len(rows["policy"]) for rows in robots.values())
    with matplotlib.rc_context(STYLE):
        picture = Figure(figsize=(2.1 * widest, 2.0 * len(robots)), layout="constrained")
        grid = picture.subplots(len(robots), widest, squeeze=False)
        for line, (robot, rows) in zip(grid, robots.items(), strict=True):
            goals = list(rows["policy"])
            for axes in line[len(goals) :]:
                axes.axis("off")
            for axes, goal in zip(line, goals, strict=False):
                panel(axes, rows, goal)
            line[0].set_ylabel(f"{TITLES[robot]}\nreturn")
    return picture


def panel(axes: Any, rows: dict[str, Any], goal: str) -> None:
    """One goal: interquartile mean and band of each row."""
    for x, (row, (_, ink)) in enumerate(SHOWN.items()):
        each = np.asarray(rows[row][goal])[:, None]
        low, high = (float(end[0]) for end in band(each))
        middle = float(iqm(each)[0])
        axes.plot(np.full(len(each), x) + 0.22, each[:, 0], ".", ms=3, color=ink, alpha=0.35)
        axes.plot([x, x], [low, high], color=ink, lw=3, solid_capstyle="round")
        axes.plot(x, middle, "o", color=ink, ms=6)
    still = float(iqm(np.asarray(rows["still"][goal])[:, None])[0])
    axes.axhline(still, color="0.5", ls=":", lw=1)
    axes.set_xticks(range(len(SHOWN)), [name for name, _ in SHOWN.values()])
    axes.set_xlim(-0.5, len(SHOWN) - 0.4)
    axes.set_title(title(goal), fontsize=9)


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    found = json.loads(Path(given["file"]).read_text())
    robots = {name: found[name]["rows"] for name in TITLES if name in found}
    draw(robots).savefig(given["out"], dpi=150)


if __name__ == "__main__":
    main()
