"""`python -m hybrid_rl.train task=T algo=A [key=value ...]`: one run, or a sweep with -m."""

import signal
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from time import monotonic, perf_counter
from types import MappingProxyType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig, OmegaConf

from hybrid_rl import command, config as configuration
from hybrid_rl.config import Run, UsageError
from hybrid_rl.envs.physics import resolve
from hybrid_rl.training import checkpoint, provenance, rows
from hybrid_rl.training.agent import AgentState
from hybrid_rl.training.evaluate import evaluation_keys, returns
from hybrid_rl.training.log import RunLog
from hybrid_rl.training.loop import Loop, finite
from hybrid_rl.training.progress import Progress

EVAL_NAMES = {"full": "eval/return", "policy": "eval/policy_return", "planner": "eval/planner_return"}


@dataclass
class Session:
    """One run on its way: what changes on the host."""

    run: Run
    folder: Path
    log: RunLog
    progress: Progress
    loop: Loop
    state: AgentState
    step: int = 0  # decisions of each learner
    wall_s: float = 0.0  # [s] of earlier sessions
    began: float = field(default_factory=monotonic)
    latest: dict[str, float] = field(default_factory=dict)  # for the display
    last_returns: list[list[tuple[int, float]]] = field(default_factory=list)
    evaluators: dict[str, Any] = field(default_factory=dict)
    stop: int | None = None  # the signal that asked for an end

    @property
    def elapsed(self) -> float:
        """[s] since the run began, over all its sessions."""
        return self.wall_s + monotonic() - self.began


def train(config: DictConfig, asked: Mapping[str, str] = MappingProxyType({})) -> dict[str, Any]:
    """Run `config` to its end, or to a signal; returns what summary.json holds.

    With `config.resume` the settings come from that run; `asked` are the overrides that the
    user gave beside it, of which only total_steps may differ.

    Raises:
        UsageError: where the configuration makes no run.
        Diverged: where a learner reached NaN or infinity.
        CheckpointError: where a checkpoint could not be written.
    """
    config, resumed = _settings(config, asked)
    run = configuration.build(config)
    _tell_memory(run)
    folder = Path(config.resume) if resumed else _folder(config)
    label = f"{config.task} {config.algo}"
    try:
        with (
            RunLog(folder, run.seeds) as log,
            Progress(config.total_steps, label=label) as progress,
        ):
            progress.note(f"{label}: run folder {folder}")
            if not resumed:
                OmegaConf.save(config, folder / "config.yaml")
            session = _open(run, folder, log, progress, resumed)
            with _signals(session):
                _advance(session)
            return _close(session)
    except PermissionError as error:
        raise UsageError(f"run_dir={folder}: cannot be written to ({error.strerror})") from error


def _settings(config: DictConfig, asked: Mapping[str, str]) -> tuple[DictConfig, bool]:
    """The configuration to run, and whether it goes on with an earlier run."""
    if config.resume is None:
        return config, False
    folder = Path(config.resume)
    if not (folder / "config.yaml").exists():
        raise UsageError(f"resume={folder}: no run folder there (it would hold config.yaml)")
    old = OmegaConf.load(folder / "config.yaml")
    OmegaConf.set_struct(old, True)
    for key, value in asked.items():
        if key in ("resume", "total_steps"):
            continue
        if str(OmegaConf.select(old, key)) != value:
            raise UsageError(
                f"{key}={value}: the run in resume={folder} has "
                f"{key}={OmegaConf.select(old, key)}; only total_steps can be changed"
            )
    if "total_steps" in asked:
        old.total_steps = config.total_steps
    old.resume = str(folder)
    return old, True


def _folder(config: DictConfig) -> Path:
    """A run folder that is ours alone, made now."""
    from datetime import datetime

    if config.run_dir is not None:
        folder = Path(config.run_dir)
        if (folder / "config.yaml").exists():
            raise UsageError(
                f"run_dir={folder}: holds a run already; choose another, or resume={folder}"
            )
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UsageError(f"run_dir={folder}: cannot be made ({error.strerror})") from error
        return folder
    stem = f"{datetime.now():%Y-%m-%d_%H-%M-%S}"
    for suffix in ("", *(f"_{i}" for i in range(1, 1000))):
        folder = Path("runs") / config.task / config.algo / f"{stem}{suffix}"
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            continue
        except OSError as error:
            raise UsageError(f"run_dir={folder}: cannot be made ({error.strerror})") from error
        return folder
    raise UsageError(f"run_dir=null: no free name left beside {folder}")


