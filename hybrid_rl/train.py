"""Train: one run, or a sweep with -m.

    python -m hybrid_rl.train task=pendulum algo=sac total_steps=5000
    python -m hybrid_rl.train -m algo=sac,nn_mppi,hybrid_stochastic num_seeds=5
    python -m hybrid_rl.train task=pendulum num_seeds=5 'sweep.policy_learner.discount=[0.98,0.99]'
    python -m hybrid_rl.train resume=DIR total_steps=10000
    python -m hybrid_rl.train run=DIR reward=speed reward.target=2 total_steps=5000

A run writes to runs/TASK/ALGO/TIME, or to run_dir=DIR. With three evaluations or more it ends with
their curve, DIR/curve.png. The jobs of a sweep are checked before the first
one starts; a job that fails does not end the others; jobs that share run_dir=DIR write to DIR/0,
DIR/1, ... An override that the method does not use is refused; in a sweep, one that none of its
methods uses. With sweep.KEY=[A,B,C], of numbers alone, these runs are trained side by side, in one
compiled program, and write to DIR/0, DIR/1, DIR/2; resume=DIR continues all of them.

From Python `hybrid_rl.train(...)` calls `train` of this module.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import signal
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict, Unpack

import numpy as np
from hydra.core.hydra_config import HydraConfig
from omegaconf import DictConfig

from hybrid_rl import api
from hybrid_rl.cli import command, hydra_line, interrupt
from hybrid_rl.errors import DivergenceError, UsageError
from hybrid_rl.run import assembled, divergence, folder, launch, members
from hybrid_rl.run.job import Output
from hybrid_rl.run.logs.progress import say
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.build import Run
from hybrid_rl.training.agent import Agent

if TYPE_CHECKING:
    from hybrid_rl.analysis.curves import Curve
    from hybrid_rl.run.saved import Trained

OnRow = Callable[[dict[str, Any]], Any]

EVALUATION = "eval/return"
CURVE = 3  # evaluations


class Result(dict[str, Any]):
    """The contents of summary.json, with the run's folder, its curves and its learners."""

    def __init__(self, summary: Mapping[str, Any], run: Run | None = None) -> None:
        super().__init__(summary)
        self._run = run  # of an agent; None: config.yaml has the parts
        self._folder = Path(self["run_dir"]).absolute()

    @property
    def folder(self) -> Path:
        """The run folder, as an absolute path: it holds after the working folder changes."""
        return self._folder

    def curves(self, metric: str = EVALUATION) -> "list[Curve]":
        """The curve of a metric, with arrays; see hybrid_rl.curves."""
        from hybrid_rl.analysis.curves import curves

        return curves(self.folder, metric)

    def load(self) -> "Trained":
        """The learners at the newest checkpoint; `.policy(seed)` maps observations to actions."""
        if self._run is None:
            return api.load(self.folder)
        from hybrid_rl.run import saved as trained

        return trained.of(self._run, self.folder)


class OfAgent(TypedDict, total=False):
    """Settings of a run of an agent; run.assembled says what a key that is left out means."""

    total_steps: int
    seed: int
    num_seeds: int
    run_dir: str | Path | None
    name: str | None
    log_every: int | None
    eval_every: int | None
    eval_episodes: int
    checkpoint_every: int | None


