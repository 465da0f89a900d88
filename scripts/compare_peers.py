"""A peer's own implementation, by its own defaults, in an environment of Gymnasium's.

    python -m scripts.compare_peers method=CrossQ env=HalfCheetah-v5 seeds=5 seed=100 out=FILE.json
    python -m scripts.compare_peers method=CrossQ env=HalfCheetah-v5 total_steps=2000 out=FILE.json

The libraries are no dependencies of this one: `pip install sbx-rl` or `stable-baselines3`. Each
seed is a process of its own, all at the same time; the second command gives the clock of one that
runs alone. FILE is written again after each row of a seed:

* rows: seed -> {step, s, return} after every LOG decisions and at each evaluation. s: seconds since
  the process began to import the library, without evaluations. return: undiscounted mean of
  `eval_episodes` episodes without exploration, whose resets have the seeds 10000, 10001, ...; null
  between the evaluations.
* returns: {seeds, STEP: [a return for each seed]}, and clock: {learners, first, first_s, rate},
  which are what docs/results/peers.json has of a method.
"""

import json
import multiprocessing
import os
import signal
import time
from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from importlib.util import find_spec
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

from hybrid_rl.cli.arguments import Argument, one_of, output, read, whole
from hybrid_rl.errors import UsageError

LIBRARIES = {"sbx": "sbx-rl", "stable_baselines3": "stable-baselines3"}  # module -> its package
PACKAGES = (*LIBRARIES.values(), "gymnasium", "mujoco", "jax", "torch")
LOG = 1000  # decisions between rows
FIRST_RESET = 10_000  # seed of an evaluation's first episode
ARGUMENTS = (
    Argument("library", "sbx", "whose code", one_of(*LIBRARIES)),
    Argument("method", "", "its class, such as SAC", needed="method=SAC or another of its classes"),
    Argument("env", "", "id of Gymnasium's", needed="env=HalfCheetah-v5 or another id"),
    Argument("seeds", 1, "how many, each in a process", whole()),
    Argument("seed", 0, "the first", whole(0)),
    Argument("total_steps", 50_000, "decisions of each seed", whole()),
    Argument("eval_every", 10_000, "decisions", whole()),
    Argument("eval_episodes", 3, "of an evaluation", whole()),
    Argument("out", "", "JSON, written again after each row", needed="out=FILE.json"),
)
Row = dict[str, Any]  # step, s, return


class Record:
    """Sends a row of a model that trains; a callback of its `learn`, after each decision."""

    def __init__(self, given: Mapping[str, Any], began: float, send: Callable[[Row], None]) -> None:
        """given: of ARGUMENTS. began: [s] when the learner did, by time.perf_counter."""
        self.given, self.began, self.send = given, began, send
        self.env = gymnasium.make(given["env"])

    def after(self, model: Any) -> bool:
        """A row if it is time for one; true, so that the training goes on."""
        step, at = model.num_timesteps, time.perf_counter()
        evaluates = step % self.given["eval_every"] == 0
        if evaluates or step % LOG == 0:
            row = {"step": step, "s": round(at - self.began, 3), "return": None}
            if evaluates:
                episodes = range(self.given["eval_episodes"])
                row["return"] = round(float(np.mean([self.episode(model, i) for i in episodes])), 1)
                self.began += time.perf_counter() - at
            self.send(row)
        return True

    def episode(self, model: Any, number: int) -> float:
        """The undiscounted return of one episode without exploration."""
        obs, _ = self.env.reset(seed=FIRST_RESET + number)
        total, ended = 0.0, False
        while not ended:
            action, _ = model.predict(obs, deterministic=True)
            obs, reward, terminated, truncated, _ = self.env.step(action)
            total += float(reward)
            ended = terminated or truncated
        return total


