"""A program's runs in their folders: settings, records and checkpoints, up to summary.json."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from omegaconf import DictConfig

from hybrid_rl.errors import FAULTS
from hybrid_rl.files.atomic import naming, refuse_link
from hybrid_rl.networks import precision
from hybrid_rl.outside.loops import loop_of
from hybrid_rl.run import folder
from hybrid_rl.run.checkpoints.store import Shelf
from hybrid_rl.run.logs.log import RunLog
from hybrid_rl.run.logs.records import Row, flatten_keys
from hybrid_rl.run.machine import provenance
from hybrid_rl.run.session import Session
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.words import plain
from hybrid_rl.training.axis import Axis
from hybrid_rl.training.loop import Loop
from hybrid_rl.version import BEGAN


class Output:
    """Where a run reports, besides its folder: the console, and a function of the user's.

    The function is called with every new row, a dictionary. Where it returns False, `ask` is called
    with 0, and it gets the rows up to the end. Where it raises, also; `problem` is what it raised,
    and it is not called again.
    """

    def __init__(self, function: Callable[[Row], Any] | None = None, progress: bool = True) -> None:
        self._function, self._asked, self.progress = function, False, progress
        self.ask: Callable[[int], None] = lambda number: None
        self.problem: BaseException | None = None

    def __call__(self, row: Row) -> None:
        """Call the function."""
        if self._function is None or self.problem is not None:
            return
        try:
            ends = self._function(dict(row)) is False
        except FAULTS as problem:
            self.problem, ends = problem, True
        if ends and not self._asked:
            self._asked = True
            self.ask(0)

    def raise_problem(self) -> None:
        """Raise what the function raised, if it did; the run has ended with a checkpoint."""
        if self.problem is not None:
            raise self.problem


@dataclass(frozen=True)
class Job:
    """K runs, their folders, what sets each apart, and the numbers in which they differ."""

    runs: Sequence[Run]
    folders: Sequence[Path]
    values: Sequence[Mapping[str, float]] = ({},)  # [K] key -> value
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

    def shelf(self, loop: Loop, output: Output, stack: ExitStack) -> Shelf:
        """The records, open until the end of `stack`, and the checkpoints."""
        logs, several = [], len(self.runs) > 1
        for run, run_dir in zip(self.runs, self.folders, strict=True):
            stack.enter_context(naming(run_dir))
            more = {"run_dir": str(run_dir)} if several else {}
            log = RunLog(run_dir, run.seeds, plain(run.config), lambda row, m=more: output(row | m))
            logs.append(stack.enter_context(log))
        folders = [refuse_link(run_dir / "checkpoints") for run_dir in self.folders]
        settings = [written(run.config) for run in self.runs]
        return Shelf(loop, folders, settings, logs, self.runs[0].config.checkpoint_replay)

    def write_settings(self) -> None:
        """Write config.yaml of each run, and sweep.json of several."""
        for run, run_dir in zip(self.runs, self.folders, strict=True):
            folder.write(run_dir, run.config)
        if len(self.runs) > 1:
            folder.write_sweep(self.whole, self.values)

    def write_summaries(self, session: Session) -> list[dict[str, Any]]:
        """The contents of summary.json of each run, which are written."""
        shelf, summaries = session.shelf, []
        for run, log, share in zip(self.runs, shelf.logs, shelf.shares(), strict=True):
            summaries.append(_summary(run.config, session, log.run_dir, share))
            log.summary(summaries[-1])
        return summaries


def _summary(config: DictConfig, session: Session, run_dir: Path, share: slice) -> dict[str, Any]:
    """The contents of summary.json of the learners in `share`."""
    values = plain(config)
    ends, rate = session.record.ends, session.record.learning.rate
    return {
        "task": config.task,
        "algo": config.algo,
        "seeds": list(session.loop.seeds[share]),
        "total_steps": session.step,
        "finished": session.finished,
        "final_return": session.final_returns()[share],
        "final_eval": session.record.final_eval[share],
        "diverged": [end for s, end in ends.items() if share.start <= s < share.stop],
        "before_s": session.began - BEGAN,  # from the command to where wall_s is 0
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
    """The values of config.yaml, by full keys."""
    others = ("expert", "version", "recipe", "config_dir")
    return flatten_keys({key: value for key, value in plain(config).items() if key not in others})
