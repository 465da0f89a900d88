"""The speed of worlds, planners, updates and whole loops on this machine, and of other libraries.

    python -m hybrid_rl.benchmark parts=physics,plan,shares,loop,compile out=benchmark.json
    python -m hybrid_rl.benchmark parts=loop model_learner.updates=1 planner.horizon=5
    python -m hybrid_rl.benchmark parts=loop settings=default,fast precision=tf32,bf16
    python -m hybrid_rl.benchmark parts=updates experiment= algo=sac

physics   physics steps a second by task, implementation and number of worlds, and bare loops
plan      model steps a second of the planner, by learners, K and T
act       decisions a second of a controller alone, by number of robots, and real time
updates   gradient steps a second of each learner, by number of them, and Brax's SAC
shares    where a decision's time goes: the loop with parts left out, and the products of each
loop      decisions a second of the whole training loop, by settings, learners and precision, and
          beside them those of a GPU
compile   seconds from start to the first decision, with an empty cache and a filled one

Keys of the method's own parts change it. What is compared is run in turns, by
hybrid_rl.benchmark.race. The numbers are printed, written as JSON and drawn, a picture a part.
"""

if __name__ == "__main__":
    from hybrid_rl import command

    command.install()

import json
from time import perf_counter
from typing import Any

from hybrid_rl import UsageError, arguments, command
from hybrid_rl.files.atomic import write_text
from hybrid_rl.networks.precision import PRECISIONS
from hybrid_rl.run.machine.jax_settings import prepare
from hybrid_rl.settings import build as config
from hybrid_rl.settings import groups as conf_files
from hybrid_rl.tools.benchmark.parts import PARTS, TASKS, Table

EXPERIMENT = "thesis/fig_3_2_halfcheetah"
SETTINGS = ("default", "light", "fast", "annealed", "thesis")
LEARNERS = ("plan", "act", "updates", "shares", "loop")
OF = {"tasks": ("physics",), "worlds": ("physics",), "plans": ("plan",), "learners": LEARNERS}
OF |= {"settings": ("shares", "loop")}
PLANNED = (
    *("planner", "objective", "reward_model", "model", "policy", "critic"),
    *("model_learner", "policy_learner"),
)
LOOP = {"experiment": "", "physics": "native"}  # what is not given, of part loop
SIZES = {  # of all parts, on a CPU and elsewhere
    "cpu": {"physics": "native", "worlds": "1,64", "learners": "1,4", "plans": "20x10,64x20"},
    "gpu": {
        "physics": "native,mjx",
        "worlds": "64,4096,65536",
        "learners": "1,10,64",
        "plans": "20x10,16384x32",
    },
}
ARGUMENTS = (
    arguments.Argument(
        "parts", ["physics", "plan", "shares", "loop"], "what to measure", arguments.several(*PARTS)
    ),
    arguments.Argument("tasks", "", f"of part physics; empty: {TASKS}"),
    arguments.Argument(
        "experiment", None, f"of other parts, may be empty; else {EXPERIMENT}, of loop none"
    ),
    arguments.Argument("algo", "hybrid_stochastic", "of all parts but physics"),
    arguments.Argument(
        "physics", None, "native,mjx,warp; else native, and mjx on a GPU, except of loop"
    ),
    arguments.Argument("worlds", None, "numbers of them, of part physics"),
    arguments.Argument("learners", None, f"numbers of them, of parts {', '.join(LEARNERS)}"),
    arguments.Argument("plans", None, "KxT, such as 20x10,64x20, of part plan"),
    arguments.Argument(
        "settings",
        [],
        f"of parts shares and loop, of {', '.join(SETTINGS)}",
        arguments.several(*SETTINGS),
    ),
    arguments.Argument(
        "precision",
        [],
        "of networks; of part loop several, or the method's",
        arguments.several(*PRECISIONS),
    ),
    arguments.Argument(
        "seconds", 3.0, "of a row of parts shares and loop, in each round", arguments.number(0.0)
    ),
    arguments.Argument("rounds", 5, "of which medians are taken", arguments.whole()),
    arguments.Argument("out", "benchmark.json", "the numbers; a picture in the same folder"),
)
GROUPS = {name: f"a key of the method's {name}" for name in PLANNED}


def _check(settings: dict[str, Any]) -> None:
    """Raise UsageError for a list that none of the parts uses, or an unknown task or method."""
    for name, parts in OF.items():
        if settings[name] and not set(parts) & set(settings["parts"]):
            value = settings[name]
            value = ",".join(value) if isinstance(value, list) else value
            line = f"{name}={value}: parts={','.join(settings['parts'])} does not use it"
            raise UsageError(f"{line}; {', '.join(parts)} would")
    arguments.several(*conf_files.options("task"))("tasks", settings["tasks"] or TASKS)
    arguments.several(*conf_files.options("algo"))("algo", settings["algo"])


def main() -> None:
    """The command."""
    import jax

    from hybrid_rl.run.machine import provenance
    from hybrid_rl.tools.benchmark.picture import draw

    given, changes = arguments.read(__doc__, ARGUMENTS, GROUPS)
    settings: dict[str, Any] = {**given, **changes}
    out, rounds = arguments.output("out", settings["out"], (".json",)), settings["rounds"]
    _check(settings)
    threads = ["physics=mjx"] if "mjx" in (settings["physics"] or "") else []
    precision = next(iter(settings["precision"]), "auto")
    prepare(config.load([*threads, f"precision={precision}"]))
    sizes = SIZES["cpu" if jax.default_backend() == "cpu" else "gpu"] | {"experiment": EXPERIMENT}
    machine = provenance.device()
    print(f"{machine}; medians of {rounds} rounds, ratios to the first line of a table")
    tables: list[Table] = []
    asked = {key: value for key, value in settings.items() if key != "out"}
    began = perf_counter()
    for at, part in enumerate(settings["parts"], 1):
        passed = f"{perf_counter() - began:,.0f} s so far"
        print(f"\npart {at} of {len(settings['parts'])}: {part}; {passed}", flush=True)
        left = sizes | (LOOP if part == "loop" else {})
        left = {key: value for key, value in left.items() if settings[key] is None}
        for table in PARTS[part](settings | left, rounds):
            tables.append(table)
            numbers = {"machine": machine, "versions": provenance.versions(), "asked": asked}
            write_text(out, json.dumps({**numbers, "tables": tables}, indent=1) + "\n")
    pictures = draw(tables, out.with_suffix(".png"))
    print(f"\n{out} and {', '.join(map(str, pictures))}")


if __name__ == "__main__":
    command.run(main)
