"""Returns of a trained run, as a table and in DIR/evaluation_<mode>.json.

    python -m hybrid_rl.evaluate run=runs/hopper/sac/TIME mode=policy episodes=20
    python -m hybrid_rl.evaluate policy=halfcheetah
    python -m hybrid_rl.evaluate policy=halfcheetah episode.delay=1 episode.sensor_noise=0.01
    python -m hybrid_rl.evaluate run=DIR reward=speed reward.target=5
    python -m hybrid_rl.evaluate run=DIR constraint=speed constraint.most=2 constraint.chance=0.1

With env.KEY=VALUE or episode.KEY=VALUE the world differs from that of the training, and the
controller does not; the file is then DIR/evaluation_<mode>_<changes>.json. A precision= that
differs from the run's is such a change, too.

With reward=NAME, of conf/reward, the world pays another reward, and a planner maximises it in the
model that the run has learned; nothing is trained. planner=NAME is another planner, and
planner.KEY=VALUE alone another value of a key of the one that the run has. With imagine=policy the
policy goes on learning in that model before it acts, for seconds. Below the table is the return of
the policy alone.

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
from functools import partial
from itertools import count
from pathlib import Path
from time import perf_counter
from typing import Any

import jax
import jax.numpy as jnp
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
from hybrid_rl.envs.adapters.external import External
from hybrid_rl.errors import UsageError
from hybrid_rl.networks import precision
from hybrid_rl.networks.precision import PRECISIONS
from hybrid_rl.outside.host_loop import HostEvaluator
from hybrid_rl.run.evaluations import finish_episodes
from hybrid_rl.run.files.integrity import write_text
from hybrid_rl.run.folder import members
from hybrid_rl.run.logs.progress import say
from hybrid_rl.run.retarget import load_changed
from hybrid_rl.run.saved import Trained
from hybrid_rl.training.rollout import advance, begin, evaluation_keys

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


def evaluate(
    trained: Trained,
    mode: str = "full",
    episodes: int = 10,
    on_decisions: Callable[[int], None] = lambda made: None,
) -> dict[str, np.ndarray]:
    """Undiscounted `return` [S, episodes] of the same episodes as in training.

    If the task measures it, also `success` [S, episodes], 0 or 1; with a constraint also
    `violations` [S, episodes], in decisions. on_decisions: is called now and then with the number
    of decisions that every episode has made.

    Raises:
        UsageError: for a mode that the method does not have.
    """
    episode, (controller, _) = trained.episode, trained.learner(mode=mode, world=True)
    keys = jnp.stack([evaluation_keys(seed, episodes) for seed in trained.seeds])
    if isinstance(episode.env, External):
        decisions = count()
        got = HostEvaluator(episode, controller, trained.params, keys)(
            trained.params, keys, lambda: bool(on_decisions(next(decisions)))
        )
        return got or {}
    first = jax.jit(jax.vmap(partial(begin, episode, controller)))
    more = jax.vmap(partial(advance, episode, controller), (0, 0, None))
    more = partial(jax.jit(more, donate_argnums=1), trained.params)
    return finish_episodes(first(keys), more, episode.steps, on_decisions) or {}


def report(trained: Trained, mode: str, got: dict[str, np.ndarray]) -> dict[str, Any]:
    """What evaluation_<mode>.json holds."""
    returns = got["return"]
    more = {}
    if "success" in got:
        each = got["success"]
        more = {"success": each.mean(1).tolist(), "succeeded": each.astype(bool).tolist()}
    if "violations" in got:
        each = got["violations"]
        more |= {"violations": each.mean(1).tolist(), "violated": each.astype(int).tolist()}
    return {
        "mode": mode,
        "step": trained.step,
        "seeds": list(trained.seeds),
        "episodes": returns.shape[1],
        "mean": returns.mean(1).tolist(),
        "std": returns.std(1).tolist(),
        **more,
        "returns": returns.tolist(),
    }


def main() -> None:
    """The command."""
    given, changes = read(__doc__, ARGUMENTS, CHANGES)
    runs = [str(run) for run in members(Path(given["run"]))] if given["run"] else []
    for run in runs or [given["run"]]:
        _evaluated(given | {"run": run}, changes)


def _evaluated(given: dict[str, Any], changes: dict[str, str]) -> None:
    """Print and write the table of one run or policy."""
    episodes, name = given["episodes"], given["run"] or given["policy"]
    each = f"{plural(episodes, 'episode')} a seed"
    trained, changes = load_changed(given, changes)
    if given["precision"]:
        own = precision.current()
        precision.choose(given["precision"])
        if (now := precision.current()) != own:
            changes = {**changes, "precision": now}
    for note in trained.notes:
        print(note)
    trained.learner(mode=given["mode"], world=True)  # before anything is compiled
    say(f"compiling, then {each} ...")  # of a planner, a minute
    got = evaluate(trained, given["mode"], episodes, _saying(trained.episode.steps))
    values = report(trained, given["mode"], got)
    values |= {"changes": changes, "precision": precision.current()}
    where = "".join(f", {key}={value}" for key, value in changes.items())
    print(f"{name}, mode {given['mode']}, step {trained.step:,}{where}")  # whole, also in a pipe
    Console().print(_table(values))
    if not np.isfinite(got["return"]).all():
        paid = f"reward={given['reward']}" if given["reward"] else "the world's rewards"
        raise UsageError(f"{name}: a return is not finite: see {paid} and the controller's actions")
    if line := _policy_alone(trained, given):
        print(line)
    if not given["run"]:
        return
    stem = "_".join([given["mode"], *(f"{key}={value}" for key, value in changes.items())])
    out = Path(given["run"]) / f"evaluation_{stem}.json"
    try:
        write_text(out, json.dumps(values, indent=1) + "\n")
        print(f"{each}; written to {out}")
    except OSError as error:  # the run of somebody else, say
        print(f"{each}; not written: {out}: {error.strerror}")


def _policy_alone(trained: Trained, given: dict[str, Any]) -> str:
    """What a planner's return on a new goal compares with; empty: nothing."""
    full, policy = trained.controllers.get("full"), trained.controllers.get("policy")
    new = any(given[argument.name] for argument in GOAL)
    if not new or given["mode"] != "full" or policy in (None, full):
        return ""
    if isinstance(trained.episode.env, External):
        return "the policy alone: mode=policy"
    got = evaluate(trained, "policy", given["episodes"])
    violations = got.get("violations")
    more = "" if violations is None else f", {violations.mean():,.1f} violations"
    return f"the policy alone: {got['return'].mean():,.1f}{more} (mode=policy)"


