"""The decision tree of docs/which_method.yaml, and the table of its leaves on which_method.md."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

FILE = Path(__file__).resolve().parents[2] / "docs" / "which_method.yaml"


def tree() -> dict[str, Any]:
    """The branch that begins it."""
    return yaml.safe_load(FILE.read_text(encoding="utf-8"))


def leaves(branch: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    """(the question before it with its answer, the leaf), from the first to the last."""
    for way, answer in (("then", "Yes"), ("else", "No")):
        if "ask" in branch[way]:
            yield from leaves(branch[way])
        else:
            yield f"{branch['ask']} {answer}", branch[way]


def table() -> str:
    """Last question, method, command and where to read on."""
    rows = ["| question | method | more |", "|---|---|---|"]
    rows += [f"| {path} | {leaf['name']} | {leaf['more']} |" for path, leaf in leaves(tree())]
    return "\n".join(rows) + "\n"
