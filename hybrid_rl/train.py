"""Train: one run, or a sweep with -m.

    python -m hybrid_rl.train task=pendulum algo=sac total_steps=5000
    python -m hybrid_rl.train -m algo=sac,nn_mppi,hybrid_stochastic num_seeds=5
    python -m hybrid_rl.train task=pendulum num_seeds=5 'sweep.policy_learner.discount=[0.98,0.99]'
    python -m hybrid_rl.train resume=DIR total_steps=10000
    python -m hybrid_rl.train run=DIR reward=speed reward.target=2 total_steps=5000

A run writes to runs/TASK/ALGO/TIME, or to run_dir=DIR. With three evaluations or more it ends with
their curve, on the console and in DIR/curve.png. The jobs of a sweep are checked before the first
one starts; a job that fails does not end the others; jobs that share run_dir=DIR write to DIR/0,
DIR/1, ... An override that the method, or one of those of a sweep, does not use is refused. With
sweep.KEY=[A,B,C], of numbers alone, these runs are trained side by side, in one compiled program,
and write to DIR/0, DIR/1, DIR/2; resume=DIR continues all of them.

From Python it is `hybrid_rl.train(...)`.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from omegaconf import DictConfig

from hybrid_rl.api import train
from hybrid_rl.cli import command, hydra_line, interrupt
from hybrid_rl.errors import DivergenceError
from hybrid_rl.run import folder, launch, members, session
from hybrid_rl.run.launch import Output
from hybrid_rl.run.logs.progress import say
from hybrid_rl.run.logs.records import result_line
from hybrid_rl.settings.words import typed_values


def _job(config: DictConfig, typed: Sequence[str]) -> dict[str, Any]:
    """One run of the command; returns what summary.json holds."""
    runs, output = members.expand_sweep(config, typed), Output(handled=interrupt.as_call)
    summary = launch.train(runs, typed_values(typed), output)
    run_dir = Path(summary["run_dir"])
    if summary["signal"] is None:
        from hybrid_rl.analysis import learning_curves  # imports matplotlib

        learning_curves.show(run_dir)
    swept = folder.members(run_dir).values()
    for each, values in zip(summary.get("runs", ()), swept, strict=True):
        say(f"{folder.words(values)}: {result_line(each)} ({each['run_dir']})")
    what = f"{len(summary['runs'])} runs" if "runs" in summary else result_line(summary)
    say(f"{what} ({summary['wall_s']:.0f} s, {run_dir})")
    if summary["signal"] is not None:
        say(folder.going_on(summary["run_dir"]))
        sys.exit(128 + summary["signal"])
    if summary.get("diverged"):
        left = len(summary["seeds"]) - len(summary["diverged"])
        raise DivergenceError(session.failure_line(summary["diverged"], left, None))
    return summary


command.make_callable(__name__, train)

if __name__ == "__main__":
    hydra_line.main(_job)
