"""Stops a run at random moments, resumes it, and compares it with one that was never stopped.

    python -m scripts.interrupt --trials 20 task=cartpole algo=hybrid_stochastic total_steps=3000

A trial starts the run in a process of its own and stops it `--stops` times, most times while it
trains, at a random moment and by a random one of FAULTS: a signal, two at once, a console that is
closed, a folder that is moved and, where this user may mount a small disk, a full one. A run that
was stopped before its first checkpoint starts over. Then it goes on to its end. Compared are the
newest checkpoints, bit for bit, and metrics.jsonl, all but its clocks. Exit code 1 where any
differs.
"""

import argparse
import contextlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from omegaconf import OmegaConf

from hybrid_rl.run.checkpoints import checkpoint, leaves
from hybrid_rl.settings import build as configuration
from hybrid_rl.training.loop import Loop

EARLY = 0.2  # share of the faults that come before the run trains, perhaps
DISK = 20_000_000  # [bytes]
Fault = Callable[[subprocess.Popen, Path], None]  # of a process that writes to a run folder


class Stop(NamedTuple):
    """One interruption."""

    by: str  # the signal
    code: int  # how the process ended
    step: int | None  # of the newest checkpoint then


class Trial(NamedTuple):
    """A run that was stopped, and went on to its end."""

    stops: list[Stop]
    difference: str  # from the run that was never stopped; "" where there is none


def start(overrides: Sequence[str]) -> subprocess.Popen:
    """`python -m hybrid_rl.train OVERRIDES`, silent."""
    line = [sys.executable, "-m", "hybrid_rl.train", *overrides]
    return subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def finish(overrides: Sequence[str]) -> float:
    """Run to the end; [s] that it took."""
    began = time.monotonic()
    process = start(overrides)
    errors = process.communicate()[1]
    if process.returncode:
        raise RuntimeError(f"{' '.join(overrides)}: exit code {process.returncode}: {errors}")
    return time.monotonic() - began


def stop(process: subprocess.Popen, by: Fault, run: Path) -> int:
    """Make a fault; the exit code, minus the signal where that killed it."""
    by(process, run)
    process.communicate()
    return process.returncode


def sent(*numbers: int) -> Fault:
    """Signals, all of them pending when the process goes on."""

    def fault(process: subprocess.Popen, run: Path) -> None:
        for number in (signal.SIGSTOP, *numbers, signal.SIGCONT):
            process.send_signal(number)

    return fault


def closed(process: subprocess.Popen, run: Path) -> None:
    """The pipe to which the run prints is closed; the run is terminated later."""
    assert process.stdout is not None
    process.stdout.close()
    process.stdout = None
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(random.uniform(0, 2))
    process.send_signal(signal.SIGTERM)


def moved(process: subprocess.Popen, run: Path) -> None:
    """The folder has another name until the process has ended."""
    if newest(run) is not None:
        elsewhere = run.rename(run.with_name(f"{run.name}-moved"))
        process.wait()
        elsewhere.rename(run)  # fails where the process has made it again
    else:
        process.kill()


def full(process: subprocess.Popen, run: Path) -> None:
    """Nothing more fits on the disk until the process has ended."""
    ballast = run.with_name("ballast")
    with contextlib.suppress(OSError), ballast.open("wb", 0) as file:
        while True:
            file.write(bytes(4096))
    process.wait()
    ballast.unlink()


FAULTS: dict[str, Fault] = {
    **{n.name: sent(n) for n in (signal.SIGKILL, signal.SIGINT, signal.SIGTERM, signal.SIGHUP)},
    "SIGINT and SIGTERM": sent(signal.SIGINT, signal.SIGTERM),
    "closed": closed,
    "moved": moved,
}


@contextlib.contextmanager
def small_disk(folder: Path) -> Iterator[bool]:
    """Whether `folder` is a disk of its own, of DISK bytes, within the block."""
    folder.mkdir(parents=True)
    line = ["mount", "-t", "tmpfs", "-o", f"size={DISK}", "tmpfs", str(folder)]
    mounted = os.geteuid() == 0 and subprocess.run(line, capture_output=True).returncode == 0
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", str(folder)], check=True)


def newest(run: Path) -> int | None:
    """The step of the newest checkpoint."""
    return next(reversed(checkpoint.steps(run / "checkpoints")), None)


