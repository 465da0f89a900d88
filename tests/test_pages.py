"""The pages: numbers are those of docs/results, links lead somewhere, the paper is as JOSS asks."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
import yaml

from scripts.pages import __main__ as command
from scripts.pages import marks, values

LIBRARY = [path for path in command.pages() if path.parent != values.RESULTS]  # others: thesis
LINE = {
    "label": "a",
    "task": "hop",
    "metric": "eval/return",
    "x": [5, 9],
    "each": [[3, 4], [5, 7], [4, 1]],
}
OTHER = {**LINE, "task": "run", "each": [[1000, 2000.4]]}
DATA = {
    "curves": [LINE, OTHER],
    "rows": [{"label": "a/b, c", "kind": "x", "n": 0.25}, {"label": "d", "kind": "y", "n": 0.5}],
    "band": {"iqm": 2, "low": 1, "high": 3},
    "found": [4, None, 6],
    "after": {"5": [3, 4], "9": [5, 7], "13": [6, 6]},
}
SENTENCE = 'it has <!-- = 100 * "made/rows/d/n" -->**40%**<!-- / --> of all'
SPEC = {
    "rows": {"hopping": "hop", "running": "run"},
    "cells": {"its mean": 'mean("made/{row}/a@{x}")'},
}
SPECS = {"made/a": SPEC, "made/b": {**SPEC, "except": {"sitting": {"its mean": None}}}}
TABLE = """<!-- table made/a -->
| | its mean | published |
|---|---|---|
| hopping, after 5 | 1.5 | 7 |
| running, 9 | **1** | 8 |
"""


@pytest.fixture
def results(tmp_path, monkeypatch):
    """A folder of results with made.json."""
    (tmp_path / "made.json").write_text(json.dumps(DATA))
    monkeypatch.setattr(values, "RESULTS", tmp_path)
    monkeypatch.setattr(marks, "tables", lambda: SPECS)
    for cached in (values.read, values.at):
        cached.cache_clear()
    yield tmp_path
    for cached in (values.read, values.at):
        cached.cache_clear()


@pytest.mark.parametrize("page", LIBRARY, ids=lambda path: path.name)
def test_a_page_is_the_one_that_the_command_writes(page):
    assert command.text(page) == page.read_text(encoding="utf-8"), "`make pages` writes it"


def test_a_changed_json_changes_the_marked_numbers_and_nothing_else(results):
    assert marks.written(SENTENCE) == SENTENCE.replace("40", "50")
    table = marks.written(TABLE)
    assert table == TABLE.replace("| 1.5 |", "| 4.0 |").replace("**1**", "**2,000**")
    assert marks.written(table) == table


EVALUATED = [
    ('"made/rows/d/n", 7', [0.5, 7]),
    ('"made/rows/a/b, c/n"', [0.25]),  # a label with a slash
    ('"made/rows/kind=y/n"', [0.5]),
    ('max("made/rows/*/n") - 1', [-0.5]),
    ('"made/band"', [2, 1, 3]),
    ('median("made/found")', [6]),  # null: never
    ('sum("made/found" < 7)', [2]),
    ('"made/hop/a@9"', [4, 7, 1]),
    ('range("made/hop/a@end")', [4, 1, 7]),
    ('mean(area("made/hop/a", 5))', [4]),
    ('ahead("made/run/a@5", "made/hop/a@5")', [100, 100, 100]),
    ('p_within("made/run/a@5", "made/hop/a@5", "made/run/a@5", "made/hop/a@5")', [0.0577795711]),
    ('reached("made/after", 6), reached("made/after", 7)', [9, np.inf]),
    ('peak("made/run/a"), peak_at("made/run/a")', [2000.4, 9]),
]


@pytest.mark.parametrize(("expression", "expected"), EVALUATED)
def test_an_expression_is_evaluated(results, expression, expected):
    assert values.evaluated(expression) == pytest.approx(expected)


@pytest.mark.parametrize(
    "wrong",
    [
        SENTENCE.replace("/d/", "/e/"),  # no such row
        SENTENCE.replace('100 * "made/rows/d/n"', '"made/curves/a@5"'),  # two lines have it
        SENTENCE.replace("100 * ", "__import__"),
        SENTENCE.replace("40%", "40% and 50%"),  # a number more than the expression has
        SENTENCE.removesuffix("<!-- / --> of all"),
        SENTENCE.removeprefix("it has "),  # Markdown would show no text of this line
        TABLE.replace("-->\n", "-->\nText.\n"),
        TABLE.replace("made/a", "made/b"),  # whose exception is of no row
        TABLE.replace("made/a", "made/c"),
    ],
)
def test_a_wrong_mark_is_an_error(results, wrong):
    with pytest.raises(ValueError, match=r"\w"):
        marks.written(wrong)


def test_every_specification_is_of_a_table_of_a_page():
    text = "".join(page.read_text(encoding="utf-8") for page in command.pages())
    assert sorted(re.findall(r"<!-- table (\S+) -->", text)) == sorted(marks.tables())


def test_no_command_of_a_page_replaces_our_numbers():
    """A reader may copy it."""
    pages = {path: path.read_text(encoding="utf-8") for path in values.RESULTS.parent.rglob("*.md")}
    assert {"atlas.md", "chapter6.md"} <= {path.name for path in pages}
    writes = re.compile(r"^.*(?:\bout=|--out[ =]|> *)docs/.*$", re.MULTILINE)
    found = {path.name: writes.findall(text) for path, text in pages.items()}
    assert not {name: lines for name, lines in found.items() if lines}


ROOT = Path(__file__).resolve().parents[1]
AT_TOP = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")
PAGES = [*(ROOT / name for name in AT_TOP), *sorted((ROOT / "docs").rglob("*.md"))]
CITING = [*PAGES, ROOT / "CITATION.cff", *sorted((ROOT / "paper").glob("paper.*"))]
CITING += sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
EXTERNAL = re.compile(r"\bhttps?:[^\s)}>\"'`\\]*")
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)(?:#([^)\s]+))?\)")


def anchors(page):
    """GitHub's anchors of the headings of a page."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize(
    "page", [*PAGES, ROOT / "paper" / "paper.md"], ids=lambda page: str(page.relative_to(ROOT))
)
def test_links_exist(page):
    links = LINK.findall(page.read_text(encoding="utf-8"))
    targets = [(page.parent / path if path else page, anchor) for path, anchor in links]
    missing = [str(path) for path, _ in targets if not path.exists()]
    missing += [f"{path}#{a}" for path, a in targets if a and a not in anchors(path)]
    assert not missing


