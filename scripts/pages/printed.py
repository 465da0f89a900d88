"""docs/results/printed.yaml: the numbers of rows "as printed": the thesis' and ours."""

from typing import Any

import yaml

from scripts.pages.values import RESULTS


def entries() -> dict[str, Any]:
    """docs/results/printed.yaml."""
    return yaml.safe_load((RESULTS / "printed.yaml").read_text(encoding="utf-8"))


def table(kind: str, name: str) -> str:
    """The table of a chapter. kind: rows, printed or ours; name: how the chapter's title begins."""
    chapters = entries()["chapters"]
    chapter = next(chapter for title, chapter in chapters.items() if title.startswith(name))
    if kind == "rows":
        lines = [f"| {label} | `{line}` |" for label, line in chapter["rows"].items()]
        return "\n".join(["| row | `python -m hybrid_rl.train ...` |", "|---|---|", *lines]) + "\n"
    lines = [f"| {_reason(block)} | {_values(block)} |" for block in chapter[kind]]
    head = (
        "| printed in | values |"
        if kind == "printed"
        else "| not printed: why, and what was swept | values |"
    )
    return "\n".join([head, "|---|---|", *lines]) + "\n"


def _reason(block: dict[str, Any]) -> str:
    rows = f" ({'; '.join(block['only'])})" if "only" in block else ""
    return block.get("why", block.get("source", "")) + rows


def _values(block: dict[str, Any]) -> str:
    shown = {key: _text(value) for key, value in block.get("values", {}).items()}
    for key, values in block.get("any", {}).items():
        shown[key] = " or ".join(map(_text, values))
    return ", ".join(f"`{key}` {value}" for key, value in shown.items())


def _text(value: Any) -> str:
    text = str(value).lower() if isinstance(value, bool) else str(value)
    return text if len(text) < 100 else f"{text[:60]} ..."
