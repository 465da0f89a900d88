"""The machines of the results: docs/results/machines.yaml."""

from fnmatch import fnmatch
from functools import cache
from typing import Any

import yaml

from scripts.pages.values import RESULTS


@cache
def entries() -> list[dict[str, Any]]:
    """docs/results/machines.yaml."""
    return yaml.safe_load((RESULTS / "machines.yaml").read_text(encoding="utf-8"))


def machine(stem: str) -> str:
    """The machine of most of docs/results/STEM.json; a file without words in brackets is first."""
    files = [(file, entry["machine"]) for entry in entries() for file in entry["files"]]
    for file, found in sorted(files, key=lambda pair: "(" in pair[0]):
        if fnmatch(stem, file.split(" (")[0]):
            return found
    raise ValueError(f"docs/results/machines.yaml has no machine of {stem}")