def difference(run: Path, other: Path) -> str:
    """What sets two finished runs apart first; "" where they are the same, but for clocks."""
    (step, arrays), (other_step, other_arrays) = _state(run), _state(other)
    if step != other_step:
        return f"checkpoint {step} and {other_step}"
    for name, array in arrays.items():
        if array.tobytes() != other_arrays[name].tobytes():
            return f"{name} at step {step}"
    ours, theirs = rows(run), rows(other)
    for one, two in zip(ours, theirs, strict=False):
        if one != two:
            return f"row {one} and {two}"
    return "" if len(ours) == len(theirs) else f"{len(ours)} and {len(theirs)} rows"


def rows(run: Path) -> list[dict[str, Any]]:
    """Rows of metrics.jsonl without what a clock gave."""
    lines = (run / "metrics.jsonl").read_text(encoding="utf-8").splitlines()
    return [
        {k: v for k, v in json.loads(line).items() if k != "wall_s" and not k.startswith("perf/")}
        for line in lines
    ]


def _state(run: Path) -> tuple[int, dict[str, np.ndarray]]:
    """(step, name -> array) of the newest checkpoint."""
    config: Any = OmegaConf.load(run / "config.yaml")
    built = configuration.build(config)
    like = Loop(built.agent, built.seeds, 1).shapes()
    step, state, *_ = checkpoint.restore(run / "checkpoints", like)
    return step, leaves.flatten(state)[0]


def trial(
    overrides: Sequence[str],
    whole: Path,
    run: Path,
    stops: int,
    within: float,
    faults: Mapping[str, Fault] = FAULTS,
) -> Trial:
    """One run into `run`, stopped `stops` times, each `within` [s] of the start or of training."""
    made = []
    for _ in range(stops):
        by = random.choice([*faults])
        process = start(_or_resume(overrides, run))
        if random.random() > EARLY:
            _until(process, "compiled in")
        time.sleep(random.uniform(0, within))
        made.append(Stop(by, stop(process, faults[by], run), newest(run)))
    finish(_or_resume(overrides, run))
    return Trial(made, difference(whole, run))


def _until(process: subprocess.Popen, words: str) -> None:
    """Wait until the process prints a line with these words, or ends."""
    assert process.stdout is not None
    for printed in process.stdout:
        if words in printed:
            return


def _or_resume(overrides: Sequence[str], run: Path) -> list[str]:
    """Arguments that start the run in folder `run`, or go on with it where it has a checkpoint."""
    if newest(run) is not None:
        return [f"resume={run}"]
    shutil.rmtree(run, ignore_errors=True)
    return [*overrides, f"run_dir={run}"]


def line(number: int, done: Trial) -> str:
    """A trial in the table."""
    stops = ", ".join(f"{stop.by} -> {stop.code} at {stop.step}" for stop in done.stops)
    return f"{number:5}  {done.difference or 'same'}  {stops}"


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(description="Stop a run at random moments, and resume it.")
    parser.add_argument("--trials", type=int, default=20)
    parser.add_argument("--stops", type=int, default=2, help="interruptions of a trial")
    parser.add_argument("--seed", type=int, default=0, help="of the random moments")
    parser.add_argument("--within", type=float, help="[s] the latest moment; default: the run's")
    parser.add_argument("--keep", type=Path, help="folder of all runs; default: one that goes")
    parser.add_argument("overrides", nargs="+", help="of hybrid_rl.train")
    return parser.parse_args()


def main() -> int:
    """Exit code: 0 where all trials are the same as the run that was never stopped."""
    args = arguments()
    random.seed(args.seed)
    with tempfile.TemporaryDirectory() as spare:
        folder = args.keep or Path(spare)
        whole = folder / "whole"
        finish([*args.overrides, f"run_dir={whole}"])  # compiles, and keeps what it compiled
        within = args.within or finish([*args.overrides, f"run_dir={folder / 'again'}"])
        print(f"never stopped: {within:.0f} s, last checkpoint {newest(whole)}", flush=True)
        print("trial  result  signal -> exit code at newest checkpoint", flush=True)
        same, ends = 0, Counter()
        for number in range(1, args.trials + 1):
            with small_disk(folder / str(number)) as mounted:
                faults = FAULTS | ({"full": full} if mounted else {})
                run = folder / str(number) / "run"
                done = trial(args.overrides, whole, run, args.stops, within, faults)
            print(line(number, done), flush=True)
            same += not done.difference
            ends.update((each.by, each.code) for each in done.stops)
    for (by, code), times in sorted(ends.items()):
        print(f"{times:5}  {by} -> {code}")
    print(f"{same} of {args.trials} the same as the run that was never stopped")
    return int(same < args.trials)


if __name__ == "__main__":
    sys.exit(main())
