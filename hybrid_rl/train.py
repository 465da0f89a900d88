"""Train: one run, or a sweep with -m.

    python -m hybrid_rl.train task=pendulum algo=sac total_steps=5000
    python -m hybrid_rl.train -m algo=sac,nn_mppi,hybrid_stochastic num_seeds=5
    python -m hybrid_rl.train resume=DIR total_steps=10000

A run writes to runs/TASK/ALGO/TIME, or to run_dir=DIR. With three evaluations or more it ends with
their curve, on the console and in DIR/curve.png. The jobs of a sweep are checked before the first
one starts; a job that fails does not end the others; jobs that share run_dir=DIR write to DIR/0,
DIR/1, ... An override that the method does not use is refused; in a sweep, one that none of its
methods uses.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import shlex
import signal
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig

from hybrid_rl import config as configuration
from hybrid_rl import overrides
from hybrid_rl.cli import command, interrupt
from hybrid_rl.errors import DivergenceError, UsageError
from hybrid_rl.run import curve, divergence, launch
from hybrid_rl.run.progress import say

EVALUATION = "eval/return"
CURVE = 3  # evaluations


def train(config: DictConfig, given: Mapping[str, str] = launch.NOTHING) -> dict[str, Any]:
    """Run `config` to its end, or to a signal; returns what summary.json holds.

    given: the overrides of the user, key -> value; of a run that `config.resume` names only
    total_steps may differ from its settings. A signal, such as SIGTERM, has the effect that it has
    in the calling program once the checkpoint is written.

    Raises:
        KeyboardInterrupt: after Ctrl-C and a checkpoint.
        UsageError: if the configuration makes no run.
        DivergenceError: if every learner reached NaN or infinity.
        CheckpointError: if a checkpoint could not be written or read.
    """
    summary = launch.train(config, given, interrupt.answered)
    if summary["signal"] is not None:
        signal.raise_signal(summary["signal"])
    return summary


def _job(config: DictConfig) -> dict[str, Any]:
    """One run of the command; returns what summary.json holds."""
    given = overrides.given(overrides.of_job(HydraConfig.get()))
    config = configuration.resolved(config)
    summary = launch.train(config, given, interrupt.answered)
    if summary["signal"] is None:
        _curve(Path(summary["run_dir"]))
    say(f"{_result(summary)} ({summary['wall_s']:.0f} s, {summary['run_dir']})")
    if summary["signal"] is not None:
        resume = shlex.quote(f"resume={overrides.quoted(summary['run_dir'])}")
        say(f"continue: python -m hybrid_rl.train {resume}")
        sys.exit(128 + summary["signal"])
    if summary.get("diverged"):
        left = len(summary["seeds"]) - len(summary["diverged"])
        raise DivergenceError(divergence.line(summary["diverged"], left, None))
    if config.resume is None and config.total_steps <= config.random_steps:
        print(f"nothing but random actions: random_steps={config.random_steps}", flush=True)
    if config.resume is None and not config.eval_modes:
        print("nothing was evaluated: eval_modes=[]", flush=True)
    return summary


def _curve(run_dir: Path) -> None:
    """Print and draw the evaluations of a run, if there are at least CURVE of them."""
    from hybrid_rl.figures import save
    from hybrid_rl.studies import curves_picture, learning_curves

    try:
        (line,) = learning_curves.curves(run_dir, EVALUATION)
    except UsageError:  # there are none
        return
    known = np.isfinite(line.iqm)
    if known.sum() < CURVE:
        return
    drawn = run_dir / "curve.png"
    try:
        for path in (drawn, drawn.with_suffix(".json")):
            if path.is_symlink():  # of a run of somebody else
                path.unlink()
        save(*learning_curves.figure(run_dir, EVALUATION), drawn)
    except OSError as error:
        say(f"{drawn}: not written ({error.strerror or error})")
    title = f"{curves_picture.LABELS[EVALUATION]} ({drawn})"
    say(curve.drawn(line.x[known], line.iqm[known], title, "decisions"))


def _result(summary: Mapping[str, Any]) -> str:
    """The last evaluation and training return, with their means over seeds."""
    parts = []
    for name, each in (("evaluation", "final_eval"), ("training return", "final_return")):
        values = summary.get(each, [])
        known = [value for value in values if value is not None]
        text = f"{sum(known) / len(known):,.1f}" if known else "none yet"
        if known and len(values) > 1:
            listed = ", ".join("-" if v is None else f"{v:,.1f}" for v in values)
            text += f" (mean of {len(known)} seeds: {listed})"
        parts.append(f"{name} {text}")
    return "; ".join(parts)


if __name__ == "__main__":
    command.hydra_main(_job)
