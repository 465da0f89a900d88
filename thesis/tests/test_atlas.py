"""docs/atlas.md has every figure and table of the thesis, and agrees with the pages of results."""

import re
from pathlib import Path

import pytest

from scripts.pages import atlas
from scripts.pages.marks import NUMBER

ROOT = Path(__file__).resolve().parents[2]
LAST = {3: 6, 4: 2, 5: 7, 6: 10, 7: 7}  # chapter of the thesis -> its last figure
TABLES = {"Table 6.1", "Table B.1", "Table C.1"}
NO = r"does not (hold|agree)|: no\b"  # words of a section for a verdict
YES = r"\b(holds|agrees)\b(?! against)"
WORDS = {
    "holds": YES,
    "holds with": rf"{YES}|\bimproves\b|makes the\s+policy good",
    "does not hold": NO,
}


@pytest.fixture(scope="module")
def entries():
    """Figure or table -> its entry."""
    return {name: entry for chapter in atlas.entries().values() for name, entry in chapter.items()}


def test_every_figure_and_table_of_the_thesis_has_an_entry(entries):
    figures = {f"Figure {c}-{i + 1}" for c, last in LAST.items() for i in range(last)}
    assert set(entries) == figures | TABLES


def test_the_page_is_the_one_that_the_script_writes():
    written = (ROOT / "docs" / "atlas.md").read_text(encoding="utf-8")
    assert written == atlas.page(), "`make pages` writes it"


def test_every_claim_has_a_picture_numbers_and_commands(entries):
    for name, entry in entries.items():
        assert entry["verdict"] in atlas.VERDICTS, name
        if entry["verdict"] != "no claim":
            assert (ROOT / "docs" / atlas.picture(entry)).is_file(), name
            assert entry["commands"], name
            assert entry["results"], name


def test_verdicts_are_in_the_words_of_the_result_pages(entries):
    for name, entry in entries.items():
        if entry["verdict"] != "no claim":
            section = atlas.section(entry["page"])
            assert re.search(WORDS[entry["verdict"]], section, re.IGNORECASE), name


def test_numbers_are_on_the_result_pages(entries):
    """As they are written there."""
    for name, entry in entries.items():
        shown = set(NUMBER.findall(atlas.filled("; ".join(paths(entry)))))
        text = (ROOT / "docs" / entry["page"].partition("#")[0]).read_text(encoding="utf-8")
        assert shown <= set(NUMBER.findall(text)), name


def paths(entry):
    return re.findall(r"\{[^}]*\}", entry["shows"])


def test_a_missing_section_or_command_is_an_error():
    page = "results/chapter3.md#figure-3-1-the-deterministic-variant"
    assert "fig_3_1_cartpole" in atlas.command(page, "fig_3_1_cartpole")
    with pytest.raises(ValueError, match="no command"):
        atlas.command(page, "fig_9_9")
    with pytest.raises(ValueError, match="no section"):
        atlas.section("results/chapter3.md#figure-9-9")
