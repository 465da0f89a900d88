"""A video of one episode of a trained run, without a display.

    python -m hybrid_rl.render run=DIR [out=DIR/video.mp4] [mode=full] [seed=] [episode_steps=]
    python -m hybrid_rl.render policy=NAME [out=NAME.mp4] [episode_steps=]
    python -m hybrid_rl.render policy=halfcheetah reward=speed reward.target=2
    python -m hybrid_rl.render task=T [out=T.mp4] [seed=0] [episode_steps=] [env.KEY=VALUE ...]

`out` ends in .mp4 or .gif for a video, in .png for the picture halfway through the episode, or
with at=0,20,40 for those after so many decisions, side by side. A Gymnasium environment draws
itself, in its own size and without at=.

The episode is one of the run's own evaluation, the first unless episode=N: same key, no
exploration. policy=NAME is a trained policy of policies/, or a file. reward, planner, env.KEY and
episode.KEY are as with `evaluate`. With task=T the task's expert acts, which is scripted. Without a
graphics card a video shows the first 200 pictures, which take half a minute; episode_steps=N shows
N decisions.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import (
    ROBOT,
    ROBOT_CHANGES,
    SHOWN,
    Argument,
    numbers,
    output,
    read,
    robot,
    whole,
)
from hybrid_rl.errors import UsageError
from hybrid_rl.run.logs.progress import say

if TYPE_CHECKING:
    from hybrid_rl.analysis.drawing import Film
    from hybrid_rl.training.episode import Episode

SIZE = (640, 480)  # [pixels]
ARGUMENTS = (
    *ROBOT,
    Argument("out", "", "the file; empty: DIR/video.mp4 or TASK.mp4"),
    Argument("episode", 0, "number of the evaluation's episode, from 0", whole(least=0)),
    Argument("at", [], "decisions after which a .png shows the episode", numbers(whole(least=0))),
    Argument("episode_steps", 0, "decisions at most; 0: the task's limit, see above", whole()),
    Argument("width", SIZE[0], "of the picture, in pixels", whole(even=True)),
    Argument("height", SIZE[1], "of the picture, in pixels", whole(even=True)),
)


def main() -> None:
    """The command."""
    given, changes = read(__doc__, ARGUMENTS, ROBOT_CHANGES, SHOWN)
    named = robot(given, changes)
    from hybrid_rl.analysis import drawing  # imports JAX, for seconds
    from hybrid_rl.envs.mujoco import offscreen
    from hybrid_rl.run.recording import scripted_expert
    from hybrid_rl.run.retarget import load_changed
    from hybrid_rl.training.rollout import evaluation_keys

    out = _out(given, named)
    offscreen.backend()  # raises before minutes of work
    seed, number, steps = given["seed"], given["episode"], given["episode_steps"]
    if given["task"]:
        world, controller, params = scripted_expert(given, changes)
        seed, by = seed or 0, "scripted expert"
    else:
        trained = load_changed(given, changes)[0]
        print(*(f"{note}\n" for note in trained.notes), sep="", end="")
        world = trained.episode
        controller, params = trained.learner(seed, given["mode"], world=True)
        seed, by = trained.seeds[0] if seed is None else seed, f"step {trained.step:,}"
    key = evaluation_keys(seed, number + 1)[-1]
    say("compiling an episode ...")  # of a planner, a minute
    begun = replace(world, steps=drawing.length(world, steps, out))
    _draw(world, drawing.film(begun, controller, params, key), given, out, by)


def _out(given: dict[str, Any], named: str) -> Path:
    """The file to write."""
    from hybrid_rl.analysis.drawing import SUFFIXES

    default = f"{named}/video.mp4" if given["run"] else f"{Path(named).stem}.mp4"
    out = Path(given["out"] or default)
    if given["out"] or out.parent.is_dir():  # a run that is not there is named later
        output("out", out, SUFFIXES)
    if given["at"] and out.suffix != ".png":
        raise UsageError(f"at={','.join(map(str, given['at']))}: needs out=FILE.png")
    return out


def _draw(world: "Episode", shown: "Film", given: dict[str, Any], out: Path, by: str) -> None:
    """Write an episode of `world`, and print its length and return; by: whose actions."""
    from hybrid_rl.analysis import drawing

    decisions, size = len(shown.poses) - 1, (given["width"], given["height"])
    if given["at"]:
        at = [min(step, decisions) for step in given["at"]]
        drawing.draw_beside(drawing.pictures(world, shown, at, *size), out)
        if late := [str(at) for at in given["at"] if at > decisions]:
            line = f"the episode ends after {decisions} decisions, shown instead"
            print(f"at={','.join(late)}: {line}")
    else:
        drawing.draw_film(world, shown, out, *size)
    ended = {True: ", success", False: ", no success", None: ""}[shown.success]
    print(f"{out}: {decisions} decisions, return {shown.total:,.1f}{ended}, {by}")
    if not given["episode_steps"] and decisions == drawing.length(world, 0, out) < world.steps:
        print(f"the beginning, as there is no graphics card; all: episode_steps={world.steps}")


if __name__ == "__main__":
    command.run(main)
