"""`python -m hybrid_rl.train task=T algo=A [key=value ...]`: one run, or a sweep with -m."""

if __name__ == "__main__":
    from hybrid_rl import interrupt

    interrupt.install()

import sys
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from tempfile import TemporaryFile
from types import MappingProxyType
from typing import Any

from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig, OmegaConf

from hybrid_rl import command, interrupt
from hybrid_rl import config as configuration
from hybrid_rl.config import UNKNOWN, Run, UsageError
from hybrid_rl.training import checkpoint, divergence, provenance
from hybrid_rl.training.log import RunLog
from hybrid_rl.training.loop import Loop
from hybrid_rl.training.manifest import write_text
from hybrid_rl.training.progress import Progress
from hybrid_rl.training.rows import DivergenceError
from hybrid_rl.training.schedule import Schedule
from hybrid_rl.training.session import Session

NOTHING: Mapping[str, str] = MappingProxyType({})


def train(config: DictConfig, asked: Mapping[str, str] = NOTHING) -> dict[str, Any]:
    """Run `config` to its end, or to a signal; returns what summary.json holds.

    With `config.resume` the settings come from that run; `asked` are the overrides that the
    user gave beside it, of which only total_steps may differ.

    Raises:
        UsageError: where the configuration makes no run.
        DivergenceError: where every learner reached NaN or infinity.
        CheckpointError: where a checkpoint could not be written or read.
    """
    config = _settings(config, asked)
    run = configuration.build(config)
    command.prepare(config)
    label = f"{config.task} {config.algo}"
    memory = _memory(run)
    folder = _folder(config)
    with (
        RunLog(folder, run.seeds) as log,
        _progress(config, run, label) as progress,
    ):
        progress.note(f"{label}: run folder {folder}\n{memory}")
        loop = Loop(run.agent, run.seeds, -(-config.log_every // config.num_envs))
        session = Session(loop, run.controllers, _schedule(config), log, progress)
        if config.resume is None:
            session.begin()
        else:
            session.resume()
        kept = OmegaConf.merge(config, {"resume": None})  # a resumed run may have become longer
        write_text(folder / "config.yaml", OmegaConf.to_yaml(kept))
        return _run(config, session)


def _run(config: DictConfig, session: Session) -> dict[str, Any]:
    """Run `session` to its end, or to a signal; what summary.json holds."""
    session.compile()
    with interrupt.answered(session.ask):
        try:
            session.run()
        except DivergenceError:
            session.log.summary(_summary(config, session))
            raise
        summary = _summary(config, session)
        session.log.summary(summary)
    return summary


def _progress(config: DictConfig, run: Run, label: str) -> Progress:
    """The display of a run whose last round may end beyond `total_steps`."""
    rounds = -(-config.total_steps // config.num_envs)
    steady = max(run.agent.changes())
    return Progress(rounds * config.num_envs, label=label, unit="decisions", steady=steady)


def _settings(config: DictConfig, asked: Mapping[str, str]) -> DictConfig:
    """The configuration to run: `config`, or that of the run that it resumes."""
    if config.resume is None:
        return config
    configuration.check(config)
    place = Path(str(config.resume)) / "config.yaml"
    if not place.exists():
        raise UsageError(f"resume={config.resume}: no run folder there (no config.yaml in it)")
    if not checkpoint.steps(place.parent / "checkpoints"):
        raise UsageError(f"resume={config.resume}: holds no checkpoint; start the run anew")
    old = OmegaConf.load(place)
    for key in asked.keys() - {"resume", "total_steps"}:
        before, now = (OmegaConf.select(c, key, default=UNKNOWN) for c in (old, config))
        if before is UNKNOWN or before != now:
            has = "" if before is UNKNOWN else f"; the run in resume={config.resume} has {before}"
            raise UsageError(
                f"{key}={asked[key]}: beside resume only total_steps can be changed{has}"
            )
    if "total_steps" in asked:
        if config.total_steps < old.total_steps:
            raise UsageError(
                f"total_steps={config.total_steps}: the run in resume={config.resume} "
                f"has {old.total_steps}; it can be raised, not lowered"
            )
        old.total_steps = config.total_steps
    old.resume = config.resume
    return old


def _folder(config: DictConfig) -> Path:
    """The run folder: the resumed one, or one that is new and ours alone."""
    if config.resume is not None:
        return _writable(Path(str(config.resume)), "resume")
    if config.run_dir is not None:
        folder = Path(str(config.run_dir))
        if (folder / "config.yaml").exists():
            raise UsageError(
                f"run_dir={folder}: holds a run already; choose another, or resume={folder}"
            )
        return _writable(folder, "run_dir")
    parent = _writable(Path("runs") / config.task / config.algo, "run_dir")
    stem = f"{datetime.now():%Y-%m-%d_%H-%M-%S}"
    for number in range(10_000):
        folder = parent / (f"{stem}_{number}" if number else stem)
        try:
            folder.mkdir()
        except FileExistsError:
            continue
        return folder
    raise UsageError(f"run_dir=null: no free name left for {parent / stem}")


def _writable(folder: Path, key: str) -> Path:
    """`folder`, made if need be.

    Raises:
        UsageError: where it cannot be written to.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=folder):  # of no other run that begins at the same time
            pass
    except OSError as error:
        raise UsageError(f"{key}={folder}: cannot be written to ({error.strerror})") from error
    return folder


def _memory(run: Run) -> str:
    """What the replay memories take, in one line.

    Raises:
        UsageError: where it is more than the machine has.
    """
    replay, learners = run.agent.replay, len(run.seeds)
    each = replay.nbytes(run.agent.spec)
    have = provenance.memory()
    if each * learners > have:
        fits = int(0.5 * have / learners / (each / replay.capacity))
        raise UsageError(
            f"replay.capacity={replay.capacity}: {learners} learners would take "
            f"{each * learners / 1e9:,.1f} GB and there are {have / 1e9:,.1f} GB; {fits} would fit"
            + (f", or num_seeds={int(have // each)}" if have > each else "")
        )
    kept = "in checkpoints too" if run.config.checkpoint_replay else "not in checkpoints"
    return (
        f"replay memory: {replay.capacity:,} decisions, {each / 1e6:,.1f} MB a learner, "
        f"{each * learners / 1e6:,.1f} MB in all, {kept}"
    )


def _schedule(config: DictConfig) -> Schedule:
    """What happens when."""
    values: dict[str, Any] = {name: config[name] for name in Schedule.__dataclass_fields__}
    values["eval_modes"] = tuple(m for m in config.eval_modes if m in config.controllers)
    return Schedule(**values)


def _summary(config: DictConfig, session: Session) -> dict[str, Any]:
    """What summary.json holds."""
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
        "env_steps_per_s": session.learning.rate,
        "physics": configuration.physics(config).get("physics"),
        "device": provenance.device(),
        "matmul_precision": config.matmul_precision,
        "versions": provenance.versions(),
        "git_commit": provenance.git_commit(),
        "run_dir": str(session.log.run_dir),
        "signal": session.stop,
    }


def _job(config: DictConfig) -> None:
    """One run of the command."""
    given = command.asked(list(HydraConfig.get().overrides.task))
    summary = train(configuration.resolved(config), given)
    print(f"{_result(summary)} ({summary['wall_s']:.0f} s, {summary['run_dir']})", flush=True)
    if summary["signal"] is not None:
        sys.exit(128 + summary["signal"])
    if summary["diverged"]:
        left = len(summary["seeds"]) - len(summary["diverged"])
        raise DivergenceError(divergence.line(summary["diverged"], left, None))


def _result(summary: Mapping[str, Any]) -> str:
    """The evaluation and the training return, with the mean over seeds."""
    said = []
    for name, each in (("evaluation", "final_eval"), ("training return", "final_return")):
        values = summary[each]
        known = [value for value in values if value is not None]
        text = f"{sum(known) / len(known):,.1f}" if known else "none yet"
        if known and len(values) > 1:
            listed = ", ".join("-" if v is None else f"{v:,.1f}" for v in values)
            text += f" (mean of {len(known)} seeds: {listed})"
        said.append(f"{name} {text}")
    return "; ".join(said)


if __name__ == "__main__":
    command.hydra_main(_job)
