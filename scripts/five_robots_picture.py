"""Pictures of docs/results: the default and another setting on five robots.

    python -m scripts.five_robots_picture of=plain_models out=docs/results/plain_models.png
    python -m scripts.five_robots_picture of=fast out=docs/results/fast.png
    python -m scripts.five_robots_picture of=imagined_range out=docs/results/imagined_range.png

of=plain_models: beside models with layer normalisation; fast: beside settings=fast; imagined_range:
beside settings=annealed.
"""

import json
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from hybrid_rl.analysis.curves import band, iqm
from hybrid_rl.analysis.style import BLACK, BLUE, STYLE, VERMILION, thousands
from hybrid_rl.cli.arguments import Argument, one_of, read
from scripts.peers_picture import FONTS, evaluated

OTHERS = {
    "plain_models": "with layer normalisation (10)",
    "fast": "settings=fast (10)",
    "imagined_range": "settings=annealed (10 to 32)",
}
ARGUMENTS = (
    Argument("of", "plain_models", "or fast, imagined_range", one_of(*OTHERS)),
    Argument("folder", "docs/results", "of the JSON files"),
    Argument("out", "plain_models.png", "the picture"),
)
BEFORE = {  # robot -> file of the runs with layer normalisation and the curve, or the task in it
    "half-cheetah": ("bf16", None),
    "hopper": ("bf16", None),
    "walker2d": ("velocity_walker2d", "all velocities"),
    "ant": ("records_h100", None),
    "humanoid": ("records", None),
}
SIZE, DPI, LAST = (9.6, 5.6), 170, 100_000


def other(of: str, folder: Path, robot: str) -> tuple[np.ndarray, np.ndarray]:
    """Decisions [G] and returns [S, G] of the other setting."""
    if of == "imagined_range":
        file = json.loads((folder / "imagined_range.json").read_text())
        return evaluated(file["margin 3, rates that fall"][robot]["both"])
    name, label = BEFORE[robot] if of == "plain_models" else (of, None)
    file = json.loads((folder / f"{name}.json").read_text())
    if label is None:
        return evaluated(file["tasks"][robot].get("both", file["tasks"][robot]))
    (curve,) = (one for one in file["curves"] if one["label"] == label)
    return np.array(curve["x"]), np.array(curve["each"])


def draw(of: str, folder: Path) -> Figure:
    """A panel for each robot: returns over decisions."""
    ours, theirs = (
        json.loads((folder / f"{name}.json").read_text())["tasks"]
        for name in ("plain_models", "dhmbpo")
    )
    with matplotlib.rc_context(STYLE | FONTS):
        picture = Figure(figsize=SIZE, layout="constrained")
        panels = picture.subplots(2, 3).ravel()
        for axes, robot in zip(panels, BEFORE, strict=False):
            shown = {
                "hybrid_stochastic (10 seeds)": (*evaluated(ours[robot]["both"]), VERMILION, "-"),
                OTHERS[of]: (*other(of, folder, robot), BLUE, "--"),
            }
            for name, (x, each, ink, line) in shown.items():
                axes.plot(x, iqm(each), line, color=ink, lw=2, label=name)
                axes.fill_between(x, *band(each), color=ink, alpha=0.15, lw=0)
            x, each = evaluated(theirs[robot]["two updates"])
            axes.plot(x, iqm(each), "x", color=BLACK, ms=7, mew=2, label="DHMBPO, two updates")
            axes.set(title=robot.removesuffix("2d"), xlim=(0, LAST * 1.02), ylim=(0, None))
            for axis in (axes.xaxis, axes.yaxis):
                axis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
                axis.set_major_formatter(FuncFormatter(thousands))
        panels[-1].axis("off")
        panels[-1].legend(*panels[0].get_legend_handles_labels(), loc="center")
        panels[0].set_ylabel("return")
        panels[3].set_ylabel("return")
        picture.supxlabel("decisions")
    return picture


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    draw(given["of"], Path(given["folder"])).savefig(given["out"], dpi=DPI)


if __name__ == "__main__":
    main()
