"""A run from its configuration to its summary: a new one, or one that is resumed."""

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import jax
from omegaconf import DictConfig, OmegaConf

from hybrid_rl import config as configuration
from hybrid_rl.checks import check, countable, whole
from hybrid_rl.config import Run
from hybrid_rl.errors import DivergenceError, UsageError
from hybrid_rl.networks import precision
from hybrid_rl.run import checkpoint, distributed, folder, integrity, loggers, memory, provenance
from hybrid_rl.run.duration import Duration, instead
from hybrid_rl.run.jax_settings import prepare
from hybrid_rl.run.lock import locked
from hybrid_rl.run.log import RunLog
from hybrid_rl.run.progress import Progress, Silent
from hybrid_rl.run.records import changes, flat, summary_of
from hybrid_rl.run.schedule import Schedule
from hybrid_rl.run.session import Session
from hybrid_rl.run.start import Start, built
from hybrid_rl.training.loops import loop_of

NOTHING: Mapping[str, str] = MappingProxyType({})
UNKNOWN = object()  # the value of a key that a configuration does not have
OF_A_SESSION = ("resume", "total_steps", "run_dir", "version", "distributed", "logger")
OF_A_SESSION += ("compile_cache", "precision", "matmul_precision")

ONLY = "with resume only total_steps and precision can be changed"
SLOWER = "precision=bf16: slower than float32 on a CPU (0.5 to 0.7 of its speed); it is for GPUs"

Handler = Callable[[Callable[[int], None]], AbstractContextManager]


@dataclass(frozen=True)
class Output:
    """Where a run reports, besides its folder."""

    on_row: loggers.Function | None = None  # gets every row
    shown: bool = True  # on the console


CONSOLE = Output()


def train(
    config: DictConfig, given: Mapping[str, str], handled: Handler, output: Output = CONSOLE
) -> dict[str, Any]:
    """Run `config` to its end, or to a signal; returns what summary.json holds.

    given: the overrides of the user, key -> value; of a resumed run, whose settings come from its
    folder, only total_steps and precision may differ. handled: `handled(f)` is a context in which
    the first signal calls f(number).

    Raises:
        UsageError: if the configuration makes no run.
        DivergenceError: if every learner reached NaN or infinity.
        CheckpointError: if a checkpoint could not be written or read.
    """
    if config.get("distributed"):
        check(config)
        prepare(config)
        config = distributed.share(config)
        given = {key: value for key, value in given.items() if key != "distributed"}
    if config.resume is not None:
        return _resume(config, given, handled, output)
    check(config)
    prepare(config)  # first: a check of the user's world initialises JAX's devices
    run, start = built(config)
    return begin(run, handled, output, start)


def begin(
    run: Run, handled: Handler, output: Output = CONSOLE, start: Start | None = None
) -> dict[str, Any]:
    """The same for a run that is built, in a new folder; start: what another run gave it."""
    size = _fits(run)
    loggers.check(run.config.get("logger"))
    with folder.fresh(run.config) as run_dir:
        return _run(run, run_dir, size, handled, output, start)


def proceed(run: Run, handled: Handler, output: Output = CONSOLE) -> dict[str, Any]:
    """The same from the newest checkpoint in the folder `config.resume`."""
    run_dir = Path(str(run.config.resume))
    with locked(folder.writable(run_dir, "run_dir"), "run_dir"):
        return _run(run, run_dir, _fits(run), handled, output)


def _resume(
    config: DictConfig, given: Mapping[str, str], handled: Handler, output: Output
) -> dict[str, Any]:
    """The same for the run in the folder `config.resume`."""
    run_dir = Path(str(config.resume))
    if done := _done(_settings(config, given), run_dir):
        if output.shown:
            line = f"finished already at {done['total_steps']:,}; raise total_steps to go on"
            print(f"{run_dir}: {line}")
        return done | {"signal": None}
    with locked(folder.writable(run_dir, "resume"), "resume"):
        config = _settings(config, given)  # again, as another process may have continued the run
        with folder.blamed(run_dir):
            check(config)
            prepare(config)
            run = configuration.build(config)
        _refuse_edits(config, run_dir)
        return _run(run, run_dir, _fits(run), handled, output)


def _fits(run: Run) -> str:
    """A line about the replay memory; raise UsageError if it, or the evaluations, do not fit."""
    number, modes = run.config.eval_episodes, run.controllers.values()
    memory.episodes("eval_episodes", number, len(run.seeds), run.agent.episode, modes)
    return memory.replay(run)


