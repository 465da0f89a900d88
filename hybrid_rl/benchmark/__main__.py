"""The speed of worlds, planners, updates and whole loops on this machine, and of other libraries.

    python -m hybrid_rl.benchmark parts=physics,plan,shares,loop,compile out=benchmark.json
    python -m hybrid_rl.benchmark parts=loop model_learner.updates=1 planner.horizon=5
    python -m hybrid_rl.benchmark parts=updates experiment= algo=sac

physics   physics steps a second by task, implementation and number of worlds, and bare loops
plan      model steps a second of the planner, by learners, K and T
act       decisions a second of a controller alone, by number of robots, and real time
updates   gradient steps a second of each learner, by number of them, and Brax's SAC
shares    where a decision's time goes
loop      decisions a second of the whole training loop, by number of learners
compile   seconds from start to the first decision, with an empty cache and a filled one

Keys of the method's own parts change it. What is compared is run in turns, by
hybrid_rl.benchmark.race. The numbers are printed, written as JSON and drawn, a picture a part;
by default it takes six minutes on two cores.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import json
import os
import subprocess
import sys
import tempfile
from dataclasses import replace
from time import perf_counter
from typing import Any

from hybrid_rl import config
from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import Argument, one_of, output, read, several, whole
from hybrid_rl.errors import UsageError
from hybrid_rl.networks.precision import PRECISIONS
from hybrid_rl.run.jax_settings import CACHE, prepare

TASKS = "halfcheetah,hopper,cartpole"
LEARNERS = ("plan", "act", "updates", "shares", "loop")
OF = {"tasks": ("physics",), "worlds": ("physics",), "plans": ("plan",), "learners": LEARNERS}
PLANNED = (
    "planner",
    "objective",
    "reward_model",
    "model",
    "policy",
    "critic",
    "model_learner",
    "policy_learner",
)
SIZES = {  # what is left empty, on a CPU and elsewhere
    "cpu": {"physics": "native", "worlds": "1,64", "learners": "1,4", "plans": "20x10,64x20"},
    "gpu": {
        "physics": "native,mjx",
        "worlds": "64,4096,65536",
        "learners": "1,64,512",
        "plans": "20x10,16384x32",
    },
}
Table = dict[str, Any]


def physics(settings: dict[str, str], rounds: int) -> list[Table]:
    """Worlds of every task, ours against bare loops of the same compiled model."""
    from hybrid_rl.benchmark import others, ours

    tables = []
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
            field += [theirs] if theirs and settings["physics"] != "native" else []
            name = f"{task}, {_many(count, 'world')}"
            table = _race("physics", name, "steps/s", field, rounds)
            tables.append(table | {"solver": others.solver(task)})
    return tables


def plan(settings: dict[str, str], rounds: int) -> list[Table]:
    """The planner alone, and one whose model is the world itself."""
    from hybrid_rl.benchmark import others, ours

    agent, world = _agent(settings), _agent(settings, settings["physics"].split(",")[-1]).episode
    tables = []
    for text in settings["plans"].split(","):
        samples, horizon = (whole()("plans", part) for part in text.split("x"))
        most = 2**20 // samples  # a large plan is for few learners
        try:
            planner = replace(agent.controller, horizon=horizon, samples=samples)
        except TypeError as error:
            raise UsageError(f"plan: {settings['algo']} has no planner by samples") from error
        planning = replace(agent, controller=planner)
        field = [
            ours.decisions(_many(learners, "learner"), planning, learners, samples * horizon)
            for learners in _counts(settings, "learners")
            if learners <= max(most, 1)
        ]
        field.append(others.on_the_true_model(world, samples, horizon))
        what = f"{settings['algo']}, K {samples:,}, T {horizon}"
        tables.append(_race("plan", what, "model steps/s", field, rounds))
    return tables


def act(settings: dict[str, str], rounds: int) -> list[Table]:
    """What any controller does in a decision."""
    from hybrid_rl.benchmark import ours

    agent = _agent(settings)
    field = [ours.decisions(_many(n, "robot"), agent, n) for n in _counts(settings, "learners")]
    real = f"real time: {1 / agent.spec.dt:,.0f} each"
    return [
        _race(
            "act", f"{settings['experiment']}, {settings['algo']}, {real}", "acts/s", field, rounds
        )
    ]


def updates(settings: dict[str, str], rounds: int) -> list[Table]:
    """One gradient step of each learner, and of another soft actor-critic of the same size."""
    from hybrid_rl.benchmark import others, ours

    agent, tables = _agent(settings), []
    for count in _counts(settings, "learners"):
        field = [ours.updates(f"{name} learner", agent, name, count) for name in agent.learners]
        for learner in agent.learners.values():
            critic: Any = getattr(learner, "critic", None)
            if critic is not None:
                size = learner.batch_size
                field.append(others.brax_sac(agent.spec, critic.hidden, size, count))
        what = f"{settings['algo']}, {_many(count, 'learner')}"
        tables.append(_race("updates", what, "gradient steps/s", field, rounds))
    return tables


def shares(settings: dict[str, str], rounds: int) -> list[Table]:
    """The whole loop with parts left out, and what the chip can do."""
    from hybrid_rl.benchmark import ours

    agent, decisions = _agent(settings), 500
    most = 64  # enough to see; more is the business of `loop`
    tables = [
        _race(
            "shares",
            f"{settings['algo']}, {_many(count, 'learner')}",
            "decisions/s",
            ours.shares(agent, count, decisions),
            rounds,
        )
        for count in _counts(settings, "learners")
        if count <= most
    ]
    return [*tables, _race("shares", "float32", "operations/s", [ours.product()], rounds)]


def loop(settings: dict[str, str], rounds: int) -> list[Table]:
    """Training, by number of learners."""
    from hybrid_rl.benchmark import ours

    field = []
    for implementation in settings["physics"].split(","):
        agent = _agent(settings, implementation)
        for count in _counts(settings, "learners"):
            name = f"{_many(count, 'learner')}, {implementation}"
            decisions = max(10, 200 // -(-count // 64))
            field.append(ours.loop(name, agent, count, decisions)[0])
    return [_race("loop", settings["algo"], "decisions/s", field, rounds)]


def compiling(settings: dict[str, str], rounds: int) -> list[Table]:
    """[1/s] of a start, from the command to its first decision, cold and cached."""
    with tempfile.TemporaryDirectory() as folder:
        line = [sys.executable, "-m", "hybrid_rl.train", f"experiment={settings['experiment']}"]
        line += [f"algo={settings['algo']}", "total_steps=1", "log_every=1", "eval_modes=[]"]
        own = {key: text for key, text in os.environ.items() if key != CACHE}
        rows = []
        for name in ("cold", "cached"):
            began = perf_counter()
            run = [*line, f"compile_cache={folder}/cache", f"run_dir={folder}/{name}"]
            subprocess.run(run, check=True, capture_output=True, env=own)
            rows.append({"name": name, "seconds": perf_counter() - began})
    for row in rows:
        row |= {"rate": 1 / row["seconds"], "best": 1 / row["seconds"], "memory": None}
        row["ratio"] = rows[0]["seconds"] / row["seconds"]
    return [{"part": "compile", "what": settings["algo"], "unit": "starts/s", "rows": rows}]


PARTS = {
    "physics": physics,
    "plan": plan,
    "act": act,
    "updates": updates,
    "shares": shares,
    "loop": loop,
    "compile": compiling,
}
ARGUMENTS = (
    Argument("parts", ["physics", "plan", "shares", "loop"], "what to measure", several(*PARTS)),
    Argument("tasks", "", f"of part physics; empty: {TASKS}"),
    Argument("experiment", "thesis/fig_3_2_halfcheetah", "of all other parts; may be empty"),
    Argument("algo", "hybrid_stochastic", "of all parts but physics"),
    Argument("physics", "", "empty: native on a CPU, native,mjx elsewhere; warp by name"),
    Argument("worlds", "", "numbers of them, of part physics"),
    Argument("learners", "", f"numbers of them, of parts {', '.join(LEARNERS)}"),
    Argument("plans", "", "KxT, such as 20x10,64x20, of part plan"),
    Argument("precision", "auto", "of networks", one_of(*PRECISIONS)),
    Argument("rounds", 5, "of which medians are taken", whole()),
    Argument("out", "benchmark.json", "the numbers; a picture in the same folder"),
)
GROUPS = {name: f"a key of the method's {name}" for name in PLANNED}


def _agent(settings: dict[str, str], physics: str = "auto") -> Any:
    names = [f"experiment={settings['experiment']}"] if settings["experiment"] else []
    names += [f"algo={settings['algo']}", f"physics={physics}"]
    names += [f"{key}={value}" for key, value in settings.items() if "." in key]
    steps = "total_steps=20000"  # bounds the replay memory of many learners
    return config.build(config.load([*names, steps])).agent


def _check(settings: dict[str, Any]) -> None:
    """Raise UsageError for a list that none of the parts uses, or an unknown task."""
    for name, parts in OF.items():
        if settings[name] and not set(parts) & set(settings["parts"]):
            line = f"{name}={settings[name]}: parts={','.join(settings['parts'])} does not use it"
            raise UsageError(f"{line}; {', '.join(parts)} would")
    several(*command.options("task"))("tasks", settings["tasks"] or TASKS)


def _many(count: int, what: str) -> str:
    return f"{count:,} {what}{'s' * (count != 1)}"


def _counts(settings: dict[str, str], key: str) -> list[int]:
    return [whole()(key, text) for text in settings[key].split(",")]


def _race(part: str, what: str, unit: str, field: list[Any], rounds: int) -> Table:
    """One table, printed as it is done."""
    from hybrid_rl.benchmark.race import race

    rows = race(field, rounds)
    print(f"\n{part}: {what} [{unit}]")
    for row in rows:
        memory = f"{row['memory'] / 1e6:9,.1f} MB a learner" if row["memory"] else ""
        print(f"  {row['name']:34} {row['rate']:16,.0f} {row['ratio']:9.2f} x {memory}", flush=True)
    return {"part": part, "what": what, "unit": unit, "rows": rows}


def main() -> None:
    """The command."""
    import jax

    from hybrid_rl.benchmark.picture import draw
    from hybrid_rl.run import provenance

    given, changes = read(__doc__, ARGUMENTS, GROUPS)
    settings: dict[str, Any] = {**given, **changes}
    out, rounds = output("out", settings["out"], (".json",), ".png"), settings["rounds"]
    _check(settings)
    threads = ["physics=mjx"] if "mjx" in settings["physics"] else []
    prepare(config.load([*threads, f"precision={settings['precision']}"]))
    sizes = SIZES["cpu" if jax.default_backend() == "cpu" else "gpu"]
    settings |= {key: value for key, value in sizes.items() if not settings[key]}
    machine = provenance.device()
    print(f"{machine}; medians of {rounds} rounds, ratios to the first line of a table")
    tables: list[Table] = []
    asked = {key: value for key, value in settings.items() if key != "out"}
    began = perf_counter()
    for number, part in enumerate(settings["parts"], 1):
        passed = f"{perf_counter() - began:,.0f} s so far"
        print(f"\npart {number} of {len(settings['parts'])}: {part}; {passed}", flush=True)
        tables += PARTS[part](settings, rounds)
        numbers = {"machine": machine, "versions": provenance.versions(), "asked": asked}
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(json.dumps({**numbers, "tables": tables}, indent=1) + "\n")
    pictures = draw(tables, out.with_suffix(".png"))
    print(f"\n{out} and {', '.join(map(str, pictures))}")


if __name__ == "__main__":
    command.guarded(main)
