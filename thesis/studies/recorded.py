"""Runs by labels, and all decisions of one, from the replay memory in its folder."""

from pathlib import Path
from typing import Any, NamedTuple

import jax
import numpy as np

from hybrid_rl.analysis.results import RunFolder, differences, short
from hybrid_rl.data.replay import unpack
from hybrid_rl.errors import UsageError
from hybrid_rl.run.folder import parse_config
from hybrid_rl.run.saved import build_run, restore
from hybrid_rl.settings.build import Run


class Recorded(NamedTuple):
    """A run and its replay memory: S learners, T decisions each, in order."""

    folder: RunFolder
    config: Any
    run: Run
    memory: Any  # [S, ...]
    decisions: int  # T

    @property
    def made(self) -> Any:
        """The decisions [S, T, ...], a Transition of NumPy arrays."""
        rows = self.memory.rows[:, : self.decisions, 0]
        return jax.tree.map(np.asarray, unpack(rows, self.run.agent.spec))


def read(folder: Path, *tasks: str, key: str = "runs") -> Recorded:
    """The run in `folder`, which the argument `key` named, and its memory."""
    config: Any = parse_config(folder, key)
    fits = config.task in tasks or not tasks
    if not fits or config.num_envs != 1 or not config.checkpoint_replay:
        words = f"{' or '.join(tasks)}, " if tasks else ""
        raise UsageError(f"{key}={folder}: needs {words}num_envs=1, checkpoint_replay=true")
    run = build_run(config, "memory")
    memory = restore(folder, run, "memory")[1].memory
    decisions = min(int(np.asarray(memory.count).min()), memory.rows.shape[1])
    return Recorded(RunFolder(folder), config, run, memory, decisions)


def one_episode(recorded: Recorded) -> Any:
    """The decisions of a run whose trials are one episode each."""
    made = recorded.made
    if (made.truncated + made.terminated)[:, :-1].any():
        raise UsageError(
            f"runs={recorded.folder.path}: needs one episode a trial; "
            "train with total_steps = episode.steps and, if the world has it, env.terminate=false"
        )
    return made


def labels(folders: list[Path]) -> list[str]:
    """The method of each run, with the settings in which its runs differ, or else its folder."""
    runs = [RunFolder(folder) for folder in folders]
    algos = [run.word("algo") for run in runs]
    result = [""] * len(runs)
    for algo in set(algos):
        group = [i for i, other in enumerate(algos) if other == algo]
        words = short(differences([runs[i] for i in group]))
        for i, more in zip(group, words, strict=True):
            result[i] = f"{algo} {more}".strip() if "=" in more or not more else folders[i].name
    return [
        label if result.count(label) == 1 else str(folder)
        for label, folder in zip(result, folders, strict=True)
    ]
