"""Tasks, methods and experiments, one line each.

    python -m hybrid_rl.list
    python -m hybrid_rl.list config_dir=my_conf

The description is the first comment of the YAML file; a comment "Needs an analytic task." of a
method is listed as [needs an analytic task]. With config_dir=DIR, or --config-dir DIR
(two words) as for `train`, the entries of that folder are listed, too.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

import sys
from pathlib import Path

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import CONFIG_DIR, read
from hybrid_rl.composition import CONF, THESIS, search_path, tasks_with

HAS = {  # method of an environment -> its mark
    "dynamics": "analytic",
    "equilibrium": "equilibrium",
    "reference": "reference",
    "reward_of": "known reward",
}
NEEDS = "# Needs "  # begins the comment of a method that not every task fits
GROUPS = {"task": "Tasks", "algo": "Methods", "experiment": "Experiments"}
FIRST = (  # of the methods; parts of others and baselines follow
    *("hybrid_stochastic", "hybrid_deterministic", "sac", "flash_sac", "nn_mppi", "hybrid_bc"),
    *("kle3", "koopman_active"),
)
ARGUMENTS = (CONFIG_DIR,)


def listing(conf: Path = CONF) -> dict[str, dict[str, str]]:
    """Group -> name -> what it is."""
    return {
        group: {
            path.relative_to(conf / group).with_suffix("").as_posix(): about(path)
            for path in sorted((conf / group).rglob("*.yaml"))
        }
        for group in GROUPS
    }


def about(path: Path) -> str:
    """The first comment of a YAML file, except Hydra's `@package`."""
    for line in path.read_text(encoding="utf-8").splitlines():
        text = line.lstrip("#").strip()
        if line.startswith("#") and text and not text.startswith("@package"):
            return text
    return ""


def marks(conf: Path = CONF) -> dict[str, dict[str, str]]:
    """Group -> name -> what the environment of a task has, or that of a method must have."""
    has: dict[str, list[str]] = {}
    for method, mark in HAS.items():
        for name in tasks_with(method, conf=conf):
            has.setdefault(name, []).append(mark)
    tasks = {name: ", ".join(each) for name, each in has.items()}
    methods = {path.stem: needs(path) for path in sorted((conf / "algo").glob("*.yaml"))}
    return {"task": tasks, "algo": methods, "experiment": {}}


def needs(path: Path) -> str:
    """What a method says it needs, "needs an analytic task"; empty if it says nothing."""
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith(NEEDS):
            return f"needs {line.removeprefix(NEEDS).strip().rstrip('.')}"
    return ""


def _mark(needed: str | None) -> str:
    """What a task has or a method needs, in brackets."""
    return f"[{needed}]" if needed else ""


def main() -> None:
    """The command."""
    line = sys.argv[1:]
    if line[:1] == ["--config-dir"] and len(line) == 2:  # as `train` takes it
        sys.argv[1:] = [f"config_dir={line[1]}"]
    given, _ = read(__doc__, ARGUMENTS)
    folders = [CONF, THESIS]
    if given["config_dir"]:
        search_path(given["config_dir"])  # refuses what is no folder
        folders.insert(1, Path(given["config_dir"]).expanduser())
    listed = [(listing(folder), marks(folder)) for folder in folders]
    width = max(len(name) for names, _ in listed for group in GROUPS for name in names[group])
    for group, title in GROUPS.items():
        each = [
            {
                name: f"  {name:{width}}  {text} {_mark(restricted[group].get(name))}".rstrip()
                for name, text in names[group].items()
            }
            for names, restricted in listed
        ]
        theirs = each.pop()
        rows = {name: line for lines in each for name, line in lines.items()}
        first = [rows.pop(name) for name in FIRST if name in rows] if group == "algo" else []
        print(f"{title}  ({group}=NAME{'; start with these eight' if first else ''})")
        if first:
            print(*first, "", sep="\n")
        print(*rows.values(), "", sep="\n")
        if theirs:
            print(f"{title} by the thesis' names", *theirs.values(), "", sep="\n")
    print("python -m hybrid_rl.train task=NAME algo=NAME [experiment=NAME] [key=value ...]")


if __name__ == "__main__":
    command.run(main)
