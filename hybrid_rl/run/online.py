"""A method in a loop of the user's own: act, observe, and it learns.

    learner = OnlineLearner(["algo=hybrid_stochastic", "settings=light"], obs=17, act=6, dt=0.05)
    obs = robot.reset()
    while running:
        action = learner.act(obs)                                 # [m] in [-1, 1], at once
        obs, reward, terminated, truncated = robot.step(action)
        learner.observe(reward, obs, terminated, truncated)
        obs = robot.reset() if terminated or truncated else obs
    learner.save("runs/mine")    # a run folder; OnlineLearner.load goes on, hybrid_rl.load acts

learn="background": a thread learns while the caller's loop goes on, at most the updates of one
decision for each; "between_episodes": at the end of an episode, before `observe` returns; "inline":
in every `observe`, as in training. episode.lag=0.05: an action acts 0.05 s after its observation.
"""

import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

import jax
import numpy as np
from omegaconf import DictConfig

from hybrid_rl.envs.adapters.robot import PENDING, Outside
from hybrid_rl.errors import DivergenceError, UsageError
from hybrid_rl.files.lock import lock
from hybrid_rl.outside.acting import Exploring, numbers
from hybrid_rl.outside.learner import RowLearner, RowLoop
from hybrid_rl.outside.row_log import row_type
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.checkpoints.store import Record, Shelf
from hybrid_rl.run.launch import fits, refuse_edits, written
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings.values import check, one_of

MODES = ("background", "between_episodes", "inline")
HANDOVER_S = 0.1  # [s] between two sets of parameters that `act` gets from the thread
OUTSIDE = f"{Outside.__module__}.{Outside.__name__}"
ELSEWHERE = ("task", "run_dir", "resume")  # keys of `train` alone


