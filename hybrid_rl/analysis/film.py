"""Films of one episode: of a simulated world, or of a Gymnasium environment, which draws itself."""

from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import jax
import numpy as np

from hybrid_rl.analysis import drawing
from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.envs.mujoco.scenery import check_drawable, pose_of, scene_of
from hybrid_rl.outside.acting import TrainedPolicy
from hybrid_rl.outside.host_loop import seed_of
from hybrid_rl.training.rollout import evaluation_keys, rollout

FASTEST = 60.0  # [1/s] pictures at most; faster worlds skip some
FIRST = 200  # pictures of a video that the processor draws, unless a length is asked for


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
    seed = int(trained.seeds[0]) if seed is None else seed
    world = replace(trained.episode, steps=steps or trained.episode.steps)
    controller, params = trained.learner(seed, mode, world=True)
    return film(world, controller, params, evaluation_keys(seed, number + 1)[-1])


def film(world: Any, controller: Any, params: Any, key: Any) -> Film:
    """One episode of `world` under `controller` with `params`; UsageError if it has no scene."""
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
    """Write an episode of `world` to a file of one of drawing.SUFFIXES, in real time."""
    stride = _stride(world)
    rate = 1 / (world.spec.dt * stride)
    drawing.draw(scene_of(world.env), shown.poses[::stride], out, rate, width, height)


def draw_beside(world: Any, poses: np.ndarray, out: Path, width: int, height: int) -> None:
    """Write the picture of some poses [N, nq] of `world`, side by side."""
    drawing.draw_beside(scene_of(world.env), poses, out, width, height)


def _stride(world: Any) -> int:
    """Decisions from one picture to the next."""
    return int(np.ceil(1 / world.spec.dt / FASTEST))


def length(world: Any, asked: int, out: Path) -> int:
    """Decisions of `world` at most; asked: by the user, 0 for the default."""
    if asked or out.suffix == ".png" or not offscreen.by_processor():
        return asked or world.steps
    return min(world.steps, FIRST * _stride(world))


def draw_outside(
    world: Any, controller: Any, params: Any, key: Any, steps: int, out: Path
) -> tuple[int, float]:
    """Draw an episode of a Gymnasium environment, `steps` decisions at most; (pictures, return)."""
    policy = TrainedPolicy(world.spec, controller, params)
    seeds = [seed_of(*map(int, jax.random.key_data(key)))]
    offscreen.lend()
    copies = world.env.copies(seeds, world.steps, world.action_repeat, "rgb_array")
    obs, total, pictures = copies.reset()[0], 0.0, [copies.picture()]
    for _ in range(steps or world.steps):
        got = copies.step(policy(obs)[None])
        obs, total = got.following[0], total + float(got.reward[0])
        if got.terminated[0] or got.truncated[0]:
            break
        pictures.append(copies.picture())
    copies.close()
    fps = 1 / world.spec.dt
    drawing.write(out, len(pictures), fps, lambda shown, smooth: [pictures[i] for i in shown])
    return len(pictures), total
