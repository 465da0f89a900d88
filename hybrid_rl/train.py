"""`python -m hybrid_rl.train task=T algo=A [key=value ...]`: one run, or a sweep with -m."""

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig, OmegaConf

from hybrid_rl import command, distributed, run_folder
from hybrid_rl import config as configuration
from hybrid_rl.config import UNKNOWN, Run, UsageError
from hybrid_rl.training import checkpoint, manifest, provenance
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
    if config.get("distributed"):
        configuration.check(config)
        command.prepare(config)
        config = distributed.share(config)
        asked = {key: value for key, value in asked.items() if key != "distributed"}
    if config.resume is None:
        run = configuration.build(config)
        command.prepare(config)
        memory = _memory(run)
        with run_folder.fresh(config) as folder:
            return _train(config, run, folder, memory)
    folder = Path(str(config.resume))
    if done := _done(_settings(config, asked), folder):
        print(f"{folder}: finished already at {done['total_steps']:,}; raise total_steps to go on")
        return done | {"signal": None}
    with run_folder.locked(run_folder.writable(folder, "resume"), "resume"):
        config = _settings(config, asked)  # read again: another process may have gone on with it
        with run_folder.blamed(folder):
            run = configuration.build(config)
            command.prepare(config)
        return _train(config, run, folder, _memory(run))


def _train(config: DictConfig, run: Run, folder: Path, memory: str) -> dict[str, Any]:
    """What summary.json holds, after a session in `folder`; memory: a line about the replay."""
    label = f"{config.task} {config.algo}"
    with (
        manifest.naming(folder),
        RunLog(folder, run.seeds) as log,
        Progress(config.total_steps, label=label) as progress,
    ):
        progress.note(f"{label}: run folder {folder}\n{memory}")
        loop = Loop(run.agent, run.seeds, -(-config.log_every // config.num_envs))
        session = Session(loop, run.controllers, _schedule(config), log, progress)
        if config.resume is None:
            session.begin()
        else:
            with run_folder.blamed(folder):
                session.resume()
        kept = OmegaConf.merge(config, {"resume": None})  # a resumed run may have become longer
        write_text(folder / "config.yaml", OmegaConf.to_yaml(kept))
        session.run()
        summary = _summary(config, session)
        log.summary(summary)
    return summary


def _settings(config: DictConfig, asked: Mapping[str, str]) -> DictConfig:
    """The configuration of the run that `config` resumes, as long as the user asked for."""
    configuration.check(config)
    folder = Path(str(config.resume))
    old = run_folder.read(folder, "resume")
    if not checkpoint.steps(folder / "checkpoints"):
        raise UsageError(f"resume={folder}: holds no checkpoint; start the run again")
    for key in asked.keys() - {"resume", "total_steps"}:
        before, now = (OmegaConf.select(c, key, default=UNKNOWN) for c in (old, config))
        if before is UNKNOWN or before != now:
            has = "" if before is UNKNOWN else f"; the run in resume={folder} has {before}"
            raise UsageError(
                f"{key}={asked[key]}: beside resume only total_steps can be changed{has}"
            )
    with run_folder.blamed(folder):
        configuration.check(old)
    if "total_steps" in asked:
        if config.total_steps < old.total_steps:
            raise UsageError(
                f"total_steps={config.total_steps}: the run in resume={folder} "
                f"has {old.total_steps}; it can be raised, not lowered"
            )
        old.total_steps = config.total_steps
    old.resume = config.resume
    return old


def _done(config: DictConfig, folder: Path) -> dict[str, Any] | None:
    """What summary.json holds where the run in `folder` has come to its end, with a checkpoint."""
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        done = summary["finished"] and summary["total_steps"] >= config.total_steps
        newest = folder / "checkpoints" / str(summary["total_steps"])
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return summary if done and manifest.flaw(newest) is None else None


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


def _job(config: DictConfig) -> None:
    """One run of the command."""
    given = command.asked(list(HydraConfig.get().overrides.task))
    summary = train(configuration.resolved(config), given)
    shown = ", ".join("-" if r is None else f"{r:,.1f}" for r in summary["final_return"])
    print(f"final return: {shown} ({summary['wall_s']:.0f} s, {summary['run_dir']})", flush=True)
    if summary["signal"] is not None:
        sys.exit(128 + summary["signal"])


if __name__ == "__main__":
    command.hydra_main(_job)
