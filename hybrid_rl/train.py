"""Train: one run, or a sweep with -m.

    python -m hybrid_rl.train task=pendulum algo=sac total_steps=5000
    python -m hybrid_rl.train -m algo=sac,nn_mppi,hybrid_stochastic num_seeds=5
    python -m hybrid_rl.train resume=DIR total_steps=10000

A run goes into runs/TASK/ALGO/TIME, or run_dir=DIR. The jobs of a sweep are checked before the
first one begins; a job that fails does not end the others; jobs with one run_dir=DIR write into
DIR/0, DIR/1, ... An override that the method does not use is refused; in a sweep, one that none
of its methods uses.
"""

import sys
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from tempfile import TemporaryFile
from types import MappingProxyType
from typing import Any

from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig, OmegaConf

from hybrid_rl import command, overrides
from hybrid_rl import config as configuration
from hybrid_rl.config import UNKNOWN, Run, UsageError
from hybrid_rl.training import checkpoint, provenance
from hybrid_rl.training.log import RunLog
from hybrid_rl.training.loop import Loop
from hybrid_rl.training.manifest import write_text
from hybrid_rl.training.progress import Progress
from hybrid_rl.training.session import Schedule, Session

NOTHING: Mapping[str, str] = MappingProxyType({})


def train(config: DictConfig, asked: Mapping[str, str] = NOTHING) -> dict[str, Any]:
    """Run `config` to its end, or to a signal; returns what summary.json holds.

    With `config.resume` the settings come from that run; `asked` are the overrides that the
    user gave beside it, of which only total_steps may differ.

    Raises:
        UsageError: where the configuration makes no run.
        DivergenceError: where a learner reached NaN or infinity.
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
        Progress(config.total_steps, label=label) as progress,
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
        session.run()
        summary = _summary(config, session)
        log.summary(summary)
    return summary


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
    learners = len(session.loop.seeds)
    return {
        "task": config.task,
        "algo": config.algo,
        "seeds": list(session.loop.seeds),
        "total_steps": session.step,
        "finished": session.step >= config.total_steps,
        "final_return": session.final_returns(),
        "wall_s": session.wall_s,
        "compile_s": session.loop.compile_s,
        "env_steps_per_s": session.step * learners / session.wall_s,
        "physics": configuration.physics(config).get("physics"),
        "device": provenance.device(),
        "matmul_precision": config.matmul_precision,
        "versions": provenance.versions(),
        "git_commit": provenance.git_commit(),
        "run_dir": str(session.log.run_dir),
        "signal": session.stop,
    }


def _job(config: DictConfig) -> dict[str, Any]:
    """One run of the command; returns what summary.json holds."""
    given = overrides.asked(HydraConfig.get().overrides.task)
    summary = train(configuration.resolved(config), given)
    shown = ", ".join("-" if r is None else f"{r:,.1f}" for r in summary["final_return"])
    print(f"final return: {shown} ({summary['wall_s']:.0f} s, {summary['run_dir']})", flush=True)
    if summary["signal"] is not None:
        sys.exit(128 + summary["signal"])
    return summary


if __name__ == "__main__":
    command.hydra_main(_job)
