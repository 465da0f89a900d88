"""Returns of a trained run, as a table and in DIR/evaluation_<mode>.json.

    python -m hybrid_rl.evaluate run=runs/hopper/sac/TIME mode=policy episodes=20
    python -m hybrid_rl.evaluate policy=halfcheetah
    python -m hybrid_rl.evaluate policy=halfcheetah episode.delay=1 episode.sensor_noise=0.01

With env.KEY=VALUE or episode.KEY=VALUE the world differs from that of the training, and the
controller does not; the file is then DIR/evaluation_<mode>_<changes>.json.

Without exploration, with the learners as they were at the newest checkpoint. From Python, `load`
reads a run back, `evaluate` gives its returns, and `Trained.policy` its actions, in any loop that
has observations:

    policy = load("runs/hopper/sac/TIME").policy(seed=0)
    policy.reset()  # at the start of every episode
    action = policy(obs)  # [m] in [-1, 1]
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import json
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from omegaconf import DictConfig
from rich.console import Console
from rich.table import Table

from hybrid_rl import config as configuration
from hybrid_rl.checks import check
from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import POLICY, Argument, read, whole
from hybrid_rl.core import branching
from hybrid_rl.errors import UsageError
from hybrid_rl.protocols import Controller
from hybrid_rl.run import checkpoint, memory
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.integrity import write_text
from hybrid_rl.run.jax_settings import prepare
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loop import Loop
from hybrid_rl.training.rollout import evaluate_episodes, evaluation_keys
from hybrid_rl.types import Params, Spec

GROUPS = {name: f"another value of a key of its {name}" for name in ("env", "episode")}
ARGUMENTS = (
    Argument("run", "", "folder of the run"),
    POLICY,
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
    notes: tuple[str, ...]  # one for each checkpoint that was skipped
    config: DictConfig | None = None  # of the run; env and episode at least

    def policy(self, seed: int | None = None, mode: str = "full", key: int = 0) -> "TrainedPolicy":
        """Observations to actions, as the learner of `seed` acts; None is the first.

        key: seed of the planner's random numbers.

        Raises:
            UsageError: for a seed or a mode that the run does not have.
        """
        return TrainedPolicy(self.episode.spec, *self.learner(seed, mode), key)

    def learner(self, seed: int | None = None, mode: str = "full") -> tuple[Controller, Params]:
        """The controller of `mode` and the parameters of the learner of `seed`; None: the first.

        Raises:
            UsageError: for a seed or a mode that the run does not have, or a mode that does not
                act by observations.
        """
        seed = self.seeds[0] if seed is None else seed
        if seed not in self.seeds:
            raise UsageError(f"seed={seed}: the run has {', '.join(map(str, self.seeds))}")
        if mode not in self.controllers:
            raise UsageError(f"mode={mode}: the run has {', '.join(self.controllers)}")
        if getattr(self.controllers[mode], "needs_world", False):
            raise UsageError(
                f"mode={mode}: plans from the state of the world (model=world), which observations "
                "do not give; use evaluate or render"
            )
        params: Any = jax.tree.map(lambda leaf: leaf[self.seeds.index(seed)], self.params)
        return self.controllers[mode], params


class TrainedPolicy:
    """action = policy(obs): a trained controller without exploration, for one world or N.

    obs is [o], or [N, o] of N worlds side by side; the action is [m] or [N, m], in [-1, 1]. A
    planner keeps its plan from one call to the next, so call `reset` when an episode begins.
    """

    def __init__(self, spec: Spec, controller: Controller, params: Params, key: int = 0) -> None:
        self.spec, self._key = spec, jax.random.key(key)
        self._begin = partial(controller.init, spec)
        self._state: Any = None  # [N, ...]; None: an episode begins
        self._worlds = 0  # N

        def act(state: Any, obs: Array, key: Array) -> tuple[Array, Any, Array]:
            key, *keys = jax.random.split(key, 1 + len(obs))
            each = jax.vmap(controller.act, (None, 0, 0, 0))
            u, state, _ = each(params, state, obs, jnp.stack(keys))
            return u, state, key

        self._act = jax.jit(act)

    def reset(self, where: np.ndarray | None = None) -> None:
        """Begin an episode; where: [N] bool, only in these worlds."""
        if where is None:
            self._state = None
        elif self._state is not None:
            self._state = branching.where(jnp.asarray(where), self._begin(), self._state)

    def __call__(self, obs: np.ndarray) -> np.ndarray:
        """The action [m] at obs [o], or actions [N, m] at [N, o].

        Raises:
            ValueError: for observations of another size, or another N than since the reset.
        """
        obs = np.asarray(obs, np.float32)
        o = self.spec.obs
        if obs.ndim not in (1, 2) or obs.shape[-1] != o:
            raise ValueError(f"obs is {obs.shape}; it must be [{o}] or [N, {o}]")
        rows = np.atleast_2d(obs)
        if self._state is None:
            self._worlds = len(rows)
            self._state = jax.tree.map(
                lambda leaf: jnp.broadcast_to(leaf, (len(rows), *leaf.shape)), self._begin()
            )
        if len(rows) != self._worlds:
            raise ValueError(f"obs of {len(rows)} worlds after {self._worlds}; reset() first")
        u, self._state, self._key = self._act(self._state, rows, self._key)
        return np.asarray(u).reshape(*obs.shape[:-1], self.spec.act)


def load(folder: Path | str) -> Trained:
    """The learners of the run in `folder`, at its newest sound checkpoint.

    Raises:
        UsageError: if `folder` holds no run, a damaged configuration, or no checkpoint.
        CheckpointError: if none of its checkpoints is sound.
    """
    folder = Path(folder)
    config = run_folder.read(folder, "run")
    if not checkpoint.steps(folder / "checkpoints"):
        raise UsageError(f"run={folder}: holds no checkpoint yet; train it further first")
    with run_folder.blamed(folder):
        check(config)
        prepare(config)
        run = configuration.build(_without_demonstrations(config))
        like = jax.eval_shape(Loop(run.agent, run.seeds, 1).init)
        like = like.replace(env=None, control=None, memory=None, key=None)
        step, state, _, notes = checkpoint.restore(folder / "checkpoints", like, part=True)
    params = jax.vmap(run.agent.params, axis_size=len(run.seeds))(state)  # state may be empty
    return Trained(
        config.task,
        run.agent.episode,
        run.controllers,
        params,
        run.seeds,
        step,
        tuple(notes),
        config,
    )


def _without_demonstrations(config: Any) -> Any:
    """The configuration without files of demonstrations, which evaluation does not need."""
    config = config.copy()
    config.pretrain = 0
    for part in (config.replay, *config.learners.values()):
        if part is not None and "demonstrations" in part:
            part.demonstrations = None
    return config


def evaluate(trained: Trained, mode: str = "full", episodes: int = 10) -> dict[str, np.ndarray]:
    """Undiscounted `return` [S, episodes] of the same episodes as in training.

    If the task measures it, also `success` [S, episodes], 0 or 1.

    Raises:
        UsageError: for a mode that the method does not have.
    """
    if mode not in trained.controllers:
        raise UsageError(f"mode={mode}: the run has {', '.join(trained.controllers)}")
    modes = [trained.controllers[mode]]
    memory.episodes("episodes", episodes, len(trained.seeds), trained.episode, modes)
    keys = jnp.stack([evaluation_keys(seed, episodes) for seed in trained.seeds])
    one = partial(evaluate_episodes, trained.episode, trained.controllers[mode])
    got = jax.jit(jax.vmap(one))(trained.params, keys)
    return {name: np.asarray(value) for name, value in got.items()}


def report(trained: Trained, mode: str, got: dict[str, np.ndarray]) -> dict[str, Any]:
    """What evaluation_<mode>.json holds."""
    returns = got["return"]
    success = {}
    if "success" in got:
        each = got["success"]
        success = {"success": each.mean(1).tolist(), "succeeded": each.astype(bool).tolist()}
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
    from hybrid_rl import pretrained

    given, changes = read(__doc__, ARGUMENTS, GROUPS)
    episodes, name = given["episodes"], given["run"] or given["policy"]
    trained = pretrained.chosen(given)
    if changes:
        assert trained.config is not None
        trained = replace(trained, episode=configuration.disturbed(trained.config, changes))
    for note in trained.notes:
        print(note)
    values = report(trained, given["mode"], evaluate(trained, given["mode"], episodes))
    values["changes"] = changes
    where = "".join(f", {key}={value}" for key, value in changes.items())
    print(f"{name}, mode {given['mode']}, step {trained.step:,}{where}")  # whole, also in a pipe
    Console().print(_table(values))
    if not given["run"]:
        return
    stem = "_".join([given["mode"], *(f"{key}={value}" for key, value in changes.items())])
    out = Path(given["run"]) / f"evaluation_{stem}.json"
    try:
        write_text(out, json.dumps(values, indent=1) + "\n")
        print(f"{episodes} episodes a seed; written to {out}")
    except OSError as error:  # the run of somebody else, say
        print(f"{episodes} episodes a seed; not written: {out}: {error.strerror}")


def _table(values: dict[str, Any]) -> Table:
    """A row for each seed, and one for the episodes of all of them."""
    table = Table()
    shares = values.get("success", [])
    columns = ("seed", "mean return", "std", "lowest", "highest", *["successes"][: len(shares)])
    for name in columns:
        table.add_column(name, justify="right")
    lines = [
        (str(seed), each, shares[i : i + 1])
        for i, (seed, each) in enumerate(zip(values["seeds"], values["returns"], strict=True))
    ]
    if len(lines) > 1:
        lines.append(("all", np.ravel(values["returns"]), [np.mean(shares)] if shares else []))
    for name, each, share in lines:
        numbers = (np.mean(each), np.std(each), np.min(each), np.max(each))
        row = [f"{value:,.1f}" for value in numbers] + [f"{part:.0%}" for part in share]
        table.add_row(name, *row, end_section=len(lines) > 1 and name == lines[-2][0])
    return table


if __name__ == "__main__":
    command.guarded(main)
