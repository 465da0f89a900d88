"""Returns of a trained run, as a table and in DIR/evaluation_<mode>.json.

    python -m hybrid_rl.evaluate run=runs/hopper/sac/TIME mode=policy episodes=20

Without exploration, with the learners as they were at the newest checkpoint.
"""

import json
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from omegaconf import OmegaConf
from rich.console import Console
from rich.table import Table

from hybrid_rl import command
from hybrid_rl import config as configuration
from hybrid_rl.arguments import Argument, read, whole
from hybrid_rl.config import UsageError
from hybrid_rl.training import checkpoint
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.evaluate import evaluation_keys, outcomes
from hybrid_rl.training.loop import Loop
from hybrid_rl.types import Controller, Params

ARGUMENTS = (
    Argument("run", "", "folder of the run", needed="run=DIR, a folder that training wrote"),
    Argument("episodes", 10, "episodes of each seed", whole()),
    Argument("mode", "full", "full: planner and policy together; policy or planner: one alone"),
)


@dataclass(frozen=True)
class Trained:
    """A run, read back."""

    task: str
    episode: Episode
    controllers: dict[str, Controller]  # mode -> controller without exploration
    params: Params  # [S, ...]
    seeds: tuple[int, ...]
    step: int  # decisions of each learner
    notes: tuple[str, ...]  # checkpoints that were passed over


def load(folder: Path) -> Trained:
    """The learners of the run in `folder`, at its newest sound checkpoint.

    Raises:
        UsageError: where `folder` holds no run, or no checkpoint.
        CheckpointError: where none of its checkpoints is sound.
    """
    place = folder / "config.yaml"
    if not place.exists():
        raise UsageError(f"run={folder}: no run folder there (no config.yaml in it)")
    if not checkpoint.steps(folder / "checkpoints"):
        raise UsageError(f"run={folder}: holds no checkpoint yet; train it further first")
    config: Any = OmegaConf.load(place)
    command.prepare(config)
    run = configuration.build(config)
    like = jax.eval_shape(Loop(run.agent, run.seeds, 1).init)
    like = like.replace(env=None, control=None, memory=None, key=None)
    step, state, _, notes = checkpoint.restore(folder / "checkpoints", like, part=True)
    params = jax.vmap(run.agent.params)(state)
    return Trained(
        config.task, run.agent.episode, run.controllers, params, run.seeds, step, tuple(notes)
    )


def evaluate(trained: Trained, mode: str = "full", episodes: int = 10) -> dict[str, np.ndarray]:
    """Undiscounted `return` [S, episodes] of the same episodes as in training.

    Where the task tells it, also `success` [S, episodes], 0 or 1.

    Raises:
        UsageError: for a mode that the method does not have.
    """
    if mode not in trained.controllers:
        raise UsageError(f"mode={mode}: the run has {', '.join(trained.controllers)}")
    keys = jnp.stack([evaluation_keys(seed, episodes) for seed in trained.seeds])
    one = partial(outcomes, trained.episode, trained.controllers[mode])
    got = jax.jit(jax.vmap(one))(trained.params, keys)
    return {name: np.asarray(value) for name, value in got.items()}


def report(trained: Trained, mode: str, got: dict[str, np.ndarray]) -> dict[str, Any]:
    """What evaluation_<mode>.json holds."""
    returns = got["return"]
    success = {"success": got["success"].mean(1).tolist()} if "success" in got else {}
    return {
        "mode": mode,
        "step": trained.step,
        "seeds": list(trained.seeds),
        "episodes": returns.shape[1],
        "mean": returns.mean(1).tolist(),
        "std": returns.std(1).tolist(),
        **success,
        "returns": returns.tolist(),
    }


def main() -> None:
    """The command."""
    given, _ = read(__doc__, ARGUMENTS)
    episodes = given["episodes"]
    trained = load(Path(given["run"]))
    console = Console()
    for note in trained.notes:
        console.print(note, markup=False)
    said = report(trained, given["mode"], evaluate(trained, given["mode"], episodes))
    out = Path(given["run"]) / f"evaluation_{given['mode']}.json"
    out.write_text(json.dumps(said, indent=1) + "\n", encoding="utf-8")
    table = Table(title=f"{given['run']}, mode {given['mode']}, step {trained.step:,}")
    shares = said.get("success", [])
    columns = ("seed", "mean return", "std", "lowest", "highest", *["successes"][: len(shares)])
    for name in columns:
        table.add_column(name, justify="right")
    for i, (seed, each) in enumerate(zip(said["seeds"], said["returns"], strict=True)):
        numbers = (np.mean(each), np.std(each), min(each), max(each))
        row = [f"{value:,.1f}" for value in numbers] + [
            f"{share:.0%}" for share in shares[i : i + 1]
        ]
        table.add_row(str(seed), *row)
    console.print(table)
    console.print(f"{episodes} episodes a seed; written to {out}", markup=False)


if __name__ == "__main__":
    command.guarded(main)