def train(
    method: Sequence[str] | DictConfig | Agent = (),
    *,
    config_dir: str | Path | None = None,
    on_row: OnRow | None = None,
    progress: bool = True,
    **settings: Unpack[OfAgent],
) -> Result:
    """Train `method` to its end; returns what summary.json holds.

        train(["task=pendulum", "algo=sac", "num_seeds=2"], on_row=print)
        train(["resume=runs/pendulum/sac/TIME", "total_steps=20000"])
        train(Agent(...), total_steps=10_000, num_seeds=5, run_dir="runs/mine")

    A signal, such as SIGTERM, ends it with a checkpoint, and then has its effect on the program.

    Args:
        method: what follows the command, as a list; a configuration of `compose`; or an agent,
            which continues where run_dir holds its checkpoints.
        config_dir: of a list, a folder as for `--config-dir`.
        on_row: called with each new row of metrics.jsonl, a dictionary. Once it returns False, or
            raises, the run ends with a checkpoint, and "finished" of the result is False.
        progress: False prints nothing.
        settings: of an agent alone (hybrid_rl.run.assembled.run_of): total_steps, seed, num_seeds,
            run_dir, name, log_every, eval_every, eval_episodes, checkpoint_every.

    Raises:
        KeyboardInterrupt: after Ctrl-C and a checkpoint.
        UsageError: if the configuration makes no run.
        DivergenceError: if every learner reached NaN or infinity.
        CheckpointError: if a checkpoint could not be written or read.
    """
    output = Output(on_row, progress)
    if isinstance(method, Agent):
        values: dict[str, Any] = {**settings}
        run = assembled.run_of(method, **values)
        result = Result(launch.train_built(run, interrupt.as_call, output), run)
    else:
        if settings:
            texts = ", ".join(f'"{key}={value}"' for key, value in settings.items())
            raise UsageError(f"train: keywords are for an agent; write train([{texts}, ...])")
        given = {} if isinstance(method, DictConfig) else overrides.typed_values(method)
        runs = members.load(method, config_dir)
        result = Result(launch.train(runs, given, interrupt.as_call, output))
    if result["signal"] is not None:
        signal.raise_signal(result["signal"])
    output.raise_problem()
    return result


def _job(config: DictConfig, on_row: OnRow | None = None) -> dict[str, Any]:
    """One run of the command; returns what summary.json holds. on_row: as of `train`."""
    typed = overrides.of_job(HydraConfig.get())
    runs, output = members.expand_sweep(config, typed), Output(on_row)
    summary = launch.train(runs, overrides.typed_values(typed), interrupt.as_call, output)
    output.raise_problem()
    if summary["signal"] is None:
        _curve(Path(summary["run_dir"]))
    swept = folder.members(Path(summary["run_dir"])).values()
    for each, values in zip(summary.get("runs", ()), swept, strict=True):
        say(f"{folder.words(values)}: {_result(each)} ({each['run_dir']})")
    what = f"{len(summary['runs'])} runs" if "runs" in summary else _result(summary)
    say(f"{what} ({summary['wall_s']:.0f} s, {summary['run_dir']})")
    if summary["signal"] is not None:
        say(folder.going_on(summary["run_dir"]))
        sys.exit(128 + summary["signal"])
    if summary.get("diverged"):
        left = len(summary["seeds"]) - len(summary["diverged"])
        raise DivergenceError(divergence.line(summary["diverged"], left, None))
    return summary


def _curve(run_dir: Path) -> None:
    """Draw the evaluations of a run, if there are at least CURVE of them."""
    from hybrid_rl.analysis import learning_curves
    from hybrid_rl.figures import save

    try:
        lines = learning_curves.curves(run_dir, EVALUATION)
    except UsageError:  # there are none
        return
    if np.isfinite(lines[0].iqm).sum() < CURVE:
        return
    drawn, flaw = run_dir / "curve.png", ""
    try:
        save(*learning_curves.figure(run_dir, EVALUATION), drawn)
    except OSError as error:
        flaw = f" not written ({error.strerror or error})"
    say(f"curve of the evaluations: {drawn}{flaw}")


def _result(summary: Mapping[str, Any]) -> str:
    """The last evaluation and training return, with their means over seeds."""
    parts = []
    for name, each in (("evaluation", "final_eval"), ("training return", "final_return")):
        values = summary.get(each, [])
        known = [value for value in values if value is not None]
        text = f"{sum(known) / len(known):,.1f}" if known else "none yet"
        if known and each == "final_return":
            text += " over the last tenth"  # the rows above have that of the last episode
        if known and len(values) > 1:
            listed = ", ".join("-" if v is None else f"{v:,.1f}" for v in values)
            text += f" (mean of {len(known)} seeds: {listed})"
        parts.append(f"{name} {text}")
    return "; ".join(parts)


command.make_callable(__name__, train)

if __name__ == "__main__":
    hydra_line.hydra_main(_job)
