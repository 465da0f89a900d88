"""Train: one run, or a sweep with -m.

    python -m hybrid_rl.train task=pendulum algo=sac total_steps=5000
    python -m hybrid_rl.train -m algo=sac,nn_mppi,hybrid_stochastic num_seeds=5
    python -m hybrid_rl.train resume=DIR total_steps=10000

A run goes into runs/TASK/ALGO/TIME, or run_dir=DIR. The jobs of a sweep are checked before the
first one begins; a job that fails does not end the others; jobs with one run_dir=DIR write into
DIR/0, DIR/1, ... An override that the method does not use is refused; in a sweep, one that none
of its methods uses.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig, OmegaConf

from hybrid_rl import config as configuration
from hybrid_rl import overrides
from hybrid_rl.cli import command, interrupt
from hybrid_rl.config import UNKNOWN, Run
from hybrid_rl.errors import DivergenceError, UsageError
from hybrid_rl.run import checkpoint, distributed, divergence, integrity, memory, provenance
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.integrity import write_text
from hybrid_rl.run.log import RunLog
from hybrid_rl.run.progress import Progress
from hybrid_rl.run.schedule import Schedule
from hybrid_rl.run.session import Session
from hybrid_rl.training.loop import Loop

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
    if config.get("distributed"):
        configuration.check(config)
        command.prepare(config)
        config = distributed.share(config)
        asked = {key: value for key, value in asked.items() if key != "distributed"}
    if config.resume is None:
        run = configuration.build(config)
        command.prepare(config)
        size = memory.replay(run)
        with run_folder.fresh(config) as folder:
            return _train(config, run, folder, size)
    folder = Path(str(config.resume))
    if done := _done(_settings(config, asked), folder):
        print(f"{folder}: finished already at {done['total_steps']:,}; raise total_steps to go on")
        return done | {"signal": None}
    with run_folder.locked(run_folder.writable(folder, "resume"), "resume"):
        config = _settings(config, asked)  # read again: another process may have gone on with it
        with run_folder.blamed(folder):
            run = configuration.build(config)
            command.prepare(config)
        return _train(config, run, folder, memory.replay(run))


def _train(config: DictConfig, run: Run, folder: Path, size: str) -> dict[str, Any]:
    """What summary.json holds, after a session in `folder`; size: a line about the replay memory."""
    label = f"{config.task} {config.algo}"
    with (
        integrity.naming(folder),
        RunLog(folder, run.seeds) as log,
        _progress(config, run, label) as progress,
    ):
        progress.note(f"{label}: run folder {folder}\n{size}")
        loop = Loop(run.agent, run.seeds, -(-config.log_every // config.num_envs))
        session = Session(loop, run.controllers, _schedule(config), log, progress)
        if config.resume is None:
            session.begin()
        else:
            with run_folder.blamed(folder):
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
    return summary if done and integrity.verify(newest) is None else None


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


def _job(config: DictConfig) -> dict[str, Any]:
    """One run of the command; returns what summary.json holds."""
    given = overrides.asked(HydraConfig.get().overrides.task)
    summary = train(configuration.resolved(config), given)
    print(f"{_result(summary)} ({summary['wall_s']:.0f} s, {summary['run_dir']})", flush=True)
    if summary["signal"] is not None:
        sys.exit(128 + summary["signal"])
    if summary.get("diverged"):
        left = len(summary["seeds"]) - len(summary["diverged"])
        raise DivergenceError(divergence.line(summary["diverged"], left, None))
    return summary


def _result(summary: Mapping[str, Any]) -> str:
    """The evaluation and the training return, with the mean over seeds."""
    said = []
    for name, each in (("evaluation", "final_eval"), ("training return", "final_return")):
        values = summary.get(each, [])
        known = [value for value in values if value is not None]
        text = f"{sum(known) / len(known):,.1f}" if known else "none yet"
        if known and len(values) > 1:
            listed = ", ".join("-" if v is None else f"{v:,.1f}" for v in values)
            text += f" (mean of {len(known)} seeds: {listed})"
        said.append(f"{name} {text}")
    return "; ".join(said)


if __name__ == "__main__":
    command.hydra_main(_job)
