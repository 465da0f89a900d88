"""A film of training: the scene, and next to it the belief that was learned by then.

    python -m hybrid_rl.thesis.studies.belief_video run=DIR out=film.mp4

It is the first episode of training of a method that learns a belief over two coordinates, such as a
map of contacts. A .png is the picture at the end.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hybrid_rl.analysis.drawing import frames, write
from hybrid_rl.analysis.style import STYLE, legend_below
from hybrid_rl.cli import arguments, command
from hybrid_rl.cli.arguments import Argument, whole
from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.envs.mujoco.scenery import check_drawable, scene_of
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.logs.progress import Progress
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.thesis.studies.belief_frames import Drawn, beliefs, scenes, trial_of, truth
from hybrid_rl.thesis.studies.belief_panel import Panel, View
from hybrid_rl.thesis.studies.recorded import read

LENGTH = 13.5  # [s] of a video of an episode, at most about
MOST = {".mp4": 200, ".gif": 100, ".png": 1}  # pictures of an episode
SIDE = 4.8  # [in] of the panel, by which its letters are scaled
FAR = 0.01  # of an observation in a replayed scene; more is reported
ARGUMENTS = (
    Argument("run", "", "folder of the run", needed="run=DIR"),
    Argument("out", "belief.mp4", f"the file: {', '.join(MOST)}"),
    Argument("seed", None, "of a learner; empty: the first", whole(least=0)),
    Argument("episode_steps", 0, "decisions at most; 0: all", whole()),
    Argument("width", 640, "of the scene, in pixels", whole(even=True)),
    Argument("height", 480, "of the scene and of the panel beside it", whole(even=True)),
)


class Film(NamedTuple):
    """F pictures of an episode of T decisions."""

    world: Any
    poses: np.ndarray  # [F, nq]
    panel: Callable[[int], np.ndarray]  # number of a picture -> [height, height, 3]
    fps: float  # [1/s]
    speed: float  # times real time
    decisions: int  # T
    total: float  # undiscounted return
    apart: float  # of the scene from the record, at most, in units of the observation


def film(folder: Path, seed: int | None, steps: int, height: int, most: int) -> Film:
    """The first episode of training of one learner.

    seed: None is the first. steps: at most this many decisions; 0: all. height: [pixels], even.
    most: pictures at most, but for the last one; 1: the end alone.
    """
    prepare(run_folder.read(folder, "run"))
    recorded = read(folder, key="run")
    trial = trial_of(recorded, recorded.run.seeds[0] if seed is None else seed, "run")
    length = min(steps or len(trial.s), len(trial.s))
    marks = _marks(length, most)
    drawn, views = Drawn(trial), []
    with Progress(len(marks), label="learning again") as progress:
        for belief, mark in zip(beliefs(trial, marks), marks, strict=True):
            views.append(drawn.view(belief, mark))
            progress.update(len(views), {})
    poses, apart = scenes(trial)
    times = recorded.run.agent.spec.dt * np.array(marks)
    fps = most / LENGTH
    speed = fps * float(times[-1] - times[0]) / max(len(times) - 1, 1)
    total = float(trial.made.reward[:length].sum())
    panel = _painter(drawn, truth(trial), views, times, height)
    world = recorded.run.agent.episode.env
    return Film(world, poses[marks], panel, fps, speed, length, total, apart)


def _marks(length: int, most: int) -> list[int]:
    """The decisions after which there is a picture: evenly spaced, and the last."""
    if most == 1:
        return [length]
    return sorted({*range(0, length, -(-length // most)), length})


def _painter(
    drawn: Drawn, true: list[np.ndarray], views: list[View], times: np.ndarray, side: int
) -> Callable[[int], np.ndarray]:
    """The panel [side, side, 3] of each view, drawn on one figure."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        canvas = FigureCanvasAgg(Figure(figsize=(SIDE, SIDE), dpi=(side + 0.5) / SIDE))
        axes: Any = canvas.figure.add_axes((0.04, 0.13, 0.92, 0.8))
        panel = Panel(axes, drawn.low, drawn.high, true, drawn.limits(views), thick=1.5)
        panel.name(drawn.outlines)
        legend_below(axes)

    def paint(number: int) -> np.ndarray:
        panel.show(views[number])
        axes.set_title(f"{times[number]:.1f} s")
        canvas.draw()
        return np.asarray(canvas.buffer_rgba())[..., :3].copy()

    return paint


def main() -> None:
    """The command."""
    given, _ = arguments.read(__doc__, ARGUMENTS)
    out, size = arguments.output("out", given["out"], [*MOST]), (given["width"], given["height"])
    offscreen.backend()  # raises before minutes of work
    folder, seed, steps = Path(given["run"]), given["seed"], given["episode_steps"]
    shown = film(folder, seed, steps, size[1], MOST[out.suffix])
    check_drawable(shown.world)
    scene = scene_of(shown.world)

    def pictures(which: Sequence[int], smooth: bool) -> Iterator[np.ndarray]:
        """The scene, and the panel to the right of it."""
        drawn = frames(scene, shown.poses[list(which)], *size, smooth)
        return (np.hstack([one, shown.panel(i)]) for i, one in zip(which, drawn, strict=True))

    write(out, len(shown.poses), shown.fps, pictures)
    speed = "" if out.suffix == ".png" else f", {shown.speed:.2g} times real time"
    print(f"{out}: {shown.decisions} decisions, return {shown.total:,.1f}, of training{speed}")
    if shown.apart > FAR:
        print(f"the scene differs by up to {shown.apart:.2g} from the recorded observations")


if __name__ == "__main__":
    command.run(main)
