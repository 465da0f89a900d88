"""A video of one episode of a trained run, without a display.

    python -m hybrid_rl.render run=DIR [out=DIR/video.mp4] [mode=full] [seed=] [episode_steps=]
    python -m hybrid_rl.render policy=NAME [out=NAME.mp4] [episode_steps=]
    python -m hybrid_rl.render policy=halfcheetah reward=speed reward.target=2
    python -m hybrid_rl.render run=DIR mode=training [seed=] [out=X.mp4]
    python -m hybrid_rl.render task=T [out=T.mp4] [seed=0] [episode_steps=] [env.KEY=VALUE ...]

`out` ends in .mp4 or .gif for a video, in .png for the picture halfway through the episode, or
with at=0,20,40 for those after so many decisions, side by side.

The episode is one of the run's own evaluation, the first unless episode=N: same key, no
exploration. policy=NAME is a trained policy of policies/, or a file. reward, planner, env.KEY and
episode.KEY are as with `evaluate`. With task=T the task's expert acts, which is scripted. Without a
graphics card a video shows the first 200 pictures, which take half a minute; episode_steps=N shows
N decisions.

mode=training is the first episode of training of a method that learns a belief over two
coordinates, such as a map of contacts. A panel, as wide as the picture is high, shows what the
belief had learned by then. A .png is the picture at the end.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import (
    ROBOT,
    ROBOT_CHANGES,
    Argument,
    numbers,
    output,
    read,
    robot,
    whole,
)
from hybrid_rl.errors import UsageError
from hybrid_rl.run.logs.progress import say

ARGUMENTS = (
    *ROBOT,
    Argument("out", "", "the file; empty: DIR/video.mp4 or TASK.mp4"),
    Argument("episode", 0, "number of the evaluation's episode, from 0", whole(least=0)),
    Argument("at", [], "decisions after which a .png shows the episode", numbers(whole(least=0))),
    Argument("episode_steps", 0, "decisions at most; 0: the task's limit, see above", whole()),
    Argument("width", 640, "of the picture, in pixels", whole(even=True)),
    Argument("height", 480, "of the picture, in pixels", whole(even=True)),
)
FAR = 0.01  # of an observation in a replayed scene; more is reported
FASTEST = 60.0  # [1/s] pictures at most; faster worlds skip some
FIRST = 200  # pictures of a video that the processor draws, unless episode_steps is given


class Film(NamedTuple):
    """One episode, to be drawn."""

    poses: np.ndarray  # [frames, nq]
    total: float  # undiscounted return
    success: bool | None  # at the end; None: the task has no measure of it


def episode(
    trained: Any, mode: str = "full", seed: int | None = None, steps: int = 0, number: int = 0
) -> Film:
    """One episode of a loaded run.

    trained: what `hybrid_rl.run.saved.load` returns. seed: of one of its learners; None is
    the first. steps: at most this many decisions; 0 is the task's own limit. number: of the
    evaluation's episode, from 0.
    """
    from hybrid_rl.training.rollout import evaluation_keys

    seed = int(trained.seeds[0]) if seed is None else seed
    world = replace(trained.episode, steps=steps or trained.episode.steps)
    controller, params = trained.learner(seed, mode, world=True)
    return film(world, controller, params, evaluation_keys(seed, number + 1)[-1])


def film(world: Any, controller: Any, params: Any, key: Any) -> Film:
    """One episode of `world` under `controller` with `params`."""
    import jax

    from hybrid_rl.envs.mujoco.scenery import pose_of
    from hybrid_rl.training.rollout import rollout

    def go(params: Any, key: Any) -> tuple:
        states = rollout(world, controller, params, key, world.steps)
        poses = jax.vmap(pose_of(world.env))(states)
        return poses, states.done, states.clock.total, states.metrics.get("success")

    poses, done, returns, success = jax.jit(go)(params, key)
    last = int(np.argmax(done)) if np.any(done) else world.steps
    succeeded = None if success is None else bool(success[last])
    return Film(np.asarray(poses)[: last + 1], float(returns[last]), succeeded)


def draw_film(world: Any, shown: Film, out: Path, width: int = 640, height: int = 480) -> None:
    """Write an episode of `world` to a file of one of drawing.SUFFIXES, in real time."""
    from hybrid_rl.analysis.drawing import draw
    from hybrid_rl.envs.mujoco.scenery import scene_of

    stride = _stride(world)
    rate = 1 / (world.spec.dt * stride)
    draw(scene_of(world.env), shown.poses[::stride], out, rate, width, height)


def _stride(world: Any) -> int:
    """Decisions from one picture to the next."""
    return int(np.ceil(1 / world.spec.dt / FASTEST))


def _steps(world: Any, asked: int, out: Path) -> int:
    """Decisions of `world` at most; asked: by the user, 0 for the default."""
    from hybrid_rl.envs.mujoco import offscreen

    if asked or out.suffix == ".png" or not offscreen.by_processor():
        return asked or world.steps
    return min(world.steps, FIRST * _stride(world))


def _episode_of(
    given: dict[str, Any], changes: dict[str, str], out: Path, trained: Any
) -> tuple[Any, str, Film]:
    """(world with its clock, whose actions, episode) that the arguments name.

    trained: None with task=T.
    """
    from hybrid_rl.envs.mujoco.scenery import check_drawable

    seed, asked, number = (given[name] for name in ("seed", "episode_steps", "episode"))
    if trained is None:
        from hybrid_rl.demonstrate import scripted_expert
        from hybrid_rl.training.rollout import evaluation_keys

        world, controller, params = scripted_expert(given, changes)
        check_drawable(world.env)
        begun = replace(world, steps=_steps(world, asked, out))
        key = evaluation_keys(seed or 0, number + 1)[-1]
        return world, "scripted expert", film(begun, controller, params, key)
    check_drawable(trained.episode.env)
    steps = _steps(trained.episode, asked, out)
    shown = episode(trained, given["mode"], seed, steps, number)
    return trained.episode, f"step {trained.step:,}", shown


def _outside(trained: Any, given: dict[str, Any], out: Path) -> None:
    """Draw an episode of a Gymnasium environment, which draws itself."""
    import jax

    from hybrid_rl.analysis.drawing import write
    from hybrid_rl.envs.mujoco import offscreen
    from hybrid_rl.outside.acting import TrainedPolicy
    from hybrid_rl.outside.host_loop import seed_of
    from hybrid_rl.training.rollout import evaluation_keys

    if given["at"] or (given["width"], given["height"]) != (640, 480):
        raise UsageError("at, width, height: a Gymnasium environment draws itself in its own size")
    seed, world = given["seed"], trained.episode
    policy = TrainedPolicy(world.spec, *trained.learner(seed, given["mode"]))
    key = evaluation_keys(trained.seeds[0] if seed is None else seed, given["episode"] + 1)[-1]
    seeds = [seed_of(*map(int, jax.random.key_data(key)))]
    offscreen.lend()
    copies = world.env.copies(seeds, world.steps, world.action_repeat, "rgb_array")
    obs, total, pictures = copies.reset()[0], 0.0, [copies.picture()]
    for _ in range(given["episode_steps"] or world.steps):
        got = copies.step(policy(obs)[None])
        obs, total = got.following[0], total + float(got.reward[0])
        if got.terminated[0] or got.truncated[0]:
            break
        pictures.append(copies.picture())
    copies.close()
    fps = 1 / world.spec.dt
    write(out, len(pictures), fps, lambda shown, smooth: [pictures[i] for i in shown])
    print(f"{out}: {len(pictures)} pictures, return {total:,.1f}, step {trained.step:,}")


def _training(
    folder: Path, seed: int | None, steps: int, out: Path, width: int, height: int
) -> None:
    """Draw the first episode of training, with the belief at the right."""
    from hybrid_rl.analysis.drawing import draw
    from hybrid_rl.envs.mujoco.scenery import check_drawable, scene_of
    from hybrid_rl.thesis.studies.belief_video import MOST, film

    shown = film(folder, seed, steps, height, MOST[out.suffix])
    check_drawable(shown.world)
    draw(scene_of(shown.world), shown.poses, out, shown.fps, width, height, shown.panel)
    speed = "" if out.suffix == ".png" else f", {shown.speed:.2g} times real time"
    print(f"{out}: {shown.decisions} decisions, return {shown.total:,.1f}, of training{speed}")
    if shown.apart > FAR:
        print(f"the scene differs by up to {shown.apart:.2g} from the recorded observations")


def main() -> None:
    """The command."""
    given, changes = read(__doc__, ARGUMENTS, ROBOT_CHANGES)
    named = robot(given, changes)
    from hybrid_rl.analysis.drawing import SUFFIXES, draw_beside
    from hybrid_rl.envs.adapters.external import External
    from hybrid_rl.envs.mujoco import offscreen
    from hybrid_rl.envs.mujoco.scenery import scene_of
    from hybrid_rl.run.retarget import load_changed

    default = f"{named}/video.mp4" if given["run"] else f"{Path(named).stem}.mp4"
    out = Path(given["out"] or default)
    if given["out"] or out.parent.is_dir():  # a run that is not there is named below
        output("out", out, SUFFIXES)
    if given["at"] and out.suffix != ".png":
        raise UsageError(f"at={','.join(map(str, given['at']))}: needs out=FILE.png")
    width, height = given["width"], given["height"]
    offscreen.backend()  # raises before minutes of work
    offscreen.check_size(width, height)

    if given["mode"] == "training" and given["run"]:
        _training(Path(given["run"]), given["seed"], given["episode_steps"], out, width, height)
        return
    trained = None if given["task"] else load_changed(given, changes)[0]
    for note in trained.notes if trained is not None else ():
        print(note)
    if trained is not None and isinstance(trained.episode.env, External):
        _outside(trained, given, out)
        return
    if trained is not None:
        trained.learner(given["seed"], given["mode"], world=True)  # refuses what it lacks
    say("compiling an episode ...")  # of a planner, a minute
    world, by, shown = _episode_of(given, changes, out, trained)
    if given["at"]:
        last = len(shown.poses) - 1
        poses = shown.poses[np.minimum(given["at"], last)]
        draw_beside(scene_of(world.env), poses, out, width, height)
        if late := [str(at) for at in given["at"] if at > last]:
            print(f"at={','.join(late)}: the episode ends after {last} decisions, shown instead")
    else:
        draw_film(world, shown, out, width, height)
    ended = {True: ", success", False: ", no success", None: ""}[shown.success]
    decisions = len(shown.poses) - 1
    print(f"{out}: {decisions} decisions, return {shown.total:,.1f}{ended}, {by}")
    if not given["episode_steps"] and decisions == _steps(world, 0, out) < world.steps:
        print(f"the beginning, as there is no graphics card; all: episode_steps={world.steps}")


if __name__ == "__main__":
    command.run(main)
