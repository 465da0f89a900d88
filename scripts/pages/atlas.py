"""docs/atlas.md: every figure of the thesis with our result, from docs/atlas.yaml.

Numbers, seeds and commands are those of the JSON and of the pages of docs/results.
"""

import re
from collections.abc import Iterator
from typing import Any

import yaml

from scripts.pages.values import RESULTS, evaluated, read

DOCS = RESULTS.parent
MORE = "Numbers and seeds"
VERDICTS = ("holds", "holds in part", "does not hold", "nothing to test")
INTRODUCTION = """# Atlas: every figure and table of the thesis

<!-- Written by `make pages` from atlas.yaml and the JSON of results; do not edit. -->

I. Abraham, *Optimal Experimental Learning and Infinite Linear Embeddings*, Northwestern
University, 2020: what each figure and table claims, and what we found. A picture leads to the
page with bands, settings and commands. How the baselines were tuned: [printed, and
ours](results/printed.md). The [machines](results/machines.yaml).
"""


def entries() -> dict[str, dict[str, dict[str, Any]]]:
    """docs/atlas.yaml: chapter -> figure or table -> its entry."""
    return yaml.safe_load((DOCS / "atlas.yaml").read_text(encoding="utf-8"))


def filled(text: str) -> str:
    """The text with the value of each {EXPRESSION:FORMAT}."""
    return re.sub(r"\{([^{}]+?):([^{}:]*)\}", lambda m: format(evaluated(m[1])[0], m[2]), text)


def seeds(stem: str) -> str:
    """Seeds or trials of docs/results/STEM.json, or nothing."""
    for key, found in _items(read(stem)):
        if key == "seeds" and isinstance(found, list):
            return f"seeds {found[0]} to {found[-1]}"
        if key in ("seeds", "trials", "draws"):
            return f"{found} {key}"
        if key == "asked":  # of figure 6-9: one number of queries for each seed
            return f"{len(found)} seeds"
    return ""


def sources(entry: dict[str, Any]) -> str:
    """The JSON of an entry, those of the same seeds together."""
    groups: dict[str, list[str]] = {}
    for stem in entry["results"]:
        groups.setdefault(seeds(stem), []).append(f"[{stem}](results/{stem}.json)")
    texts = [f"{found}: {', '.join(files)}".removeprefix(": ") for found, files in groups.items()]
    return "; ".join(texts)


def _items(data: Any) -> Iterator[tuple[str, Any]]:
    """All keys and values of nested dicts and lists, outer ones first."""
    for value in data if isinstance(data, list) else data.values():
        if isinstance(data, list) and isinstance(value, dict | list):
            yield from _items(value)
    if isinstance(data, dict):
        yield from data.items()
        for value in data.values():
            if isinstance(value, dict | list):
                yield from _items(value)


def picture(entry: dict[str, Any]) -> str:
    """Path of an entry's picture, relative to docs, or nothing."""
    names = [f"{stem}.png" for stem in entry["results"]]
    name = entry.get("picture", (names or [""])[0])
    return (RESULTS / name).resolve().relative_to(DOCS).as_posix() if name else ""


def gallery(chapter: dict[str, dict[str, Any]]) -> str:
    """A picture, the claim and what we found of each figure, three in a row."""
    cells = [_cell(name, entry) for name, entry in chapter.items()]
    cells += [" "] * (-len(cells) % 3)
    rows = ["| " + " | ".join(cells[i : i + 3]) + " |" for i in range(0, len(cells), 3)]
    return "\n".join(["| | | |", "|---|---|---|", *rows])


def _cell(name: str, entry: dict[str, Any]) -> str:
    shown = f"[![{entry['title']}]({picture(entry)})]({entry['page']}) <br> "
    verdict = f"**{entry['verdict'].capitalize()}**"
    brief = f": {entry['brief']}" if "brief" in entry else ""
    text = f"[{name}]({entry['page']}). {entry['claim']} <br> {verdict}{brief}."
    return (shown if picture(entry) else "") + text


def entry_text(name: str, entry: dict[str, Any]) -> str:
    """What was found of one figure or table, from which numbers."""
    verdict, shows = entry["verdict"], filled(entry["shows"]).strip()
    part = ", with" if verdict == "holds in part" else ":"
    return f"* **{name}** {verdict}{part} {shows} ({sources(entry)})"


def page() -> str:
    """The text of docs/atlas.md."""
    chapters = entries()
    every = [entry["verdict"] for chapter in chapters.values() for entry in chapter.values()]
    counts = [f"| {verdict} | {every.count(verdict)} |" for verdict in VERDICTS]
    text = "\n".join(
        [INTRODUCTION, f"| {len(every)} figures and tables | |", "|---|---|", *counts, ""]
    )
    for title, chapter in chapters.items():
        parts = [entry_text(name, entry) for name, entry in chapter.items() if "shows" in entry]
        details = [f"<details>\n<summary>{MORE}</summary>\n", *parts, "\n</details>\n"]
        text += f"\n## {title}\n\n{gallery(chapter)}\n\n" + "\n".join(details)
    return text