def _tell_memory(run: Run) -> None:
    """Say what the replay memories take; refuse what the machine does not have."""
    import os

    each = run.agent.replay.nbytes(run.agent.spec)
    every = each * len(run.seeds)
    stats = jax.devices()[0].memory_stats() or {}
    have = stats.get("bytes_limit") or os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if every > have:
        raise UsageError(
            f"replay.capacity={run.agent.replay.capacity}: {len(run.seeds)} learners would take "
            f"{every / 1e9:.1f} GB and the machine has {have / 1e9:.1f} GB; "
            f"at most {int(have // 2 // (each / run.agent.replay.capacity * len(run.seeds)))} fit"
        )
    print(
        f"replay memory: {each / 1e6:,.1f} MB a learner, {every / 1e6:,.1f} MB in all; "
        f"in checkpoints too: {'yes' if run.config.checkpoint_replay else 'no'}",
        flush=True,
    )


def _open(run: Run, folder: Path, log: RunLog, progress: Progress, resumed: bool) -> Session:
    """State at the start, or at the newest sound checkpoint."""
    config = run.config
    stride = -(-config.log_every // config.num_envs)
    loop = Loop(run.agent, run.seeds, stride)
    if not resumed:
        session = Session(run, folder, log, progress, loop, loop.init())
        session.last_returns = [[] for _ in run.seeds]
        return session
    like = jax.eval_shape(loop.init)
    if config.checkpoint_replay:
        step, state, meta, notes = checkpoint.restore(folder / "checkpoints", like)
    else:
        step, state, meta, notes = checkpoint.restore(
            folder / "checkpoints", like.replace(memory=None)
        )
        loop.agent = replace(run.agent, first_update=step)
        state = state.replace(memory=loop.init().memory)
        notes = [*notes, "checkpoints hold no replay memory: the run goes on, not bit for bit"]
    for note in [*notes, *log.rewind(meta["metrics_bytes"], step)]:
        progress.note(note)
    progress.note(f"going on from step {step:,}")
    return Session(
        run, folder, log, progress, loop, state, step, meta["wall_s"],
        last_returns=[[tuple(pair) for pair in pairs] for pairs in meta["returns"]],
    )


@contextmanager
def _signals(session: Session) -> Iterator[None]:
    """Ctrl-C and SIGTERM ask for an end at the next row; a second Ctrl-C ends at once."""

    def ask(number: int, frame: Any) -> None:
        if session.stop is not None:
            raise KeyboardInterrupt
        session.stop = number
        session.progress.note("stopping: writing a checkpoint ...")

    old = {s: signal.signal(s, ask) for s in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for number, handler in old.items():
            signal.signal(number, handler)


def _advance(session: Session) -> None:
    """Decide, log, evaluate, save, until the end or a signal."""
    config, loop = session.run.config, session.loop
    if session.step >= config.total_steps:
        return
    session.progress.note(f"compiling on {provenance.device()} ...")
    program = loop.compile(session.state)
    session.progress.note(f"compiled in {loop.compile_s:.1f} s")
    saved = session.step
    while session.step < config.total_steps and session.stop is None:
        _stride(session, program)
        last = session.step >= config.total_steps
        if last or _due(session.step, config.eval_every, config.num_envs):
            _evaluate(session)
        if last or _due(session.step, config.checkpoint_every, config.num_envs):
            _save(session)
            saved = session.step
    if saved != session.step:
        _save(session)


def _due(step: int, every: int, num_envs: int) -> bool:
    """Whether a multiple of `every` lies in the last round."""
    return step // every > (step - num_envs) // every


def _stride(session: Session, program: Any) -> None:
    """Decisions up to the next row of metrics, and that row."""
    config, seeds = session.run.config, session.run.seeds
    worlds, step = config.num_envs, session.step
    marks = (config.log_every, config.eval_every, config.checkpoint_every)
    end = min(config.total_steps, *((step // every + 1) * every for every in marks))
    rounds = min(-(-(end - step) // worlds), session.loop.stride)
    began = perf_counter()
    session.state, metrics = program(session.state, jnp.int32(step), jnp.int32(rounds))
    metrics = {name: np.asarray(m)[:rounds] for name, m in metrics.items()}
    seconds = perf_counter() - began
    rows.check(metrics, seeds, step, worlds)
    session.step += rounds * worlds
    found = rows.rows(metrics, seeds, step, worlds, session.elapsed)
    for row in found:
        if "train/return" in row:
            session.last_returns[seeds.index(row["seed"])].append(
                (row["step"], float(row["train/return"]))
            )
        else:
            row["perf/env_steps_per_s"] = rounds * worlds * len(seeds) / seconds
    session.log.write(found)
    newest = [pairs[-1][1] for pairs in session.last_returns if pairs]
    if newest:
        session.latest["train/return"] = float(np.mean(newest))
    session.latest["perf/env_steps_per_s"] = rounds * worlds * len(seeds) / seconds
    session.progress.update(session.step, session.latest)


def _evaluate(session: Session) -> None:
    """Returns of every evaluated mode, with keys of their own."""
    run = session.run
    params = jax.vmap(run.agent.params)(session.state)
    keys = jnp.stack([evaluation_keys(seed, run.config.eval_episodes) for seed in run.seeds])
    found = [{"step": session.step, "seed": seed} for seed in run.seeds]
    for mode in run.config.eval_modes:
        if mode not in session.evaluators:
            began = perf_counter()

            def of_seed(params: Any, keys: Any, mode: str = mode) -> Any:
                return returns(run.agent.episode, run.controllers[mode], params, keys)

            program = jax.jit(jax.vmap(of_seed)).lower(params, keys).compile()
            session.evaluators[mode] = program
            session.loop.compile_s += perf_counter() - began
        got = np.asarray(session.evaluators[mode](params, keys)).mean(-1)
        for row, value in zip(found, got, strict=True):
            row[EVAL_NAMES[mode]] = value
        session.latest[EVAL_NAMES[mode]] = float(got.mean())
    session.log.write([{**row, "wall_s": session.elapsed} for row in found])
    session.progress.update(session.step, session.latest)


def _save(session: Session) -> None:
    """A checkpoint of all that the run needs to go on."""
    if not finite(session.state):
        raise rows.Diverged(f"step {session.step}: a learned parameter is not finite")
    state = session.state
    if not session.run.config.checkpoint_replay:
        state = state.replace(memory=None)
    meta = {
        "step": session.step,
        "wall_s": session.elapsed,
        "metrics_bytes": session.log.flush(),
        "returns": session.last_returns,
    }
    checkpoint.save(session.folder / "checkpoints", session.step, state, meta)


def _close(session: Session) -> dict[str, Any]:
    """Write and return summary.json."""
    config, run = session.run.config, session.run
    finished = session.step >= config.total_steps
    tail = session.step - 0.1 * config.total_steps
    final = []
    for pairs in session.last_returns:
        values = [value for at, value in pairs if at > tail] or [v for _, v in pairs[-1:]]
        final.append(float(np.mean(values)) if values else None)
    wall_s = session.elapsed
    summary = {
        "task": config.task,
        "algo": config.algo,
        "seeds": list(run.seeds),
        "total_steps": session.step,
        "finished": finished,
        "final_return": final,
        "wall_s": wall_s,
        "compile_s": session.loop.compile_s,
        "env_steps_per_s": session.step * len(run.seeds) / wall_s,
        "physics": resolve(config.physics),
        "device": provenance.device(),
        "matmul_precision": config.matmul_precision,
        "versions": provenance.versions(),
        "git_commit": provenance.git_commit(),
        "run_dir": str(session.folder),
        "signal": session.stop,
    }
    session.log.summary(summary)
    return summary


def _job(config: DictConfig) -> None:
    """One run of the command."""
    command.prepare(config)
    given = command.asked(list(HydraConfig.get().overrides.task))
    summary = train(configuration.resolved(config), given)
    shown = ", ".join("-" if r is None else f"{r:,.1f}" for r in summary["final_return"])
    print(f"final return: {shown} ({summary['wall_s']:.0f} s, {summary['run_dir']})", flush=True)
    if summary["signal"] is not None:
        sys.exit(128 + summary["signal"])


if __name__ == "__main__":
    command.hydra_main(_job)
