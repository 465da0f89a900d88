"""What the benchmark can measure: each part gives its tables one by one, printed as they are done.

A part gets the arguments of the command, and the number of rounds of a race.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from typing import Any

from hybrid_rl import Agent, UsageError, arguments, build, compose, precision
from hybrid_rl.tools.benchmark.race import Contestant, race

TASKS = "halfcheetah,hopper,cartpole"
REFERENCE = Path(__file__).resolve().parents[3] / "docs" / "results" / "loop_speed.json"
Settings = dict[str, Any]
Table = dict[str, Any]


def physics(settings: Settings, rounds: int) -> Iterator[Table]:
    """Worlds of every task, ours against bare loops of the same compiled model."""
    from hybrid_rl.tools.benchmark import others, ours

    for task in (settings["tasks"] or TASKS).split(","):
        for count in _counts(settings, "worlds"):
            field = []
            for implementation in settings["physics"].split(","):
                limit = 20_000 if implementation == "native" else 500
                decisions = max(20, min(20_000 // count, limit))
                own = ours.worlds(task, implementation, count, decisions)
                bare_steps = max(1, round(own.work / count))
                if implementation == "native":
                    bare = others.bare_native(task, count, bare_steps)
                else:
                    kind = {"mjx": "jax", "warp": "warp"}[implementation]
                    bare = others.bare_mjx(task, count, bare_steps, kind)
                field += [bare, own]
            theirs = others.playground(count, decisions) if task == "halfcheetah" else None
            if theirs is not None and settings["physics"] != "native":
                field.append(theirs)
            name = f"{task}, {plural(count, 'world')}"
            table = _race("physics", name, "steps/s", field, rounds)
            yield table | {"solver": others.solver(task)}


def plan(settings: Settings, rounds: int) -> Iterator[Table]:
    """The planner alone, and one whose model is the world itself."""
    from hybrid_rl.tools.benchmark import others, ours

    agent, world = _agent(settings), _agent(settings, settings["physics"].split(",")[-1]).episode
    controller: Any = agent.controller  # with fields of a planner by samples, if it is one
    for text in settings["plans"].split(","):
        samples, horizon = (arguments.whole()("plans", part) for part in text.split("x"))
        most = 2**20 // samples  # a large plan is for few learners
        try:
            planner = replace(controller, horizon=horizon, samples=samples)
        except TypeError as error:
            raise UsageError(f"plan: {settings['algo']} has no planner by samples") from error
        planning = replace(agent, controller=planner)
        field = [
            ours.decisions(plural(learners, "learner"), planning, learners, samples * horizon)
            for learners in _counts(settings, "learners")
            if learners <= max(most, 1)
        ]
        field.append(others.on_the_true_model(world, samples, horizon))
        what = f"{settings['algo']}, K {samples:,}, T {horizon}"
        yield _race("plan", what, "model steps/s", field, rounds)


def act(settings: Settings, rounds: int) -> Iterator[Table]:
    """What any controller does in a decision."""
    from hybrid_rl.tools.benchmark import ours

    agent = _agent(settings)
    field = [ours.decisions(plural(n, "robot"), agent, n) for n in _counts(settings, "learners")]
    real = f"real time: {1 / agent.spec.dt:,.0f} each"
    what = f"{settings['experiment']}, {settings['algo']}, {real}"
    yield _race("act", what, "acts/s", field, rounds)


def updates(settings: Settings, rounds: int) -> Iterator[Table]:
    """One gradient step of each learner, and of another soft actor-critic of the same size."""
    from hybrid_rl.tools.benchmark import others, ours

    agent = _agent(settings)
    for count in _counts(settings, "learners"):
        field = [ours.updates(f"{name} learner", agent, name, count) for name in agent.learners]
        for learner in agent.learners.values():
            critic: Any = getattr(learner, "critic", None)
            if critic is not None:
                size = learner.batch_size
                field.append(others.brax_sac(agent.spec, critic.hidden, size, count))
        what = f"{settings['algo']}, {plural(count, 'learner')}"
        yield _race("updates", what, "gradient steps/s", field, rounds)


def shares(settings: Settings, rounds: int) -> Iterator[Table]:
    """The whole loop with parts left out, their products alone, and what the chip can do."""
    from hybrid_rl.tools.benchmark import ours

    most = 64  # enough to see; more is the business of `loop`
    for size in settings["settings"] or ["default"]:
        agent = _agent(settings, size=size)
        for count in (n for n in _counts(settings, "learners") if n <= most):
            what = f"{settings['algo']}, {size}, {plural(count, 'learner')}"
            field, operations = ours.shares(agent, count, settings["seconds"])
            yield _race("shares", what, "decisions/s", field, rounds) | {"operations": operations}
    yield _race("shares", "float32", "operations/s", [ours.product()], rounds)


def loop(settings: Settings, rounds: int) -> Iterator[Table]:
    """Training: a table for each settings and number of learners, a row for each precision."""
    from hybrid_rl.tools.benchmark import ours

    for size in settings["settings"] or ["default"]:
        for count in _counts(settings, "learners"):
            field = []
            for implementation in settings["physics"].split(","):
                chosen = _config(settings, implementation, size)
                agent = build(chosen).agent
                for asked in settings["precision"] or [chosen.precision]:
                    with precision.using(asked):
                        name = f"{implementation}, {precision.current()}"
                        made = ours.loop(name, agent, count, ours.MOST, settings["seconds"])
                    field.append(made[0])
                    print(f"  {name}: compiled in {made[1]:,.0f} s", flush=True)
            what = f"{settings['algo']}, {size}, {plural(count, 'learner')}"
            table = _race("loop", what, "decisions/s", field, rounds)
            if not settings["experiment"] and not any("." in key for key in settings):
                _beside(table)
            yield table


def _beside(table: Table) -> None:
    """Print how each row compares with the committed one of its name, or else the first."""
    try:
        known = json.loads(REFERENCE.read_text(encoding="utf-8"))
    except OSError:  # the package without its documents
        return
    (theirs,) = [t["rows"] for t in known["tables"] if t["what"] == table["what"]] or [[]]
    rates = {row["name"]: row["rate"] for row in theirs}
    for row in table["rows"] if rates else ():
        name = row["name"] if row["name"] in rates else theirs[0]["name"]
        ratio, whose = row["rate"] / rates[name], f"{known['machine']}, {name}"
        print(f"  {row['name']:34} {ratio:.3f} of {rates[name]:,.0f} ({whose})", flush=True)


def compiling(settings: Settings, rounds: int) -> Iterator[Table]:
    """[1/s] of a start, from the command to its first decision, cold and cached."""
    with tempfile.TemporaryDirectory() as folder:
        line = [sys.executable, "-m", "hybrid_rl.train", f"experiment={settings['experiment']}"]
        line += [f"algo={settings['algo']}", "total_steps=1", "log_every=1", "eval_modes=[]"]
        own = {key: text for key, text in os.environ.items() if key != "JAX_COMPILATION_CACHE_DIR"}
        rows = []
        for name in ("cold", "cached"):
            began = perf_counter()
            run = [*line, f"compile_cache={folder}/cache", f"run_dir={folder}/{name}"]
            subprocess.run(run, check=True, capture_output=True, env=own)
            rows.append({"name": name, "seconds": perf_counter() - began})
    for row in rows:
        row |= {"rate": 1 / row["seconds"], "best": 1 / row["seconds"], "memory": None}
        row["ratio"] = rows[0]["seconds"] / row["seconds"]
    yield {"part": "compile", "what": settings["algo"], "unit": "starts/s", "rows": rows}


PARTS = {
    "physics": physics,
    "plan": plan,
    "act": act,
    "updates": updates,
    "shares": shares,
    "loop": loop,
    "compile": compiling,
}


def plural(count: int, noun: str) -> str:
    """The count with its noun: "1 seed", "2 seeds"."""
    return f"{count:,} {noun}{'s' * (count != 1)}"


def _agent(settings: Settings, physics: str = "auto", size: str = "default") -> Agent:
    return build(_config(settings, physics, size)).agent


def _config(settings: Settings, physics: str, size: str) -> Any:
    names = [f"experiment={settings['experiment']}"] if settings["experiment"] else []
    if size != "default":
        names.append(f"settings={size}")
    names += [f"algo={settings['algo']}", f"physics={physics}"]
    names += [f"{key}={value}" for key, value in settings.items() if "." in key]
    steps = "total_steps=20000"  # bounds the replay memory of many learners
    return compose([*names, steps])


def _counts(settings: Settings, key: str) -> list[int]:
    return [arguments.whole()(key, text) for text in settings[key].split(",")]


def _race(part: str, what: str, unit: str, field: list[Contestant], rounds: int) -> Table:
    """One table, printed as it is done."""
    rows = race(field, rounds)
    print(f"\n{part}: {what} [{unit}]")
    for row in rows:
        memory = f"{row['memory'] / 1e6:9,.1f} MB a learner" if row["memory"] else ""
        print(f"  {row['name']:34} {row['rate']:16,.0f} {row['ratio']:9.2f} x {memory}", flush=True)
    return {"part": part, "what": what, "unit": unit, "rows": rows}
