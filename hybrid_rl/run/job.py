"""What a program trains, and where: a run in its folder, or those of a sweep in theirs."""

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

from omegaconf import DictConfig, OmegaConf

from hybrid_rl.files.atomic import naming, refuse_link
from hybrid_rl.networks import precision
from hybrid_rl.outside.loops import loop_of
from hybrid_rl.run.checkpoints.store import Store
from hybrid_rl.run.logs import loggers
from hybrid_rl.run.logs.log import RunLog
from hybrid_rl.run.logs.records import Row, flatten_keys
from hybrid_rl.run.machine import provenance
from hybrid_rl.run.session import Session
from hybrid_rl.run.shelf import Shelf
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings.build import Run
from hybrid_rl.training.axis import Axis
from hybrid_rl.training.loop import Loop


@dataclass(frozen=True)
class Output:
    """Where a run reports, besides its folder."""

    on_row: loggers.Callback | None = None  # gets every row
    progress: bool = True  # on the console

    @classmethod
    def of(cls, function: Callable[[Row], Any] | None, progress: bool = True) -> Self:
        """With a function of the user's that gets every row; None: none."""
        return cls(None if function is None else loggers.Callback(function), progress)

    def raise_problem(self) -> None:
        """Raise what the function raised, if it did; the run has ended with a checkpoint."""
        if self.on_row is not None and self.on_row.problem is not None:
            raise self.on_row.problem


@dataclass(frozen=True)
class Job:
    """K runs, their folders, and the numbers in which they differ."""

    runs: Sequence[Run]
    folders: Sequence[Path]
    axis: Axis = field(default_factory=Axis)

    def loop(self) -> Loop:
        """The loop that trains all learners."""
        run = self.runs[0]
        most = min(run.config.log_every, run.config.total_steps)  # decisions of a call
        stride = -(-most // run.config.num_envs)
        seeds = run.seeds * len(self.runs)
        return loop_of(run.agent, seeds, stride, self.folders[0], self.axis)

    @property
    def whole(self) -> Path:
        """The folder that `resume` continues."""
        return self.folders[0] if len(self.folders) == 1 else self.folders[0].parent

    def logs(self, output: Output, stack: ExitStack) -> list[RunLog]:
        """The records of the runs, open until the end of `stack`."""
        logs = []
        for run, run_dir in zip(self.runs, self.folders, strict=True):
            settings: Any = OmegaConf.to_container(run.config)
            names = loggers.check(run.config.get("logger"))
            copies = [loggers.KINDS[name](run_dir, run.seeds, settings) for name in names]
            if output.on_row is not None:
                more = {"run_dir": str(run_dir)} if len(self.runs) > 1 else {}
                copies.append(loggers.Named(output.on_row, more))
            stack.enter_context(naming(run_dir))
            logs.append(stack.enter_context(RunLog(run_dir, run.seeds, copies)))
        return logs

    def shelf(self, loop: Loop, logs: Sequence[RunLog]) -> Shelf:
        """The records and the checkpoints."""
        stores = []
        for run, run_dir in zip(self.runs, self.folders, strict=True):
            own = loop if len(self.runs) == 1 else Loop(run.agent, run.seeds, loop.stride)
            replay, path = run.config.checkpoint_replay, refuse_link(run_dir / "checkpoints")
            stores.append(Store(path, own, replay, written(run.config)))
        return Shelf(loop, logs, stores)

    def summaries(self, session: Session) -> list[dict[str, Any]]:
        """What summary.json of each run holds; it is written."""
        shelf, each = session.shelf, []
        for run, log, share in zip(self.runs, shelf.logs, shelf.shares(), strict=True):
            each.append(_summary(run.config, session, log.run_dir, share))
            log.summary(each[-1])
        return each


def _summary(config: DictConfig, session: Session, run_dir: Path, share: slice) -> dict[str, Any]:
    """What summary.json of the learners in `share` holds."""
    values: Any = OmegaConf.to_container(config)
    ends, rate = session.diverged.ends, session.record.learning.rate
    return {
        "task": config.task,
        "algo": config.algo,
        "seeds": list(session.loop.seeds[share]),
        "total_steps": session.step,
        "finished": session.finished,
        "final_return": session.final_returns()[share],
        "final_eval": session.final_evaluations()[share],
        "diverged": [end for s, end in ends.items() if share.start <= s < share.stop],
        "wall_s": session.wall_s,
        "compile_s": session.loop.compile_s,
        "env_steps_per_s": None if rate is None else rate / len(session.shelf.logs),
        "physics": configuration.physics(config),
        "device": provenance.device(),
        "precision": precision.current(),
        "versions": provenance.versions(),
        "git_commit": provenance.git_commit(),
        "run_dir": str(run_dir),
        **{key: values[key] for key in ("run", "begun", "freeze") if values.get(key)},
        "signal": session.stop or None,
    }


def written(config: DictConfig) -> dict[str, Any]:
    """What config.yaml holds, by full keys."""
    values: Any = OmegaConf.to_container(config)
    others = ("expert", "version", "recipe", "config_dir")
    return flatten_keys({key: value for key, value in values.items() if key not in others})
