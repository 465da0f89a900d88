"""Tasks, methods and experiments, one line each.

    python -m hybrid_rl.list
    python -m hybrid_rl.list config_dir=my_conf

The description is the first comment of the YAML file. A comment "Needs an analytic task." of a
method is listed as [needs an analytic task], and "Has analytic dynamics." of a task likewise.
With config_dir=DIR the entries of that folder are listed, too.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

from pathlib import Path

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import CONFIG_DIR, read
from hybrid_rl.settings.groups import CONF, THESIS, search_path

MARKS = ("# Has ", "# Needs ")  # of a task, and of a method that not every task fits
GROUPS = {"task": "Tasks", "algo": "Methods", "experiment": "Experiments"}
FIRST = (  # of the methods; parts of others and baselines follow
    *("hybrid_stochastic", "hybrid_deterministic", "sac", "flash_sac", "ppo", "nn_mppi"),
    *("hybrid_bc", "kle3", "koopman_active"),
)
ARGUMENTS = (CONFIG_DIR,)


def listing(conf: Path = CONF) -> dict[str, dict[str, Path]]:
    """Group -> name -> its YAML file."""
    return {
        group: {
            path.relative_to(conf / group).with_suffix("").as_posix(): path
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


def mark(path: Path) -> str:
    """What a task has or a method needs, "needs an analytic task", by its file; or ""."""
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith(MARKS):
            return line[2].lower() + line[3:].rstrip(" .")
    return ""


def _row(name: str, path: Path, width: int) -> str:
    words = mark(path)
    return f"  {name:{width}}  {about(path)} {f'[{words}]' if words else ''}".rstrip()


def main() -> None:
    """The command."""
    given, _ = read(__doc__, ARGUMENTS)
    folders = [CONF, THESIS]
    if given["config_dir"]:
        search_path(given["config_dir"])  # refuses what is no folder
        folders.insert(1, Path(given["config_dir"]).expanduser())
    listed = [listing(folder) for folder in folders]
    width = max(len(name) for groups in listed for names in groups.values() for name in names)
    for group, title in GROUPS.items():
        *ours, theirs = [
            {name: _row(name, path, width) for name, path in groups[group].items()}
            for groups in listed
        ]
        rows = {name: line for lines in ours for name, line in lines.items()}
        first = [rows.pop(name) for name in FIRST if name in rows] if group == "algo" else []
        print(f"{title}  ({group}=NAME{'; start with these nine' if first else ''})")
        if first:
            print(*first, "", sep="\n")
        print(*rows.values(), "", sep="\n")
        if theirs:
            print(f"{title} by the thesis' names", *theirs.values(), "", sep="\n")
    print("python -m hybrid_rl.train task=NAME algo=NAME [experiment=NAME] [key=value ...]")


if __name__ == "__main__":
    command.run(main)
