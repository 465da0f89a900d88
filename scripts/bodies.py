"""Returns over decisions after a change of the body: who adapts, and from what.

    python -m scripts.bodies run=DIR change=env.mass=1.4 folder=runs/heavy out=heavy.json
    python -m scripts.bodies run=DIR change=env.mass=1.4 show=true

It trains the runs `folder`/WAY, unless they are there, and puts their evaluations into one file:

    refreshed  the model learns, the policy is frozen, and the gradient planner acts
    both       model and policy learn
    scratch    a new run

At 0 decisions `refreshed` is the frozen run: its policy, and the planner with the old model.
`before` is the policy on the body of its training. show=true only prints the commands.
"""

import shlex
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import Argument, flag, read, several, whole
from hybrid_rl.evaluate import evaluate
from hybrid_rl.run import folder
from hybrid_rl.run.retarget import disturbed
from hybrid_rl.run.saved import Trained, load
from scripts.seeds import Row, write

MODES = {"eval/return": "full", "eval/policy_return": "policy"}  # of metrics.jsonl
WAYS = ("refreshed", "both", "scratch")
ARGUMENTS = (
    Argument("run", "", "folder of a run of hybrid_stochastic", needed="run=DIR"),
    Argument("change", "", "env.KEY=VALUE or episode.KEY=VALUE", needed="change=env.KEY=VALUE"),
    Argument("ways", list(WAYS), "of these, with commas between them", several(*WAYS)),
    Argument("steps", 8000, "decisions after the change", whole()),
    Argument("every", 500, "decisions between evaluations", whole()),
    Argument("episodes", 3, "of an evaluation, for each seed", whole()),
    Argument("more", "", "words of all commands, such as physics=native"),
    Argument("new", "", "words of the new run alone, such as settings=light"),
    Argument("show", False, "true: print the commands alone", flag),
    Argument("folder", "runs/bodies", "of the runs"),
    Argument("out", "bodies.json", "the numbers"),
)


def words(given: dict[str, Any], way: str) -> list[str]:
    """The arguments of train for one of the ways."""
    then = folder.read(Path(given["run"]), "run")
    begun = [f"run={given['run']}"]
    own = {
        "refreshed": [*begun, "freeze=[policy]", "planner=gradient"],
        "both": begun,
        "scratch": [
            *(f"{key}={then[key]}" for key in ("task", "algo", "seed", "num_seeds")),
            *shlex.split(given["new"]),
        ],
    }
    return [
        *own[way],
        *shlex.split(given["change"]),
        f"total_steps={given['steps']}",
        f"eval_every={given['every']}",
        f"eval_episodes={given['episodes']}",
        "eval_modes=[full,policy]",
        *shlex.split(given["more"]),
        f"run_dir={Path(given['folder']) / way}",
    ]


def evaluations(run: Path) -> dict[str, dict[str, list[float]]]:
    """Mode -> decisions -> returns [S] of a run."""
    found: dict[str, dict[str, list[float]]] = {}
    for row in RunFolder(run).rows:
        for key, mode in MODES.items():
            if key in row:
                found.setdefault(mode, {}).setdefault(str(row["step"]), []).append(row[key])
    return found


def rows(given: dict[str, Any], trained: Trained) -> Iterator[Row]:
    """Train what is not there, and give what each way gave."""
    keys = (text.partition("=") for text in shlex.split(given["more"]))
    world = {key: value for key, _, value in keys if key.startswith(("env.", "episode."))}
    assert trained.config is not None
    before = replace(trained, episode=disturbed(trained.config, world))
    yield "before", {"policy": evaluate(before, "policy", given["episodes"])["return"].mean(1)}
    for way in given["ways"]:
        run = Path(given["folder"]) / way
        if not (run / "summary.json").exists():
            line = [sys.executable, "-m", "hybrid_rl.train", *words(given, way)]
            subprocess.run(line, check=True)
        for mode, each in evaluations(run).items():
            yield f"{way}, {mode}", each


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    if given["show"]:
        for way in given["ways"]:
            print(shlex.join(["python", "-m", "hybrid_rl.train", *words(given, way)]))
        return
    trained = load(given["run"])
    write(given["out"], trained, {"change": given["change"]}, rows(given, trained))


if __name__ == "__main__":
    command.run(main)
