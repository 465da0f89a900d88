"""Koopman operators: control, falling quadcopters, tracking and learned embeddings.

    python -m hybrid_rl.figures study=koopman view=control out=fig_7_1.png
    python -m hybrid_rl.figures study=koopman view=falls runs="runs/quadcopter_se3/*/*"

view=control    figure 7-1: Van der Pol's oscillator under three regulators. Cost and integral of
                |x|, divided by those of the known system's regulator, and the optimum by iterative
                LQR, over horizons and ranges of the data
view=falls      figure 7-2: trials of experiment=thesis/fig_7_2, a run per method. Trials at rest
                (|v|^2 + |w|^2 below 0.01 to the end) with Wilson's 95% interval, errors,
                information, greatest twist
view=frames     figure 7-2 c: the attitude along the first trial of each run, and its height
view=initial    figure 7-3: the same for runs that differ in the first K
view=embedding  figure 7-4: iterations until stabilised, and the arm's distance to its target
view=tracking   figures 7-6 and 7-7: RMSE, correlation and lag along a reference, after the
                exploration and one second of the path; IQM and 95% band over seeds
"""

from typing import Annotated, Any

from hybrid_rl.cli.arguments import one_of, whole
from hybrid_rl.thesis.studies import (
    embeddings,
    fall_frames,
    falls,
    falls_picture,
    oscillator,
    tracking,
)
from hybrid_rl.thesis.studies.numbers import rounded

DRAWN = {
    "falls": falls_picture.draw_information,
    "initial": falls_picture.draw_initial,
    "embedding": embeddings.draw,
    "tracking": tracking.draw,
}
LINES = {
    "control": oscillator.lines,
    "falls": falls.lines,
    "frames": fall_frames.lines,
    "initial": falls.lines,
    "embedding": embeddings.lines,
    "tracking": tracking.lines,
}


def figure(
    view: Annotated[str, ", ".join(LINES), one_of(*LINES)] = "control",
    runs: Annotated[str, "run folders, of every view but control; a pattern in quotes"] = "",
    samples: Annotated[int, "of view=control: decisions of a draw of the data", whole(10)] = 5000,
    draws: Annotated[int, "of view=control: draws of the data", whole()] = 10,
    starts: Annotated[int, "of view=control: paths of each regulator", whole()] = 50,
) -> tuple[Any, dict[str, Any]]:
    """The picture and the numbers of one view."""
    views = {
        "control": lambda: oscillator.control(samples, draws, starts),
        "falls": lambda: falls_picture.information(runs),
        "frames": lambda: fall_frames.frames(runs),
        "initial": lambda: falls_picture.initial(runs),
        "embedding": lambda: embeddings.embedding(runs),
        "tracking": lambda: tracking.tracking(runs),
    }
    figure, numbers = views[view]()
    return figure, {"view": view, **rounded(numbers)}


def draw(numbers: dict[str, Any]) -> Any:
    """The picture of numbers from a JSON, without the paths of view=tracking.

    Raises:
        KeyError: for view=control and view=frames, whose JSON does not hold what they draw.
    """
    return DRAWN[numbers["view"]](numbers)


def summary(numbers: dict[str, Any]) -> list[str]:
    """The lines of one view."""
    return LINES[numbers["view"]](numbers)
