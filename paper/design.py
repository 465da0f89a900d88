"""Draws design.png: one decision of one learner.

python paper/design.py
"""

from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

BLUE, ORANGE, GREY = "#dbe9f6", "#fde6cf", "#eeeeee"
BOXES = {  # name: (x, y, width, height, colour, first line, second line)
    "params": (0.2, 2.6, 2.3, 1.0, GREY, "Params", "model, policy, critic, belief"),
    "controller": (3.5, 1.6, 3.1, 3.0, BLUE, "", ""),
    "env": (7.7, 2.6, 2.2, 1.0, ORANGE, "environment", "MuJoCo or closed form"),
    "memory": (7.7, 0.2, 2.2, 1.0, GREY, "replay memory", "transitions"),
    "learners": (3.5, 0.2, 3.1, 1.0, BLUE, "learners", "model, policy and critic, belief"),
}
PARTS = ["model", "proposal", "objective", "policy"]  # in the controller
ARROWS = [  # from, to, label, offset of the label
    ((2.5, 3.1), (3.5, 3.1), "", (0, 0)),
    ((6.6, 2.9), (7.7, 2.9), "action", (0, -0.15)),
    ((7.7, 3.3), (6.6, 3.3), "observation", (0, 0.15)),
    ((8.8, 2.6), (8.8, 1.2), "transition", (0.55, 0)),
    ((7.7, 0.7), (6.6, 0.7), "batches", (0, 0.12)),
    ((3.5, 0.7), (1.35, 2.6), "updates", (-0.35, -0.35)),
]


def main() -> None:
    """Draw the boxes and arrows, in inches."""
    figure, axes = plt.subplots(figsize=(10.1, 5.2))
    for x, y, width, height, colour, first, second in BOXES.values():
        style = "round,pad=0,rounding_size=0.12"
        box = FancyBboxPatch((x, y), width, height, boxstyle=style, fc=colour, ec="black")
        axes.add_patch(box)
        axes.text(x + width / 2, y + 0.63 * height, first, ha="center", va="center", size=13)
        axes.text(x + width / 2, y + 0.3 * height, second, ha="center", va="center", size=8.5)
    axes.text(5.05, 4.33, "controller", ha="center", va="center", size=13)
    for i, part in enumerate(PARTS):
        x, y = 3.7 + 1.4 * (i % 2), 3.25 - 0.8 * (i // 2)
        style = "round,pad=0,rounding_size=0.08"
        axes.add_patch(FancyBboxPatch((x, y), 1.3, 0.6, boxstyle=style, fc="white", ec="black"))
        axes.text(x + 0.65, y + 0.3, part, ha="center", va="center", size=11)
    axes.text(5.05, 2.0, "sampling core or adjoint core", ha="center", va="center", size=10)
    for start, end, label, (dx, dy) in ARROWS:
        axes.add_patch(
            FancyArrowPatch(start, end, arrowstyle="-|>", mutation_scale=16, color="black")
        )
        x, y = (start[0] + end[0]) / 2 + dx, (start[1] + end[1]) / 2 + dy
        axes.text(x, y, label, ha="center", va="center", size=10)
    axes.set_xlim(0, 10.1)
    axes.set_ylim(0, 5.2)
    axes.axis("off")
    figure.savefig(Path(__file__).with_name("design.png"), dpi=130, bbox_inches="tight")


if __name__ == "__main__":
    main()