class OnlineLearner:
    """One learner, in a loop of the caller's.

    Raises:
        UsageError: for an override that fits nothing, or a value out of range.
    """

    def __init__(
        self,
        method: Sequence[str] | DictConfig = (),
        *,
        obs: int = 0,
        act: int = 0,
        dt: float = 0.05,
        learn: str = "background",
        seed: int = 0,
        config_dir: str | Path | None = None,
    ) -> None:
        """Compile; this takes some seconds.

        Args:
            method: overrides as of the command line, such as algo=sac; total_steps bounds the
                memory [decisions].
            obs: numbers in an observation.
            act: numbers in an action.
            dt: [s] between decisions.
            learn: one of MODES.
            seed: of all random numbers.
            config_dir: a folder with configuration groups of the user, as for `--config-dir`.
        """
        one_of("learn", learn, MODES)
        self.config = _config(method, {"obs": obs, "act": act, "dt": dt}, seed, config_dir)
        check(self.config)
        prepare(self.config)
        run = configuration.build(self.config)
        fits([run])
        self._mode, self._lock, self._spec = learn, threading.Lock(), run.agent.spec
        self._loop = RowLoop(run.agent, run.seeds, 1)
        self._decide = Exploring(run.agent, run.seeds[0], run.agent.random_steps)
        self._kind, self._rows = row_type(self._spec), {}  # number -> row
        self._learner = RowLearner(self._loop, self._loop.init(), self._rows.get)
        self._lag = run.agent.episode.known_lag  # [decisions]
        if self._lag > PENDING:
            raise UsageError(f"episode.lag: at most {PENDING} decisions, {PENDING * dt:g} s")
        self._learner.lag = self._lag * self._spec.dt or None
        self._start(0)

    def _start(self, decisions: int) -> None:
        """Begin to learn after `decisions` decisions, in a new episode."""
        self.decisions = self._began = decisions
        self._learner.read = self._learner.learned = decisions
        self._pending: tuple[np.ndarray, np.ndarray] | None = None
        self._episode = 0
        self._past = np.zeros((PENDING + 1, self._spec.act), np.float32)  # sent, the newest first
        self._error: Exception | None = None
        self._closed = False
        self._decide.take(self._newest())
        if self._mode == "background":
            self._thread = threading.Thread(target=self._follow, daemon=True)
            self._thread.start()

    @property
    def updates(self) -> int:
        """Decisions that were learned from since it was made or loaded."""
        return self._learner.learned - self._began

    @property
    def metrics(self) -> dict[str, float]:
        """The newest metrics of the learners, such as sac/critic_loss."""
        with self._lock:
            rows = {name: np.asarray(value) for name, value in self._learner.metrics.items()}
        known = {name: float(value.ravel()[0]) for name, value in rows.items() if "/" in name}
        return {name: value for name, value in known.items() if np.isfinite(value)}

    def act(self, obs: Any) -> np.ndarray:
        """The action [m] in [-1, 1] at `obs` [o]; random for the method's `random_steps`.

        Raises:
            UsageError: for an observation of another size, or with numbers that are not finite;
                without `observe` since the last action.
            DivergenceError: if the learner reached NaN or infinity.
        """
        self._check()
        if self._pending is not None:
            raise UsageError("act: the last action has no outcome yet; observe or interrupt first")
        obs = numbers("obs", obs, self._spec.obs)
        self._decide.informed(self._past[::-1], self._lag)
        action = self._decide(obs, self.decisions)
        if not np.isfinite(action).all():
            line = f"act: after {self.decisions} decisions the learner reached NaN or infinity"
            raise DivergenceError(f"{line}; OnlineLearner.load goes on from what was saved before")
        self._pending = obs, action
        return action

    def observe(
        self,
        reward: float,
        next_obs: Any,
        terminated: bool = False,
        truncated: bool = False,
        executed: Any = None,
    ) -> None:
        """What the last action led to.

        Args:
            reward: of the decision.
            next_obs: [o] after it, the true last one where the episode ends.
            terminated: whether the episode has ended for good.
            truncated: whether it was cut off, by a time limit for example.
            executed: the action [m] in [-1, 1] that acted, if it was another, such as a safe one.

        Raises:
            UsageError: as `act`; for an action out of its range; without an action before.
        """
        self._check()
        if self._pending is None:
            raise UsageError("observe: there is no action yet; call act first")
        row = np.zeros((), self._kind)
        row["obs"], row["action"] = self._pending
        row["next_obs"] = numbers("next_obs", next_obs, self._spec.obs)
        row["reward"] = numbers("reward", reward)
        row["terminated"], row["truncated"] = bool(terminated), bool(truncated and not terminated)
        if executed is not None:
            row["action"] = numbers("executed", executed, self._spec.act, most=1)
        self._past = np.concatenate((row["action"][None], self._past[:-1]))
        row["sent"], row["interval"] = self._past, self._spec.dt
        row["times"] = -self._spec.dt * np.arange(len(self._past))
        row["stretch"] = row["episode"] = self._episode
        self._rows[self.decisions], self._pending = row, None
        self.decisions += 1
        ended = bool(terminated or truncated)
        if ended:
            self.interrupt()
        if self._mode == "inline" or (self._mode == "between_episodes" and ended):
            while self._advance():
                pass
            self._decide.take(self._newest())

    def interrupt(self) -> None:
        """The episode was broken off without an outcome: the last action is forgotten."""
        self._pending = None
        self._episode += 1
        self._past = np.zeros_like(self._past)
        self._decide.begin()

    def _follow(self) -> None:
        """Learn in the background."""
        handed = 0.0
        try:
            while not self._closed:
                if not self._advance():
                    time.sleep(1e-3)
                if time.monotonic() - handed > HANDOVER_S:
                    self._decide.take(self._newest())
                    handed = time.monotonic()
        except Exception as error:  # the caller's thread raises it
            self._error = error

    def _advance(self) -> bool:
        """Take a row into the memory, or else learn from one; False if nothing is left."""
        learner = self._learner
        with self._lock, jax.debug_nans(False):  # in rows NaN is what does not apply
            if not (learner.in_order and learner.owes) and learner.observe():
                return True
            if not learner.owes:
                return False
            learner.learn()
            self._rows.pop(learner.learned - 2, None)  # the newest says where an episode begins
            return True

    def _newest(self) -> Any:
        """A copy of the newest parameters."""
        with self._lock:
            return self._learner.params()

    def save(self, folder: Path | str) -> None:
        """Write a run folder, or replace one of `save`, after what waits has entered the memory.

        Raises:
            UsageError: if it cannot be written to, or holds another kind of run.
            CheckpointError: if the checkpoint could not be written.
        """
        learner = self._learner
        while learner.read < self.decisions:
            self._advance()
        with lock(Path(folder), "folder") as path, self._lock:
            if (path / "config.yaml").exists():
                _check_ours(run_folder.parse_config(path, "folder"), path)
            shelf = Shelf(self._loop, [path / "checkpoints"], [written(self.config)])
            shelf.save(learner.state, Record([[]], [None], step=learner.read))
            run_folder.write(path, self.config)

    @classmethod
    def load(cls, folder: Path | str, learn: str = "background") -> Self:
        """Go on from a folder of `save`, in a new episode.

        Raises:
            UsageError: if the folder holds no such run.
            CheckpointError: if its checkpoint is not sound.
        """
        config = run_folder.read(Path(folder), "folder")
        _check_ours(config, folder)
        refuse_edits(config, Path(folder))
        learner = cls(config, learn=learn)
        learner.close()
        shelf = Shelf(learner._loop, [Path(folder) / "checkpoints"], [{}])
        learner._learner.state, record, _ = shelf.restore()
        learner._start(record.step)
        return learner

    def close(self) -> None:
        """End the thread."""
        self._closed = True
        if self._mode == "background":
            self._thread.join()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _check(self) -> None:
        if self._error is not None:
            raise self._error
        if self._closed:
            raise UsageError("this learner is closed")


def _check_ours(config: DictConfig, folder: Path | str) -> None:
    """Raise UsageError unless the configuration of a folder is that of `save`."""
    if (config.get("env") or {}).get("_target_") != OUTSIDE:
        raise UsageError(f"folder={folder}: holds a run that OnlineLearner did not write")


def _config(method: Any, sizes: dict[str, Any], seed: int, config_dir: Any) -> DictConfig:
    """The configuration of a method in a world of these sizes; that of `load` stays as it is."""
    if isinstance(method, DictConfig):
        return method
    method = [method] if isinstance(method, str) else [*method]
    if wrong := [key for key in ELSEWHERE if any(word.startswith(f"{key}=") for word in method)]:
        raise UsageError(f"{wrong[0]}=: is of train; OnlineLearner has obs=, act=, save and load")
    given = [f"env.{name}={value}" for name, value in sizes.items()]
    return configuration.load(["task=online", *given, f"seed={seed}", *method], config_dir)