def _saying(steps: int) -> Callable[[int], None]:
    """What prints a line, at most every ten seconds, with the decisions so far of `steps`."""
    last = perf_counter()

    def progress(count: int) -> None:
        nonlocal last
        if perf_counter() - last > SILENCE:
            last = perf_counter()
            say(f"{count:,} of {steps:,} decisions")

    return progress


def _table(values: dict[str, Any]) -> Table:
    """A row for each seed, and one for the episodes of all of them."""
    table = Table()
    extra = {"successes": ("success", "{:.0%}"), "violations": ("violations", "{:,.1f}")}
    extra = {name: found for name, found in extra.items() if found[0] in values}
    for name in ("seed", "mean return", "std", "lowest", "highest", *extra):
        table.add_column(name, justify="right")
    lines = [
        (str(seed), each, [i])
        for i, (seed, each) in enumerate(zip(values["seeds"], values["returns"], strict=True))
    ]
    if len(lines) > 1:
        lines.append(("all", np.ravel(values["returns"]), list(range(len(lines)))))
    for name, each, which in lines:
        numbers = (np.mean(each), np.std(each), np.min(each), np.max(each))
        row = [f"{value:,.1f}" for value in numbers]
        row += [form.format(np.mean(np.take(values[key], which))) for key, form in extra.values()]
        table.add_row(name, *row, end_section=len(lines) > 1 and name == lines[-2][0])
    return table


command.make_callable(__name__, evaluate)

if __name__ == "__main__":
    command.run(main)
