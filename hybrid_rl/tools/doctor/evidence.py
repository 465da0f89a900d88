"""What the checks read of a run: rows, settings, and the decisions in its replay memory.

Decisions are K sequences of T, one for each learner and environment, oldest first.

What a learner has learned is examined in the evidence of that learner alone, for the first
LEARNERS of a run (`of_each`).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import jax
import numpy as np

from hybrid_rl import CheckpointError, Trained, load
from hybrid_rl.analysis.held_out import RandomActions
from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.data.replay import unpack
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.run.saved import build_run, restore
from hybrid_rl.settings.build import Run
from hybrid_rl.tools.doctor.tried import Tried, episodes
from hybrid_rl.types import Params, Transition

LEARNERS = 4  # of a run that are examined one by one
LONGER = 4  # time limits that an episode of the policy lasts
MOST = 12_000  # decisions of a regression, the newest ones
STILL = 1e-6  # std of an entry, over its size, below which it does not change


@dataclass(frozen=True)
class Evidence:
    """A run, as far as its folder holds it."""

    folder: RunFolder
    config: Any  # of config.yaml
    run: Run
    made: Transition | None  # [K, T, ...] NumPy; None: no checkpoint has the replay memory
    whole: "Evidence | None" = None  # of the run, of which this is a learner's part
    learner: int = 0  # its number; of the run the first one's
    damaged: bool = False  # whether the replay memory has numbers that are not finite

    @property
    def path(self) -> Path:
        """The run folder."""
        return self.folder.path

    @cached_property
    def begins(self) -> np.ndarray:
        """[K, T] whether a decision is the first of its episode, or of the memory."""
        assert self.made is not None
        over = (self.made.terminated + self.made.truncated) > 0
        return np.concatenate((np.ones_like(over[:, :1]), over[:, :-1]), axis=1)

    @cached_property
    def moving(self) -> np.ndarray:
        """[o] the entries of the observation that change."""
        assert self.made is not None
        obs = self.made.obs.reshape(-1, self.made.obs.shape[-1])
        return np.flatnonzero(obs.std(0) > STILL * (1 + abs(obs).max(0)))

    @cached_property
    def _shown(self) -> np.ndarray:
        """[K, T, p] the moving entries, and sine and cosine of those that span a whole turn."""
        assert self.made is not None
        obs = self.made.obs[..., self.moving]
        wide = obs[..., np.ptp(obs, axis=(0, 1)) > 2 * np.pi]  # they may be angles
        return np.concatenate((obs, np.sin(wide), np.cos(wide)), axis=-1)

    @cached_property
    def learners(self) -> "list[Evidence]":
        """The part of each of the first learners."""
        seeds = self.run.seeds
        if len(seeds) == 1:
            return [self]
        return [self._part(i, len(seeds)) for i in range(min(LEARNERS, len(seeds)))]

    def _part(self, learner: int, learners: int) -> "Evidence":
        made: Any = self.made and jax.tree.map(lambda a: np.split(a, learners)[learner], self.made)
        return replace(self, made=made, whole=self, learner=learner)

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The rows of metrics.jsonl, of a learner's part its own."""
        rows = self.folder.rows
        seed = self.run.seeds[self.learner] if self.whole else None
        return rows if seed is None else [row for row in rows if row["seed"] == seed]

    @cached_property
    def _trained(self) -> Trained | None:
        """The learners; None: there is nothing yet, without a checkpoint."""
        return load(self.path) if checkpoint.steps(self.path / "checkpoints") else None

    @property
    def params(self) -> Params | None:
        """What the learner has learned; None: nothing yet."""
        trained = (self.whole or self)._trained
        learned: Any = trained and trained.params
        return learned and jax.tree.map(lambda leaf: leaf[self.learner], learned)

    @cached_property
    def by_chance(self) -> Tried | None:
        """New episodes of random actions."""
        if self.whole:
            return self.whole.by_chance
        found = episodes(self.run.agent.episode, RandomActions(), Params())
        return found and found[0]

    @cached_property
    def at_rest(self) -> "Evidence | None":
        """The second half of new episodes without action, of those that last so long."""
        found = episodes(self.run.agent.episode, ConstantController(), Params())
        if not found or not found[0].lives.all(1).any():
            return None
        return replace(self, made=found[0].second_half())

    @cached_property
    def _by_policies(self) -> list[Tried] | None:
        policy, trained = self.run.controllers.get("policy"), self._trained
        if policy is None or trained is None:
            return None
        number = len(self.learners)
        params: Any = jax.tree.map(lambda leaf: leaf[:number], trained.params)
        return episodes(self.run.agent.episode, policy, params, number, LONGER)

    @property
    def by_policy(self) -> Tried | None:
        """New episodes of the policy, which go on after the time limit; None: it has none."""
        each = (self.whole or self)._by_policies
        return each and each[self.learner]

    def at(self, lags: int) -> tuple[np.ndarray, np.ndarray]:
        """(k, t) of the newest decisions that have `lags` others before them in their episode."""
        learners, decisions = self.begins.shape
        now = np.arange(decisions)
        first = np.maximum.accumulate(np.where(self.begins, now, 0), axis=1)
        each = max(MOST // learners, 1)
        k, t = np.nonzero((now - first)[:, -each:] >= lags)
        return k, t + max(decisions - each, 0)

    def change(self, where: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """[N, o] change of the moving entries by the decisions at `where`."""
        assert self.made is not None
        return (self.made.next_obs - self.made.obs)[where][:, self.moving]

    def known(
        self, where: tuple[np.ndarray, np.ndarray], obs: int = 0, actions: int = 0
    ) -> np.ndarray:
        """[N, p] the newest observations and `actions` actions before the decisions at `where`.

        obs: how many further observations, each one decision older.
        """
        assert self.made is not None
        k, t = where
        seen = [self._shown[k, t - i] for i in range(obs + 1)]
        done = [self.made.action[k, t - i] for i in range(actions)]
        return np.concatenate(seen + done, axis=1)


def of_each(check: Callable[[Evidence], str | None]) -> Callable[[Evidence], str | None]:
    """A check of a run that examines each learner: the first line, and the seeds that have one."""

    def checked(run: Evidence) -> str | None:
        found = {one.learner: line for one in run.learners if (line := check(one))}
        if not found:
            return None
        line = next(iter(found.values()))
        seeds = ", ".join(str(run.run.seeds[i]) for i in found)
        many = "s" if len(found) > 1 else ""
        return line if len(run.learners) == 1 else f"seed{many} {seeds}: {line}"

    return checked


def read(path: Path) -> Evidence:
    """The run in `path`."""
    config = run_folder.read(path, "run")
    with run_folder.blame_config(path):
        prepare(config)
        run = build_run(config, "memory")
        made = _made(path, config, run)
        damaged = made is not None and not all(np.isfinite(each).all() for each in made)
        return Evidence(RunFolder(path), config, run, None if damaged else made, damaged=damaged)


def _made(path: Path, config: Any, run: Run) -> Transition | None:
    """The decisions in the newest sound checkpoint [K, T, ...]."""
    if not (config.checkpoint_replay and checkpoint.steps(path / "checkpoints")):
        return None
    try:
        memory: Any = restore(path, run, "memory")[1].memory
    except CheckpointError:
        return None
    rows: Any = np.asarray(memory.rows)
    count = int(np.asarray(memory.count).min())
    length = rows.shape[1]
    if count > length:  # the ring is full: from the oldest on
        rows = np.roll(rows, -(count % length), axis=1)
    rows = rows[:, : min(count, length)].swapaxes(1, 2)
    rows = rows.reshape(-1, *rows.shape[2:])
    return jax.tree.map(np.asarray, unpack(rows, run.agent.spec))
