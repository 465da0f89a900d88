"""What to choose from, one line each: tasks, methods, settings, parts, goals, experiments.

    python -m hybrid_rl.list
    python -m hybrid_rl.list config_dir=my_conf

The description is the first comment of the YAML file, or the first line of the module. Methods with
a comment "Needs an analytic task." are listed under [needs an analytic task], tasks that have what
some methods need likewise. With config_dir=DIR the entries of that folder, such as thesis/conf, are
listed, too.
"""

if __name__ == "__main__":
    from hybrid_rl.cli import interrupt

    interrupt.install()

from operator import itemgetter
from pathlib import Path

from hybrid_rl.cli import command
from hybrid_rl.cli.arguments import CONFIG_DIR, read
from hybrid_rl.errors import relative
from hybrid_rl.settings.groups import CONF, PACKAGE, THESIS, choices, files, search_path

MARKS = ("# Has ", "# Needs ")  # of a task, and of a method that not every task fits
GROUPS = {"task": "Tasks", "algo": "Methods", "settings": "Settings", "model": "Models"}
GROUPS |= {"planner": "Planners", "reward": "Goals", "constraint": "Constraints"}
GROUPS |= {"experiment": "Experiments"}
FIRST = (  # of the methods; parts of others and baselines follow
    *("hybrid_stochastic", "hybrid_deterministic", "sac", "flash_sac", "ppo", "nn_mppi"),
    *("hybrid_bc", "kle3", "koopman_active"),
)
ARGUMENTS = (CONFIG_DIR,)


def listing(conf: Path = CONF) -> dict[str, dict[str, Path]]:
    """Group -> name -> its YAML file, or its module."""
    modules = choices(CONF)["model"] if conf == CONF else ()
    plain = {name: PACKAGE / "models" / f"{name}.py" for name in modules}
    return {group: files(group, [conf]) | (plain if group == "model" else {}) for group in GROUPS}


def about(path: Path) -> str:
    """The first comment of a YAML file, except Hydra's `@package`, or a module's first line."""
    for line in path.read_text(encoding="utf-8").splitlines():
        text = line.strip('#" ')
        if line.startswith(("#", '"')) and text and not text.startswith("@package"):
            return text
    return ""


def mark(path: Path) -> str:
    """What a task has or a method needs, "needs an analytic task", by its file; or ""."""
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith(MARKS):
            return line[2].lower() + line[3:].rstrip(" .")
    return ""


def main() -> None:
    """The command."""
    given, _ = read(__doc__, ARGUMENTS)
    folders = [CONF, *([Path(given["config_dir"]).expanduser()] if given["config_dir"] else ())]
    if folders[-1].resolve() not in (CONF.resolve(), THESIS.resolve()):
        search_path(folders[-1])  # UsageError if there is no such folder
    listed = [listing(folder) for folder in folders]
    width = max(len(name) for groups in listed for names in groups.values() for name in names)
    for group, title in GROUPS.items():
        paths = {name: path for groups in listed for name, path in groups[group].items()}
        marks = {name: f"[{words}]" if (words := mark(paths[name])) else "" for name in paths}
        blocks = {"[start with these nine]": [name for name in FIRST if name in paths]}
        for name in sorted(paths.keys() - {*FIRST}, key=lambda name: (marks[name], name)):
            blocks.setdefault(marks[name], []).append(name)
        for words, names in filter(itemgetter(1), blocks.items()):
            print(f"{title}  ({group}=NAME)  {words}".rstrip())
            for name in names:
                also = marks[name] if name in FIRST else ""
                print(f"  {name:{width}}  {about(paths[name])} {also}".rstrip())
            print()
    print("python -m hybrid_rl.train task=NAME algo=NAME [experiment=NAME] [key=value ...]")
    if len(folders) == 1:
        print(f"python -m hybrid_rl.list config_dir={relative(THESIS)}  # with those of the thesis")


if __name__ == "__main__":
    command.run(main)
