"""Returns of a trained run, as a table and in DIR/evaluation_<mode>.json.

    python -m hybrid_rl.evaluate run=runs/hopper/sac/TIME mode=policy episodes=20
    python -m hybrid_rl.evaluate policy=halfcheetah
    python -m hybrid_rl.evaluate policy=halfcheetah episode.delay=0.05 episode.sensor_noise=0.01
    python -m hybrid_rl.evaluate run=DIR reward=speed reward.target=5
    python -m hybrid_rl.evaluate run=DIR constraint=speed constraint.most=2 constraint.chance=0.1

With env.KEY=VALUE or episode.KEY=VALUE the world differs from that of the training, and the
controller does not; the file is then DIR/evaluation_<mode>_<changes>.json. A precision= that
differs from the run's is such a change, too.

With reward=NAME, of conf/reward, the world pays another reward, and a planner maximises it in the
model that the run has learned; nothing is trained. planner=NAME is another planner, and
planner.KEY=VALUE alone another value of a key of the one that the run has.

With constraint=NAME, of conf/constraint, the world counts the decisions that violate it, and the
planner keeps it; the return stays as it is.

Without exploration, with the learners as they were at the newest checkpoint. Of a sweep in one
program, run=DIR evaluates each run, and run=DIR/1 the second one. From Python,
`hybrid_rl.load` reads a run back, and `hybrid_rl.evaluate` gives its returns.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import json
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from hybrid_rl.analysis.curves import plural
from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import (
    CHANGES,
    CONFIG_DIR,
    GOAL,
    MODE,
    POLICY,
    Argument,
    one_of,
    read,
    whole,
)
from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import write_text
from hybrid_rl.networks.precision import PRECISIONS, choose, current
from hybrid_rl.run.evaluations import evaluate, report
from hybrid_rl.run.folder import members
from hybrid_rl.run.logs.progress import say
from hybrid_rl.run.retarget import load_changed

SILENCE = 10  # [s] between two lines of progress
ARGUMENTS = (
    Argument("run", "", "folder of the run"),
    POLICY,
    *GOAL,
    CONFIG_DIR,
    Argument("precision", "", "of networks; empty: as in training", one_of("", *PRECISIONS)),
    Argument("episodes", 10, "episodes of each seed", whole()),
    Argument("mode", "full", "full: planner and policy; policy or planner: one alone", MODE),
)


def main() -> None:
    """The command."""
    given, changes = read(__doc__, ARGUMENTS, CHANGES, ("run", "policy"))
    runs = [str(run) for run in members(Path(given["run"]))] if given["run"] else []
    for run in runs or [given["run"]]:
        _evaluate(given | {"run": run}, changes)


def _evaluate(given: dict[str, Any], changes: dict[str, str]) -> None:
    """Print and write the table of one run or policy."""
    mode, episodes, name = given["mode"], given["episodes"], given["run"] or given["policy"]
    trained, changes = load_changed(given, changes)
    own = current()
    if given["precision"]:
        choose(given["precision"])
        changes |= {"precision": now} if (now := current()) != own else {}
    print(*(f"{note}\n" for note in trained.notes), sep="", end="")
    trained.learner(mode=mode, world=True)  # before anything is compiled
    each = f"{plural(episodes, 'episode')} a seed"
    say(f"compiling, then {each} ...")  # of a planner, a minute
    got = evaluate(trained, mode, episodes, _progress(trained.episode.steps))
    values = report(trained, mode, got) | {"changes": changes, "precision": current()}
    words = [f"{key}={value}" for key, value in changes.items()]
    print(f"{name}, mode {mode}, step {trained.step:,}", *words, sep=", ")
    Console().print(_table(values))
    if not np.isfinite(got["return"]).all():
        paid = f"reward={given['reward']}" if given["reward"] else "the world's rewards"
        raise UsageError(f"{name}: a return is not finite: see {paid} and the controller's actions")
    if given["run"]:
        out = Path(given["run"]) / f"evaluation_{'_'.join([mode, *words])}.json"
        try:
            write_text(out, json.dumps(values, indent=1) + "\n")
            print(f"{each}; written to {out}")
        except OSError as error:  # the run of somebody else, say
            print(f"{each}; not written: {out}: {error.strerror}")


def _progress(steps: int) -> Callable[[int], None]:
    """A function that prints the decisions so far of `steps`, at most every ten seconds."""
    last = perf_counter()

    def progress(count: int) -> None:
        nonlocal last
        if perf_counter() - last > SILENCE:
            last = perf_counter()
            say(f"{count:,} of {steps:,} decisions")

    return progress


def _table(values: dict[str, Any]) -> Table:
    """A row for each seed, and one for the episodes of all of them."""
    extra = {"successes": ("success", "{:.0%}"), "violations": ("violations", "{:,.1f}")}
    extra = {name: found for name, found in extra.items() if found[0] in values}
    table = Table()
    for name in ("seed", "mean return", "std", "lowest", "highest", *extra):
        table.add_column(name, justify="right")
    each = list(enumerate(values["seeds"]))
    rows = [(str(seed), [number]) for number, seed in each]
    rows += [("all", [number for number, _ in each])] if len(each) > 1 else []
    for name, which in rows:
        returns = np.take(values["returns"], which, axis=0)
        numbers = (returns.mean(), returns.std(), returns.min(), returns.max())
        row = [f"{value:,.1f}" for value in numbers]
        row += [form.format(np.mean(np.take(values[key], which))) for key, form in extra.values()]
        table.add_row(name, *row, end_section=len(rows) > 1 and name == rows[-2][0])
    return table


command.make_callable(__name__, evaluate)

if __name__ == "__main__":
    command.run(main)