def test_every_picture_is_on_a_page():
    texts = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    pictures = [p.name for end in ("png", "gif") for p in (ROOT / "docs").rglob(f"*.{end}")]
    assert not [name for name in pictures if f"/{name})" not in texts and f"({name})" not in texts]


def malformed(text):
    """External links of a text that are not https://HOST.DOMAIN, or end with punctuation."""
    links = EXTERNAL.findall(text)
    form = re.compile(r"https://[\w-]+(\.[\w-]+)+(/\S*)?")
    return [link for link in links if not form.fullmatch(link) or link[-1] in ".,;:"]


def test_external_links_have_the_right_form():
    """`make docs ARGS=links` requests them."""
    texts = [path.read_text(encoding="utf-8") for path in CITING]
    assert any(EXTERNAL.search(text) for text in texts)
    assert not [link for text in texts for link in malformed(text)]


FOLDER = ROOT / "paper"
_, MATTER, TEXT = (FOLDER / "paper.md").read_text(encoding="utf-8").split("---\n", 2)
PROSE = re.sub(r"<!--.*?-->", "", TEXT, flags=re.DOTALL)
SECTIONS = ["Summary", "Statement of need", "State of the field", "Software design"]
SECTIONS += ["Research impact statement", "AI usage disclosure", "Acknowledgements", "References"]
WORDS = (750, 1750)  # https://joss.readthedocs.io/en/latest/paper.html, as of 2026
NAMES = r"TD-MPC2|DreamerV3|Stable-Baselines3|KL-E3|MuJoCo Playground|95% bootstrap"


def test_its_sections_and_length_are_those_that_the_journal_asks_for():
    assert re.findall(r"^# (.+)$", TEXT, re.MULTILINE) == SECTIONS
    assert WORDS[0] <= len(PROSE.split()) <= WORDS[1]
    matter = yaml.safe_load(MATTER)
    assert {"title", "tags", "authors", "affiliations", "date", "bibliography"} <= matter.keys()


def test_each_reference_is_cited_and_each_citation_is_there():
    entries = re.findall(r"^@\w+\{(\w+),", (FOLDER / "paper.bib").read_text(encoding="utf-8"), re.M)
    assert len(entries) == len(set(entries))
    assert set(entries) == set(re.findall(r"@(\w+)", PROSE))


def test_every_number_is_written_from_the_results():
    """`make pages` writes those between marks, and tests/test_pages.py compares."""
    marked = re.sub(r"<!-- = .*?<!-- / -->", "", TEXT, flags=re.DOTALL)
    names = re.sub(rf"{NAMES}|`[^`]*`|\[[@;\w ]+\]|\]\([^)]*\)", "", marked)
    assert re.findall(r"\d+", names) == []
