"""A run or a policy as a tool reads it: its parts and decisions, newer checkpoints, a film."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.analysis.drawing import SUFFIXES, Film, draw_film, episode
from hybrid_rl.analysis.results import RunFolder, find
from hybrid_rl.cli.arguments import output
from hybrid_rl.data.replay import unpack
from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.errors import CheckpointError
from hybrid_rl.protocols import Controller
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.checkpoints.store import read_parts
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.run.recording import scripted_expert
from hybrid_rl.run.saved import Trained, build_run, restore
from hybrid_rl.run.saved import names as policies
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.groups import options
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Transition


def expert(
    task: str, overrides: Sequence[str] = (), config_dir: str | Path | None = None
) -> tuple[Episode, Controller]:
    """The episodes of a task, and its scripted expert, which has no parameters.

    overrides: of env.KEY, episode.KEY and expert.KEY; expert=NAME is another one.
    """
    given = {"task": task, "expert": "", "config_dir": config_dir}
    return scripted_expert(given, dict(text.split("=", 1) for text in overrides))[:2]


def names(group: str) -> list[str]:
    """The names that GROUP=NAME takes, such as those of task, algo, reward; `policies`: trained."""
    return policies() if group == "policies" else options(group)


def runs(folders: str | Path, key: str = "runs") -> list[RunFolder]:
    """The runs in a folder, or in those that a pattern matches: their rows, settings and summary.

    key: the argument of a command that named them, for its UsageError.
    """
    return [RunFolder(path) for path in find(folders, key)]


def rebuilt(run: str | Path) -> Run:
    """The parts of a run as its config.yaml has them: what acts, learns and remembers."""
    config = run_folder.read(Path(run), "run")
    with run_folder.blame_config(Path(run)):
        prepare(config)
        return build_run(config, "memory")


def decisions(run: str | Path, parts: Run | None = None) -> Transition | None:
    """The decisions in the replay memory of a run's newest sound checkpoint, oldest first.

    [K, T, ...], a sequence for each learner and environment; None: no checkpoint has them.
    parts: those of `rebuilt`, where they are known.
    """
    parts = parts or rebuilt(run)
    if not parts.config.checkpoint_replay:
        return None
    try:
        memory = restore(Path(run), parts, "memory")[1].memory
    except CheckpointError:
        return None
    rows, count = np.asarray(memory.rows), int(np.min(memory.count))
    length = rows.shape[1]
    if count > length:  # the ring is full: from the oldest on
        rows = np.roll(rows, -(count % length), axis=1)
    rows = rows[:, :count].swapaxes(1, 2)
    made = unpack(jnp.asarray(rows.reshape(-1, *rows.shape[2:])), parts.agent.spec)
    return jax.tree.map(np.asarray, made)


def newest(trained: Trained, run: str | Path) -> Trained | None:
    """`trained` at a newer checkpoint that the run has written since; None: there is none."""
    folder, agent = Path(run) / "checkpoints", trained.agent
    if agent is None or not any(step > trained.step for step in checkpoint.steps(folder)):
        return None
    step, state, *_ = read_parts(folder, agent, trained.seeds, ["learners"])
    params = jax.vmap(agent.params, axis_size=len(trained.seeds))(state)
    return replace(trained, params=params, step=step)


def film(
    trained: Trained, out: str | Path, mode: str = "full", seed: int | None = None, steps: int = 0
) -> Film:
    """Write the first evaluation episode as a video, a GIF or a picture: its poses and return.

    seed: of a learner; None: the first. steps: decisions at most; 0: the task's limit.

    Raises:
        OSError: if nothing on this machine draws without a display.
    """
    path = output("out", out, SUFFIXES)
    offscreen.backend()
    shown = episode(trained, mode, seed, steps)
    draw_film(trained.episode, shown, path)
    return shown
