"""A run from its configuration to its summary, new or resumed; or those of a sweep, together."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, ExitStack
from itertools import cycle
from pathlib import Path
from types import MappingProxyType
from typing import Any

from omegaconf import DictConfig, OmegaConf

from hybrid_rl.errors import FAULTS, DivergenceError, UsageError
from hybrid_rl.files.atomic import refuse_link
from hybrid_rl.networks import precision
from hybrid_rl.run import folder, together
from hybrid_rl.run import start as starting
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.files import integrity
from hybrid_rl.run.files.lock import lock
from hybrid_rl.run.job import Job, Output, written
from hybrid_rl.run.logs import loggers
from hybrid_rl.run.logs.progress import Progress, Silent
from hybrid_rl.run.logs.records import changes, summary_of
from hybrid_rl.run.machine import distributed, memory
from hybrid_rl.run.machine.jax_settings import prepare, refuse_x64
from hybrid_rl.run.schedule import Schedule
from hybrid_rl.run.session import Session
from hybrid_rl.run.start import Start
from hybrid_rl.run.together import Member
from hybrid_rl.settings import build as configuration
from hybrid_rl.settings.build import Run
from hybrid_rl.settings.values import check, countable, one_of, whole

NOTHING: Mapping[str, str] = MappingProxyType({})
UNKNOWN = object()  # the value of a key that a configuration does not have
OF_A_SESSION = ("resume", "total_steps", "run_dir", "version", "distributed", "logger")
OF_A_SESSION += ("compile_cache", "precision", "recipe", "config_dir")

ONLY = "with resume only total_steps and precision can be changed"
NOT_MUJOCO = "has no effect; task={} is not simulated by hybrid_rl.envs.mujoco"

Handler = Callable[[Callable[[int], None]], AbstractContextManager]
CONSOLE = Output()


def train(
    members: Sequence[Member], given: Mapping[str, str], handled: Handler, output: Output = CONSOLE
) -> dict[str, Any]:
    """Run `members`, one or those of a sweep, to their end, or to a signal.

    Returns what summary.json holds; of a sweep that of all its runs, and each of them.

    given: the overrides of the user, key -> value; of a resumed run, whose settings come from its
    folder, only total_steps and precision may differ. handled: `handled(f)` is a context in which
    the first signal calls f(number).

    Raises:
        UsageError: if a configuration makes no run, or one program cannot train all of them.
        DivergenceError: if every learner reached NaN or infinity.
        CheckpointError: if a checkpoint could not be written or read.
    """
    config = members[0].config
    if config.get("distributed"):
        check(config)
        prepare(config)
        config = distributed.share(config)
        members = [Member(config, {})]
        given = {key: value for key, value in given.items() if key != "distributed"}
    if config.resume is not None:
        return _resume(members, given, handled, output)
    for each in members:
        check(each.config)
    prepare(config)  # first: a check of the user's world initialises JAX's devices
    made = [starting.build_new_run(each.config) for each in members]
    runs = [run for run, _ in made]
    if len(runs) == 1:
        return begin(runs[0], handled, output, made[0][1])
    axis, start = together.axis_of(members, runs), starting.joined([each for _, each in made])
    size = fits(runs)
    loggers.check(config.get("logger"))
    with together.claim_folders(members) as folders:
        each = _run(Job(runs, folders, axis), size, handled, output, start)
    return together.summary(folders[0].parent, each)


def begin(
    run: Run, handled: Handler, output: Output = CONSOLE, start: Start | None = None
) -> dict[str, Any]:
    """Run what is built, in a new folder, as `train`; start: what another run gave it."""
    size = fits([run])
    loggers.check(run.config.get("logger"))
    with folder.claim_folder(run.config) as run_dir:
        return _run(Job([run], [run_dir]), size, handled, output, start)[0]


def proceed(run: Run, handled: Handler, output: Output = CONSOLE) -> dict[str, Any]:
    """Continue what is built from the newest checkpoint in the folder `config.resume`."""
    run_dir = Path(str(run.config.resume))
    with lock(run_dir, "run_dir"):
        return _run(Job([run], [run_dir]), fits([run]), handled, output)[0]


def _resume(
    wanted: Sequence[Member], given: Mapping[str, str], handled: Handler, output: Output
) -> dict[str, Any]:
    """Continue the run, or the runs of a sweep, in the folder `resume`, as `train`."""
    parent = Path(str(wanted[0].config.resume))
    each = folder.members(parent)
    values, swept, folders = each or {parent: {}}, bool(each), [*map(refuse_link, each)] or [parent]
    typed = dict(zip(folders, cycle(wanted), strict=False))  # one, or one for each

    def settings(run_dir: Path) -> DictConfig:
        own = typed[run_dir].config.copy()
        own.resume = str(run_dir)
        return _settings(own, given)

    done = [_done(settings(each), each) for each in folders]
    if ends := [each for each in done if each is not None and None not in done]:
        if output.progress:
            line = f"finished already at {ends[0]['total_steps']:,}; raise total_steps to go on"
            print(f"{parent}: {line}")
        return (together.summary(parent, ends) if swept else ends[0]) | {"signal": None}
    with ExitStack() as stack:
        members, runs = [], []
        for run_dir in folders:
            stack.enter_context(lock(run_dir, "resume"))
            own = settings(run_dir)  # again, as another process may have continued the run
            with folder.blame_config(run_dir):
                check(own)
                prepare(own)
                runs.append(configuration.built(own))
            refuse_edits(own, run_dir)
            members.append(Member(own, values[run_dir]))
        axis = together.axis_of(members, runs)
        each = _run(Job(runs, folders, axis), fits(runs), handled, output)
        return together.summary(parent, each) if swept else each[0]


def fits(runs: Sequence[Run]) -> str:
    """A line about the replay memory; raise UsageError if it, or the evaluations, do not fit."""
    refuse_x64()
    run, learners = runs[0], len(runs) * len(runs[0].seeds)
    number, modes = run.config.eval_episodes, run.controllers.values()
    memory.episodes("eval_episodes", number, learners, run.agent.episode, modes)
    return memory.replay(run, learners)


def _run(
    job: Job, size: str, handled: Handler, output: Output, start: Start | None = None
) -> list[dict[str, Any]]:
    """Run a session; size: a line about the replay memory; start: as of `begin`."""
    run, config = job.runs[0], job.runs[0].config
    label = f"{config.task} {config.algo}"
    with ExitStack() as stack:
        logs = job.logs(output, stack)
        progress = stack.enter_context(_progress(run, label, output.progress))
        each = zip(job.folders, job.axis.names, strict=True)
        notes = [f"{label}{name and ' '}{name}: run folder {run_dir}" for run_dir, name in each]
        notes += [size, *run.notes]
        if config.physics != "auto" and configuration.physics(config) is None:
            notes.append(f"physics={config.physics}: {NOT_MUJOCO.format(config.task)}")
        progress.note("\n".join(notes))
        loop = job.loop()
        shelf = job.shelf(loop, logs)
        session = Session(loop, run.controllers, _schedule(config), shelf, progress)
        if config.resume is None:
            session.begin(start)
        else:
            with folder.blame_config(job.folders[0]):
                session.resume()
        for own, run_dir in zip(job.runs, job.folders, strict=True):
            folder.write(run_dir, own.config)  # also of a resumed run, which may be longer now
        session.compile()
        if output.on_row is not None:
            output.on_row.ask = session.ask
        with handled(session.ask):
            try:
                session.run()
                if loop.fault is not None:
                    raise loop.fault
            except DivergenceError:
                job.summaries(session)
                raise
            except FAULTS:  # of the user's world, or of the disk
                if session.shelf.newest is not None and "agent" not in config:
                    progress.note(folder.going_on(job.whole))
                raise
            finally:
                loop.close()
            return job.summaries(session)


def _settings(config: DictConfig, given: Mapping[str, str]) -> DictConfig:
    """The configuration of the run that `config` resumes, with what the user may change."""
    run_dir = Path(str(config.resume))
    old = folder.read(run_dir, "resume")
    if old.task == "online":
        line = "was written by OnlineLearner.save; OnlineLearner.load goes on"
        raise UsageError(f"resume={run_dir}: {line}")
    if not checkpoint.steps(run_dir / "checkpoints"):
        raise UsageError(f"resume={run_dir}: holds no checkpoint; start the run again")
    free = {"resume", "total_steps", "compile_cache", "precision"}
    given = {key.removeprefix("sweep."): value for key, value in given.items()}
    groups = {key: OmegaConf.select(old, key, default=UNKNOWN) is UNKNOWN for key in given}
    for key in sorted(given.keys() - free, key=lambda key: groups[key]):  # a changed value is named
        before, now = (OmegaConf.select(c, key, default=UNKNOWN) for c in (old, config))
        if _same(old, config) if before is UNKNOWN else before == now:
            continue
        has = "" if before is UNKNOWN else f"; the run in resume={run_dir} has {before}"
        raise UsageError(f"{key}={given[key]}: {ONLY}{has}")
    if "total_steps" in given:
        steps = whole("total_steps", config.total_steps)
        with folder.blame_config(run_dir):
            before = whole("total_steps", old.total_steps)
        if steps < before:
            raise UsageError(
                f"total_steps={steps}: the run in resume={run_dir} has {before}; it can be "
                "raised, not lowered"
            )
        old.total_steps = steps
        countable(old)
    old.resume, old.compile_cache = config.resume, config.compile_cache
    if "precision" in given:
        old.precision = one_of("precision", config.precision, precision.PRECISIONS)
    return old


def refuse_edits(config: DictConfig, run_dir: Path) -> None:
    """Raise UsageError if config.yaml is not what the newest checkpoint was trained with."""
    now = written(config)
    then = checkpoint.meta(run_dir / "checkpoints").get("settings", now)  # none may be readable
    lowered = now["total_steps"] < then["total_steps"]  # its memory would not fit
    for key in {*OF_A_SESSION} - ({"total_steps"} if lowered else set()):
        now.pop(key, None)
        then.pop(key, None)
    if changed := changes(then, now):
        raise UsageError(f"{run_dir / 'config.yaml'}: {', '.join(changed)}; put it back: {ONLY}")


def _same(old: DictConfig, config: DictConfig) -> bool:
    """Whether the whole configuration that the user gave is that of the run."""
    free = (*OF_A_SESSION, "random_steps")  # which may follow from total_steps
    return all(old[key] == config[key] for key in old if key in config and key not in free)


def _done(config: DictConfig, run_dir: Path) -> dict[str, Any] | None:
    """summary.json of a run that has reached its end and has a checkpoint there; None else."""
    try:
        summary = summary_of(run_dir / "summary.json") | {"run_dir": str(run_dir)}
        done = summary["finished"] and summary["total_steps"] >= config.total_steps
        newest = run_dir / "checkpoints" / str(summary["total_steps"])
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return summary if done and integrity.verify(newest) is None else None


def _progress(run: Run, label: str, visible: bool) -> Progress:
    """The display of a run, whose last round may end beyond total_steps."""
    config = run.config
    rounds = -(-config.total_steps // config.num_envs)
    steady = max(run.agent.changes())
    kind = Progress if visible else Silent
    return kind(rounds * config.num_envs, label=label, unit="decisions", steady=steady)


def _schedule(config: DictConfig) -> Schedule:
    """When the run logs, evaluates and saves."""
    values: dict[str, Any] = {name: config[name] for name in Schedule.__dataclass_fields__}
    values["eval_modes"] = tuple(m for m in config.eval_modes if m in config.controllers)
    return Schedule(**values)
