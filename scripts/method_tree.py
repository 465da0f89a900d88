"""The picture of docs/which_method.md: its tree of questions, from docs/which_method.yaml.

python -m scripts.method_tree out=docs/which_method.png
"""

import textwrap
from typing import Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

from hybrid_rl.analysis.style import BLUE, GREEN, GREY, STYLE
from hybrid_rl.cli.arguments import Argument, read
from scripts.pages.leaves import tree

ARGUMENTS = (Argument("out", "docs/which_method.png", "the picture"),)
ASKED, INDENT, STEM = 2.15, 0.3, 0.13  # [in] of a question; inset within a yes; of its line
ROW, HIGH = 0.62, 0.44  # [in] from one row to the next; of a box
WIDTH, ANSWER = 4.4, 1.75  # [in] of the picture, of a method
LETTERS, METHOD = 31, 22  # in a line of a question, of a method


def rows(branch: dict[str, Any], depth: int = 0) -> list[tuple[int, str, str, str]]:
    """(depth, question, method at yes, method at no) from above; "" where a question follows."""
    found = [(depth, branch["ask"], *(branch[way].get("name", "") for way in ("then", "else")))]
    for way, deeper in (("then", 1), ("else", 0)):
        if "ask" in branch[way]:
            found += rows(branch[way], depth + deeper)
    return found


def draw(branch: dict[str, Any]) -> Figure:
    """Questions below each other, the method of each yes to the right."""
    lines = rows(branch)
    height = ROW * (len(lines) + sum(1 for _, _, _, no in lines if no))
    with matplotlib.rc_context(STYLE):
        picture = Figure(figsize=(WIDTH, height))
        axes = picture.add_axes((0, 0, 1, 1))
        axes.set(xlim=(0, WIDTH), ylim=(height, 0))
        axes.axis("off")
        y, last = ROW / 2, {}
        for depth, question, yes, no in lines:
            left, wide = 0.05 + depth * INDENT, ASKED - depth * INDENT
            if depth in last:
                arrow(axes, (left + STEM, last[depth]), (left + STEM, y - HIGH / 2), "no")
            elif depth:
                arrow(axes, (left + STEM, y - ROW + HIGH / 2), (left + STEM, y - HIGH / 2), "yes")
            box(axes, left, y, wide, textwrap.fill(question, LETTERS - 4 * depth), BLUE)
            last = {k: v for k, v in last.items() if k < depth} | {depth: y + HIGH / 2}
            for answer, method in (("yes", yes), ("no", no)):
                if not method:
                    continue
                if answer == "no":
                    y += ROW
                    axes.plot([left + STEM] * 2, [y - ROW + HIGH / 2, y], color=GREY, lw=1)
                start = left + (wide if answer == "yes" else STEM)
                right = WIDTH - ANSWER - 0.05
                arrow(axes, (start, y), (right, y), answer)
                box(axes, right, y, ANSWER, textwrap.fill(method, METHOD), GREEN)
            y += ROW
    return picture


def box(axes: Any, left: float, y: float, width: float, text: str, edge: str) -> None:
    """A text in a frame around y."""
    shape = {"boxstyle": "round,pad=0,rounding_size=0.06", "fc": "white", "ec": edge, "lw": 1.3}
    axes.add_patch(FancyBboxPatch((left, y - HIGH / 2), width, HIGH, **shape))
    axes.text(left + width / 2, y, text, ha="center", va="center", fontsize=9)


def arrow(axes: Any, start: tuple[float, float], end: tuple[float, float], answer: str) -> None:
    """An arrow with its answer beside it."""
    how = {"arrowstyle": "-|>", "color": GREY, "lw": 1, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", end, start, arrowprops=how)
    down = start[0] == end[0]
    x, y = (start[0] + 0.05, start[1] + 0.08) if down else (start[0] + 0.04, start[1] - 0.09)
    axes.text(x, y, answer, fontsize=7.5, va="center", color="#444444")


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    draw(tree()).savefig(given["out"], dpi=200)


if __name__ == "__main__":
    main()
