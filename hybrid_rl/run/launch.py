"""A program from the configurations of its runs to their summaries, new or resumed.

A `Job` has its runs in their folders: settings, records and checkpoints, up to summary.json.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack, nullcontext
from dataclasses import dataclass, field, replace
from importlib.util import find_spec
from itertools import cycle
from pathlib import Path
from typing import Any

import jax
from omegaconf import DictConfig

from hybrid_rl.errors import FAULTS, DivergenceError, UsageError, install
from hybrid_rl.files.atomic import naming, refuse_link, write_text
from hybrid_rl.files.lock import lock
from hybrid_rl.files.reading import json_file
from hybrid_rl.networks import precision
from hybrid_rl.run import folder, start
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.checkpoints.store import Shelf
from hybrid_rl.run.logs.log import RunLog
from hybrid_rl.run.logs.progress import Progress
from hybrid_rl.run.logs.records import Row, flatten_keys
from hybrid_rl.run.machine import memory, provenance
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.run.members import Member, axis_of, joined, loop_of
from hybrid_rl.run.schedule import Schedule
from hybrid_rl.run.session import Session
from hybrid_rl.run.start import Start
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.values import check, one_of, whole
from hybrid_rl.settings.words import plain
from hybrid_rl.training.loop import Axis, Loop
from hybrid_rl.version import BEGAN

FREE = ("resume", "total_steps", "compile_cache", "precision")  # keys of a resumed run
FOLLOW = {"random_steps", "eval_every"}  # perhaps from total_steps
ONLY = "with resume only total_steps and precision can be changed"

Handler = Callable[[Callable[[int], None]], AbstractContextManager]


@dataclass
class Output:
    """What surrounds a run, besides its folder: the console, a function of the user's, signals.

    The function is called with every new row, a dictionary. Where it returns False, `ask` is called
    with 0, and it gets the rows up to the end. Where it raises, also; `problem` is what it raised,
    and it is not called again. `handled(f)` is a context in which the first signal calls f(number).
    """

    function: Callable[[Row], Any] = lambda row: None
    progress: bool = True
    handled: Handler = nullcontext
    ask: Callable[[int], None] = lambda number: None
    problem: BaseException | None = None

    def __call__(self, row: Row) -> None:
        """Call the function."""
        try:
            if self.problem is None and self.function(row) is False:
                self.ask(0)
        except FAULTS as problem:
            self.problem = problem
            self.ask(0)


@dataclass(frozen=True)
class Job:
    """K runs, their folders, what sets each apart, and the numbers in which they differ."""

    runs: Sequence[Run]
    folders: Sequence[Path] = ()  # none yet
    values: Sequence[Mapping[str, float]] = ({},)  # [K] key -> value
    axis: Axis = field(default_factory=Axis)
    start: Start | None = None  # what the learners of new runs begin with

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
        stack.enter_context(naming(self.whole))
        logs = []
        for run, run_dir in zip(self.runs, self.folders, strict=True):
            more = {"run_dir": str(run_dir)} if len(self.runs) > 1 else {}
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
            columns = {key: [own[key] for own in self.values] for key in self.values[0]}
            write_text(self.whole / folder.SWEEP, json.dumps(columns, indent=1) + "\n")

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
        "compile_s": session.compile_s,
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


def train(members: Sequence[Member], given: Mapping[str, str], output: Output) -> dict[str, Any]:
    """Run `members`, one or those of a sweep, to their end, or to a signal.

    Returns what summary.json holds; of a sweep that of all its runs, and each of them.

    given: the overrides of the user, key -> value; of a resumed run, whose settings come from its
    folder, only total_steps and precision may differ.
    """
    if members[0].config.resume is not None:
        return _resume(members, given, output)
    return _begin(built(members), output)


def built(members: Sequence[Member]) -> Job:
    """New runs, without folders."""
    for member in members:
        check(member.config)
        prepare(member.config)  # before a check of the user's world initialises JAX's devices
    runs, starts = zip(*(start.build_new_run(member.config) for member in members), strict=True)
    values = [member.values for member in members]
    return Job(runs, (), values, axis_of(values, runs), start.joined(starts))


def train_built(run: Run, output: Output) -> dict[str, Any]:
    """Run what is built, in a new folder or on from the checkpoints in `config.resume`."""
    if run.config.resume is None:
        return _begin(Job([run]), output)
    with lock(Path(run.config.resume), "run_dir") as run_dir:
        return _run(Job([run], [run_dir]), output)


def _begin(job: Job, output: Output) -> dict[str, Any]:
    """Run what is built in new folders."""
    fits(job.runs)  # before a folder is made
    configs = [run.config for run in job.runs]
    if configs[0].get("logger") and find_spec("wandb") is None:
        raise UsageError(f"logger=wandb: not installed; {install('wandb')}")
    with folder.claim_folders(configs) as folders:
        return _run(replace(job, folders=folders), output)


def _resume(wanted: Sequence[Member], given: Mapping[str, str], output: Output) -> dict[str, Any]:
    """Continue the run, or the runs of a sweep, in the folder `resume`, as `train`."""
    parent = Path(str(wanted[0].config.resume))
    swept = folder.members(parent) or {parent: {}}
    folders, values = [*map(refuse_link, swept)], [*swept.values()]
    if len(wanted) not in (1, len(folders)):
        raise UsageError(f"sweep: resume={parent} has {len(folders)} runs; leave sweep.KEY out")
    given = {key.removeprefix("sweep."): value for key, value in given.items()}
    typed = zip(folders, cycle(wanted), strict=False)  # one, or one for each
    configs = [_settings(member.config, run_dir, given) for run_dir, member in typed]
    if ends := _ends(configs, folders):
        if output.progress:
            line = f"already finished ({ends[0]['total_steps']:,} steps)"
            print(f"{parent}: {line}; raise total_steps to continue")
        return joined(folders, ends) | {"signal": None}
    with ExitStack() as stack:
        runs = []
        for config, run_dir in zip(configs, folders, strict=True):
            stack.enter_context(lock(run_dir, "resume"))
            with folder.blame_config(run_dir):
                prepare(config)
                runs.append(configuration.build(config))
            refuse_edits(config, run_dir)  # also those of a process that had it until now
        return _run(Job(runs, folders, values, axis_of(values, runs)), output)


def fits(runs: Sequence[Run]) -> str:
    """A line about the replay memory; UsageError if it does not fit, or JAX computes in float64."""
    if jax.config.read("jax_enable_x64"):
        raise UsageError("JAX_ENABLE_X64: is on, and training computes in float32; turn it off")
    return memory.replay(runs[0], len(runs) * len(runs[0].seeds))


def _run(job: Job, output: Output) -> dict[str, Any]:
    """Run a session."""
    run, config = job.runs[0], job.runs[0].config
    with ExitStack() as stack:
        loop = job.loop()
        shelf = job.shelf(loop, output, stack)
        rounds = -(-config.total_steps // config.num_envs)  # the last may end beyond total_steps
        total, label = rounds * config.num_envs, f"{config.task} {config.algo}"
        shown = Progress(total, label, max(run.agent.changes()), output.progress)
        progress = stack.enter_context(shown)
        named = zip(job.folders, job.axis.names, strict=True)
        lines = [f"{label}{name and ' '}{name}: run folder {run_dir}" for run_dir, name in named]
        random = run.agent.random_steps if config.resume is None else 0
        lines += [f"the first {random:,} decisions are random"] * bool(random)
        progress.note("\n".join([*lines, fits(job.runs), *run.notes]))
        plan = Schedule(**{name: config[name] for name in Schedule.__dataclass_fields__})
        evaluated = {m: run.controllers[m] for m in config.eval_modes if m in run.controllers}
        session = Session(loop, evaluated, plan, shelf, progress)
        if config.resume is None:
            session.begin(job.start)
        else:
            with folder.blame_config(job.folders[0]):
                session.resume()
        session.compile()  # before anything is written: a start that fails leaves nothing
        job.write_settings()  # also of a resumed run, which may be longer now
        output.ask = session.ask
        with output.handled(session.ask):
            try:
                session.run()
                if loop.fault is not None:
                    raise loop.fault
            except DivergenceError:
                job.write_summaries(session)
                raise
            except FAULTS:  # of the user's world, or of the disk
                if session.shelf.newest is not None and "agent" not in config:
                    progress.note(folder.going_on(job.whole))
                raise
            finally:
                loop.close()
            return joined(job.folders, job.write_summaries(session))


def _settings(config: DictConfig, run_dir: Path, given: Mapping[str, str]) -> DictConfig:
    """The configuration of the run in `run_dir`, with what the user may change.

    config: what the user's command composes, which may be that of the run again.
    """
    old = folder.read_trained(run_dir, "resume")
    typed = [key for key in given if key not in FREE]
    if typed and (changed := _changes(written(old), written(config), typed)):
        differ = (key for key in typed if any(line.startswith(f"{key} ") for line in changed))
        key = next(differ, typed[0])
        raise UsageError(f"{key}={given[key]}: {ONLY}; resume={run_dir} has its own")
    if "total_steps" in given:
        steps = whole("total_steps", config.total_steps)
        if steps < old.total_steps:
            line = f"the run in resume={run_dir} has {old.total_steps}"
            raise UsageError(f"total_steps={steps}: {line}; it can be raised, not lowered")
        old.total_steps = steps
    old.resume, old.compile_cache = str(run_dir), config.compile_cache
    if "precision" in given:
        old.precision = one_of("precision", config.precision, precision.PRECISIONS)
    return old


def refuse_edits(config: DictConfig, run_dir: Path) -> None:
    """Raise UsageError if config.yaml is not what the newest checkpoint was trained with."""
    now = written(config)
    then = checkpoint.meta(run_dir / "checkpoints").get("settings", now)  # none may be readable
    if changed := _changes(then, now):
        raise UsageError(f"{run_dir / 'config.yaml'}: {', '.join(changed)}; put it back: {ONLY}")


def _changes(then: dict, now: dict, typed: Sequence[str] = ()) -> list[str]:
    """Lines "KEY was A and is B", by full keys, of the settings that stay for the whole run.

    A part occurs several times in a configuration: its shortest key names a change.
    """
    changed: dict[str, str] = {}
    fixed = {*now, *then} - {*FREE, "run_dir", "logger"} - FOLLOW.difference(typed)
    for key in sorted(fixed, key=lambda key: (key.count("."), key)):
        before, after = then.get(key, "absent"), now.get(key, "absent")
        if before != after:
            line = f"was {before} and is {after}"
            changed.setdefault(f"{key.rpartition('.')[2]} {line}", f"{key} {line}")
    return list(changed.values())


def _ends(configs: Sequence[DictConfig], folders: Sequence[Path]) -> list[dict[str, Any]]:
    """summary.json of each run; [] unless all are at their end, and have a checkpoint there."""
    summaries = []
    for config, run_dir in zip(configs, folders, strict=True):
        summary = json_file(run_dir / "summary.json", optional=True)
        if not summary.get("finished") or summary["total_steps"] < config.total_steps:
            return []
        if checkpoint.verify(run_dir / "checkpoints" / str(summary["total_steps"])):
            return []
        summaries.append(summary | {"run_dir": str(run_dir)})
    return summaries