def learner(given: Mapping[str, Any], seed: int, writer: Connection) -> None:
    """One seed, in this process: its rows into `writer`, or a UsageError in place of them."""
    began = time.perf_counter()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the command ends its learners itself
    os.environ.setdefault("XLA_PYTHON_CLIENT_PREALLOCATE", "false")  # the seeds share a GPU
    kind = getattr(import_module(given["library"]), given["method"], None)
    if not hasattr(kind, "learn"):
        line = f"method={given['method']}: {given['library']} has no such class that learns"
        writer.send(UsageError(line))
        return
    record = Record(given, began, writer.send)
    model = kind("MlpPolicy", gymnasium.make(given["env"]), seed=seed)
    model.learn(given["total_steps"], callback=lambda *_: record.after(model))


def side_by_side(given: Mapping[str, Any]) -> Iterator[tuple[int, Row]]:
    """(seed, row) of all seeds as they come."""
    context = multiprocessing.get_context("spawn")
    running, failed = {}, []
    try:
        for seed in range(given["seed"], given["seed"] + given["seeds"]):
            reader, writer = context.Pipe(duplex=False)
            running[reader] = seed, context.Process(target=learner, args=(given, seed, writer))
            running[reader][1].start()
            writer.close()
        while running:
            for reader in wait(list(running)):
                seed, process = running[reader]
                try:
                    row = reader.recv()
                except EOFError:
                    del running[reader]
                    process.join()
                    if process.exitcode:
                        failed.append(str(seed))
                    continue
                if isinstance(row, UsageError):
                    raise row
                yield seed, row
    finally:
        for _, process in running.values():
            process.terminate()
    if failed:
        raise ChildProcessError(f"seed {', '.join(failed)}: ended by the error above")


def returns(rows: Mapping[int, list[Row]]) -> dict[str, Any]:
    """{seeds, STEP: [S]} of the evaluations that all seeds have had."""
    found: dict[str, Any] = {"seeds": sorted(rows)}
    each = [{row["step"]: row["return"] for row in rows[seed]} for seed in found["seeds"]]
    for step, value in each[0].items():
        if value is not None and all(step in one for one in each):
            found[str(step)] = [one[step] for one in each]
    return found


def clock(rows: Mapping[int, list[Row]]) -> dict[str, Any] | None:
    """The median seed's seconds to its first row, and decisions/s after it; None before two rows.

    Of one learner alone only if seeds=1.
    """
    if min(map(len, rows.values())) < 2:
        return None
    pairs = [(each[0], each[-1]) for each in rows.values()]
    rates = [(b["step"] - a["step"]) / (b["s"] - a["s"]) for a, b in pairs]
    first_s = round(float(np.median([a["s"] for a, _ in pairs])), 1)
    found = {"learners": 1, "first": pairs[0][0]["step"], "first_s": first_s}
    return {**found, "rate": round(float(np.median(rates)), 1)}


def check(given: Mapping[str, Any]) -> None:
    """Check the arguments before a learner starts."""
    library, every, total = given["library"], given["eval_every"], given["total_steps"]
    if find_spec(library) is None:
        raise UsageError(f"library={library}: not installed; pip install {LIBRARIES[library]}")
    try:
        gymnasium.spec(given["env"])
    except (gymnasium.error.Error, ImportError) as error:
        raise UsageError(f"env={given['env']}: {error}") from error
    if total < min(every, LOG):
        raise UsageError(f"total_steps={total}: must be {min(every, LOG)} or more, for one row")
    output("out", given["out"], (".json",))


def main() -> None:
    """The command."""
    # Here, as a learner's clock starts without JAX.
    from hybrid_rl.files.atomic import write_text
    from hybrid_rl.run.machine.provenance import versions

    given: Any = read(__doc__, ARGUMENTS)[0]
    check(given)
    out = Path(given.pop("out"))
    rows: dict[int, list[Row]] = {}
    about = {**given, "versions": versions(PACKAGES)}
    for seed, row in side_by_side(given):
        rows.setdefault(seed, []).append(row)
        found = {**about, "returns": returns(rows), "clock": clock(rows), "rows": rows}
        write_text(out, json.dumps(found, indent=1) + "\n")
        print(f"seed {seed}: {row}", flush=True)


if __name__ == "__main__":
    from hybrid_rl.cli import command, interrupt  # here, as learners do not need what they import

    interrupt.install()
    command.run(main)
