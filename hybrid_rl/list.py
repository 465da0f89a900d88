"""`python -m hybrid_rl.list`: tasks, algorithms and experiments, one line each.

What each is stands in the first comment of its YAML file.
"""

if __name__ == "__main__":
    from hybrid_rl import interrupt

    interrupt.install()

import sys
from pathlib import Path

from hybrid_rl import command
from hybrid_rl.config import CONF, UsageError

GROUPS = {"task": "Tasks", "algo": "Algorithms", "experiment": "Experiments"}


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
    """The first comment of a YAML file that is not meant for Hydra."""
    for line in path.read_text(encoding="utf-8").splitlines():
        text = line.lstrip("#").strip()
        if line.startswith("#") and text and not text.startswith("@package"):
            return text
    return ""


def main() -> None:
    """The command."""
    if sys.argv[1:]:
        raise UsageError(f"{sys.argv[1]}: the list takes no argument")
    found = listing()
    width = max(len(name) for names in found.values() for name in names)
    for group, names in found.items():
        print(f"{GROUPS[group]}  ({group}=NAME)" if names else f"{GROUPS[group]}: none")
        for name, text in names.items():
            print(f"  {name:{width}}  {text}".rstrip())
        print()
    print("python -m hybrid_rl.train task=NAME algo=NAME [experiment=NAME] [key=value ...]")


if __name__ == "__main__":
    command.guarded(main)
