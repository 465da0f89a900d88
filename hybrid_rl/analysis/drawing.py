"""Pictures without a display: positions of a MuJoCo scene, and films of one episode.

A film is of a simulated world, or of a Gymnasium environment, which draws itself.
"""

import contextlib
import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import jax
import numpy as np

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.envs.mujoco.offscreen import Canvas
from hybrid_rl.envs.mujoco.scenery import check_drawable, pose_of, scene_of
from hybrid_rl.files.atomic import replacing
from hybrid_rl.outside.acting import TrainedPolicy
from hybrid_rl.outside.host_loop import copies_of, seed_of
from hybrid_rl.run.logs.progress import Progress
from hybrid_rl.training.rollout import evaluation_keys, rollout

FASTEST = 60.0  # [1/s] pictures at most; faster worlds skip some
FIRST = 200  # pictures of a video that the processor draws, unless a length is asked for
SUFFIXES = (".mp4", ".gif", ".png")
GIF_FPS = 20.0  # [1/s] at most


def write(
    out: Path, count: int, fps: float, pictures: Callable[[Sequence[int], bool], Iterable[Any]]
) -> Path:
    """Writes a video, H.264 for .mp4, endless for .gif; for .png the picture halfway of `count`.

    pictures: of (which of them, whether the picture is one of a .png) the pictures, even in size.
    """
    shown = range(count)
    if out.suffix == ".gif" and fps > GIF_FPS:
        stride = int(np.ceil(fps / GIF_FPS))
        shown, fps = shown[::stride], fps / stride
    if out.suffix == ".png":
        shown = range(count // 2, count // 2 + 1)
    out.parent.mkdir(parents=True, exist_ok=True)
    drawn = _counted(pictures(shown, out.suffix == ".png"), len(shown))
    to = {".mp4": _write_mp4, ".gif": _write_gif, ".png": _write_png}[out.suffix]
    with replacing(out) as draft:
        to(draft, drawn, fps)
    return out


def draw_beside(pictures: Iterable[np.ndarray], out: Path) -> None:
    """Writes a .png of one picture beside the other."""
    with replacing(out) as draft:
        _write_png(draft, [np.hstack(list(pictures))], 0.0)


def frames(
    scene: str, qpos: np.ndarray, width: int = 640, height: int = 480, smooth: bool = True
) -> Iterator[np.ndarray]:
    """One picture [height, width, 3] (uint8) for each row of qpos [frames, nq]."""
    with contextlib.closing(Canvas(scene, width, height, smooth)) as canvas:
        yield from map(canvas.draw, qpos)


def _counted(pictures: Iterable[np.ndarray], total: int) -> Iterator[np.ndarray]:
    """The same pictures, with progress on the terminal."""
    with Progress(total, label="drawing") as progress:
        for number, picture in enumerate(pictures, 1):
            yield picture
            progress.update(number, {})


def _write_mp4(out: Path, pictures: Iterable[np.ndarray], fps: float) -> None:
    import imageio.v3 as iio

    made = io.BytesIO()  # as pyav does not close a file on a full disk
    with iio.imopen(made, "w", plugin="pyav", extension=".mp4") as video:
        video.init_video_stream("libx264", fps=fps, pixel_format="yuv420p")
        for picture in pictures:
            video.write_frame(picture)
    out.write_bytes(made.getvalue())


def _write_gif(out: Path, pictures: Iterable[np.ndarray], fps: float) -> None:
    from PIL import Image

    first, *rest = (
        Image.fromarray(picture).quantize(128, dither=Image.Dither.NONE) for picture in pictures
    )
    first.save(out, save_all=True, append_images=rest, duration=1000 / fps, loop=0)


def _write_png(out: Path, pictures: Iterable[np.ndarray], fps: float) -> None:
    import imageio.v3 as iio

    for picture in pictures:
        iio.imwrite(out, picture)


class Film(NamedTuple):
    """One episode, to be drawn."""

    poses: Any  # [frames, nq]; of a Gymnasium environment a list of pictures, which it drew itself
    total: float  # undiscounted return
    success: bool | None  # at the end; None: the task has no measure of it


def episode(trained: Any, mode: str = "full", seed: int | None = None, steps: int = 0) -> Film:
    """The first evaluation episode of a loaded run.

    trained: what `hybrid_rl.run.saved.load` returns. seed: of one of its learners; None is
    the first. steps: at most this many decisions; 0 is the task's own limit.
    """
    seed = int(trained.seeds[0]) if seed is None else seed
    world = replace(trained.episode, steps=steps or trained.episode.steps)
    controller, params = trained.learner(seed, mode, world=True)
    return film(world, controller, params, evaluation_keys(seed, 1)[0])


def film(world: Any, controller: Any, params: Any, key: Any) -> Film:
    """One episode of `world` under `controller` with `params`; UsageError if it has no scene."""
    if isinstance(world.env, External):
        return _outside(world, controller, params, key)
    check_drawable(world.env)

    def go(params: Any, key: Any) -> tuple:
        states = rollout(world, controller, params, key, world.steps)
        poses = jax.vmap(pose_of(world.env))(states)
        return poses, states.done, states.clock.total, states.metrics.get("success")

    poses, done, returns, success = jax.jit(go)(params, key)
    last = int(np.argmax(done)) if np.any(done) else world.steps
    succeeded = None if success is None else bool(success[last])
    return Film(np.asarray(poses)[: last + 1], float(returns[last]), succeeded)


def draw_film(world: Any, shown: Film, out: Path, width: int = 640, height: int = 480) -> None:
    """Write an episode of `world` to a file of one of SUFFIXES, in real time."""
    stride = _stride(world)
    steps = range(0, len(shown.poses), stride)

    def drawn(which: Sequence[int], smooth: bool) -> Iterable[np.ndarray]:
        return pictures(world, shown, [steps[i] for i in which], width, height, smooth)

    write(out, len(steps), 1 / (world.spec.dt * stride), drawn)


def pictures(
    world: Any, shown: Film, at: Sequence[int], width: int, height: int, smooth: bool = True
) -> Iterable[np.ndarray]:
    """An episode of `world` after these decisions."""
    poses = [shown.poses[i] for i in at]
    if isinstance(world.env, External):
        return poses
    return frames(scene_of(world.env), np.array(poses), width, height, smooth)


def _stride(world: Any) -> int:
    """Decisions from one picture to the next."""
    return int(np.ceil(1 / world.spec.dt / FASTEST))


def length(world: Any, asked: int, out: Path) -> int:
    """Decisions of `world` at most; asked: by the user, 0 for the default."""
    drawn = isinstance(world.env, External) or not offscreen.by_processor()  # fast enough
    if asked or out.suffix == ".png" or drawn:
        return asked or world.steps
    return min(world.steps, FIRST * _stride(world))


def _outside(world: Any, controller: Any, params: Any, key: Any) -> Film:
    """An episode of a Gymnasium environment, without a picture of its end."""
    policy = TrainedPolicy(world.spec, controller, params)
    seeds = [seed_of(*map(int, jax.random.key_data(key)))]
    offscreen.lend()
    copies = copies_of(world, seeds, "rgb_array")
    obs, total, pictures, done = copies.reset()[0], 0.0, [copies.picture()], False
    while not done:
        got = copies.step(policy(obs)[None])
        obs, total = np.asarray(got.following[0]), total + float(got.reward[0])
        done = bool(got.terminated[0] or got.truncated[0])
        pictures.append(pictures[-1] if done else copies.picture())
    success = None if copies.success is None else bool(copies.success[0])
    copies.close()
    return Film(pictures, total, success)