def _run(
    run: Run,
    run_dir: Path,
    size: str,
    handled: Handler,
    output: Output,
    start: Start | None = None,
) -> dict[str, Any]:
    """Run a session in `run_dir`; size: a line about the replay memory; start: as of `begin`."""
    config = run.config
    label = f"{config.task} {config.algo}"
    names = loggers.check(config.get("logger"))
    settings: Any = OmegaConf.to_container(config)
    copies = loggers.made(names, run_dir, run.seeds, settings)
    if output.on_row is not None:
        copies.append(output.on_row)
    with (
        integrity.naming(run_dir),
        RunLog(run_dir, run.seeds, copies) as log,
        _progress(run, label, output.shown) as progress,
    ):
        notes = [f"{label}: run folder {run_dir}", size, *run.notes]
        if precision.chosen() == "bf16" and jax.default_backend() == "cpu":
            notes.append(SLOWER)
        progress.note("\n".join(notes))
        loop = loop_of(run.agent, run.seeds, -(-config.log_every // config.num_envs), run_dir)
        duration = Duration(jax.default_backend() == "cpu", instead(config))
        plan = _schedule(config), log, progress, duration
        session = Session(loop, run.controllers, *plan, _written(config))
        if config.resume is None:
            session.begin(start)
        else:
            with folder.blamed(run_dir):
                session.resume()
        folder.write(run_dir, config)  # also of a resumed run, which may be longer now
        session.compile()
        if output.on_row is not None:
            output.on_row.ask = session.ask
        with handled(session.ask):
            try:
                session.run()
            except DivergenceError:
                log.summary(_summary(config, session))
                raise
            finally:
                loop.close()
            summary = _summary(config, session)
            log.summary(summary)
        return summary


def _settings(config: DictConfig, given: Mapping[str, str]) -> DictConfig:
    """The configuration of the run that `config` resumes, with what the user may change.

    Raises:
        UsageError: if the user gave another key a new value, or lowered total_steps.
    """
    run_dir = Path(str(config.resume))
    old = folder.read(run_dir, "resume")
    if not checkpoint.steps(run_dir / "checkpoints"):
        raise UsageError(f"resume={run_dir}: holds no checkpoint; start the run again")
    for key in given.keys() - {"resume", "total_steps", "compile_cache", "precision"}:
        before, now = (OmegaConf.select(c, key, default=UNKNOWN) for c in (old, config))
        if _same(old, config) if before is UNKNOWN else before == now:
            continue
        has = "" if before is UNKNOWN else f"; the run in resume={run_dir} has {before}"
        raise UsageError(f"{key}={given[key]}: {ONLY}{has}")
    if "total_steps" in given:
        steps = whole(config, "total_steps")
        with folder.blamed(run_dir):
            before = whole(old, "total_steps")
        if steps < before:
            raise UsageError(
                f"total_steps={steps}: the run in resume={run_dir} has {before}; it can be "
                "raised, not lowered"
            )
        old.total_steps = steps
        countable(old)
    old.resume, old.compile_cache = config.resume, config.compile_cache
    if "precision" in given:
        old.precision = config.precision
    return old


def _written(config: DictConfig) -> dict[str, Any]:
    """What config.yaml holds, by full keys."""
    values: Any = OmegaConf.to_container(config)
    return flat({key: value for key, value in values.items() if key not in ("expert", "version")})


def _refuse_edits(config: DictConfig, run_dir: Path) -> None:
    """Raise UsageError if config.yaml is not what the newest checkpoint was trained with."""
    now = _written(config)
    then = checkpoint.meta(run_dir / "checkpoints").get("settings") or {
        **now
    }  # of an older version
    for key in OF_A_SESSION:
        now.pop(key, None)
        then.pop(key, None)
    if changed := changes(then, now):
        raise UsageError(f"{run_dir / 'config.yaml'}: {', '.join(changed)}; put it back: {ONLY}")


def _same(old: DictConfig, config: DictConfig) -> bool:
    """Whether the whole configuration that the user gave is that of the run."""
    return all(old[key] == config[key] for key in old if key in config and key not in OF_A_SESSION)


def _done(config: DictConfig, run_dir: Path) -> dict[str, Any] | None:
    """summary.json of a run that has reached its end and has a checkpoint there; None else."""
    try:
        summary = summary_of(run_dir / "summary.json") | {"run_dir": str(run_dir)}
        done = summary["finished"] and summary["total_steps"] >= config.total_steps
        newest = run_dir / "checkpoints" / str(summary["total_steps"])
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return summary if done and integrity.verify(newest) is None else None


def _progress(run: Run, label: str, shown: bool) -> Progress:
    """The display of a run, whose last round may end beyond total_steps."""
    config = run.config
    rounds = -(-config.total_steps // config.num_envs)
    steady = max(run.agent.changes())
    kind = Progress if shown else Silent
    return kind(rounds * config.num_envs, label=label, unit="decisions", steady=steady)


def _schedule(config: DictConfig) -> Schedule:
    """When the run logs, evaluates and saves."""
    values: dict[str, Any] = {name: config[name] for name in Schedule.__dataclass_fields__}
    values["eval_modes"] = tuple(m for m in config.eval_modes if m in config.controllers)
    return Schedule(**values)


def _summary(config: DictConfig, session: Session) -> dict[str, Any]:
    """What summary.json holds."""
    values: Any = OmegaConf.to_container(config)
    return {
        "task": config.task,
        "algo": config.algo,
        "seeds": list(session.loop.seeds),
        "total_steps": session.step,
        "finished": session.finished,
        "final_return": session.final_returns(),
        "final_eval": session.final_evaluations(),
        "diverged": list(session.diverged.ends.values()),
        "wall_s": session.wall_s,
        "compile_s": session.loop.compile_s,
        "env_steps_per_s": session.record.learning.rate,
        "physics": configuration.physics(config),
        "device": provenance.device(),
        "precision": precision.chosen(),
        "versions": provenance.versions(),
        "git_commit": provenance.git_commit(),
        "run_dir": str(session.log.run_dir),
        **{key: values[key] for key in ("run", "begun", "freeze") if values.get(key)},
        "signal": session.stop or None,
    }
