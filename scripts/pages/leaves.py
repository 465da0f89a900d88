"""The decision tree of docs/which_method.yaml, and the table of its leaves on which_method.md."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

FILE = Path(__file__).resolve().parents[2] / "docs" / "which_method.yaml"


def tree() -> dict[str, Any]:
    """The branch that begins it."""
    return yaml.safe_load(FILE.read_text(encoding="utf-8"))


def leaves(branch: dict[str, Any], agreed: str = "") -> Iterator[tuple[str, Any]]:
    """(the questions with a yes before it and the last one, the leaf), from the first to the last.

    agreed: questions with a yes before this branch.
    """
    for way, answer in (("then", "Yes"), ("else", "No")):
        path = f"{agreed}{branch['ask']} {answer}"
        if "ask" in branch[way]:
            yield from leaves(branch[way], f"{path}. " if answer == "Yes" else agreed)
        else:
            yield path, branch[way]


def table() -> str:
    """Questions, method, and where to read on."""
    rows = ["| questions | method | more |", "|---|---|---|"]
    rows += [f"| {path} | {leaf['name']} | {leaf['more']} |" for path, leaf in leaves(tree())]
    return "\n".join(rows) + "\n"
