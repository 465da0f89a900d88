"""docs/results/printed.yaml: the numbers of rows "as printed": the thesis' and ours."""

from typing import Any

import yaml

from scripts.pages.values import RESULTS


def entries() -> dict[str, Any]:
    """docs/results/printed.yaml."""
    return yaml.safe_load((RESULTS / "printed.yaml").read_text(encoding="utf-8"))


def table(name: str) -> str:
    """The rows of the chapter whose title begins with a name."""
    chapters = entries()["chapters"]
    chapter = next(chapter for title, chapter in chapters.items() if title.startswith(name))
    lines = [f"| {label} | `{line}` |" for label, line in chapter["rows"].items()]
    return "\n".join(["| row | `python -m hybrid_rl.train ...` |", "|---|---|", *lines]) + "\n"
