"""docs/atlas.md has every figure and table of the thesis, and agrees with the pages of results."""

import importlib.util
import json
import re
from fnmatch import fnmatch
from pathlib import Path

import pytest
from pages.cited import NUMBER

ROOT = Path(__file__).resolve().parents[1]
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
def atlas():
    """scripts/atlas.py."""
    spec = importlib.util.spec_from_file_location("atlas", ROOT / "scripts" / "atlas.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def entries(atlas):
    """Figure or table -> its entry."""
    return {name: entry for chapter in atlas.entries().values() for name, entry in chapter.items()}


def test_every_figure_and_table_of_the_thesis_has_an_entry(entries):
    figures = {f"Figure {c}-{i + 1}" for c, last in LAST.items() for i in range(last)}
    assert set(entries) == figures | TABLES


def test_the_page_is_the_one_that_the_script_writes(atlas):
    written = (ROOT / "docs" / "atlas.md").read_text(encoding="utf-8")
    assert written == atlas.page(), "`python scripts/atlas.py` writes it"


def test_every_claim_has_a_picture_numbers_commands_and_a_machine(atlas, entries):
    (table,) = re.findall(
        r"\| figure \| machine .*?\n\n", (atlas.RESULTS / "README.md").read_text(), re.DOTALL
    )
    rows = [line.split("|")[1:3] for line in table.splitlines()[2:] if line]
    for name, entry in entries.items():
        assert entry["verdict"] in atlas.VERDICTS, name
        if entry["verdict"] == "no claim":
            continue
        assert (ROOT / "docs" / atlas.picture(entry)).is_file(), name
        assert entry["commands"], name
        machines = [m for named, m in rows if stands_for(named, entry["results"][0])]
        machines = machines or [machine for _, machine in rows]
        assert any(entry["machine"] in machine for machine in machines), f"{name}: {machines}"


def stands_for(cell, stem):
    """Whether a cell has the stem's name, or a pattern of it, among its words of code."""
    return any(fnmatch(stem, pattern) for pattern in re.findall(r"`([^`]*)`", cell))


def test_verdicts_are_in_the_words_of_the_result_pages(atlas, entries):
    for name, entry in entries.items():
        if entry["verdict"] != "no claim":
            section = atlas.section(entry["page"])
            assert re.search(WORDS[entry["verdict"]], section, re.IGNORECASE), name


def test_numbers_are_on_the_result_pages(atlas, entries):
    """As they are written there; tests/test_pages.py compares those with the JSON."""
    for name, entry in entries.items():
        shown = set(re.findall(NUMBER, atlas.filled("; ".join(paths(entry)))))
        text = (ROOT / "docs" / entry["page"].partition("#")[0]).read_text(encoding="utf-8")
        assert shown <= set(re.findall(NUMBER, text)), name


def paths(entry):
    return re.findall(r"\{[^}]*\}", entry["shows"])


def test_a_value_is_found_by_its_path(atlas, tmp_path, monkeypatch):
    curve = {
        "label": "a",
        "metric": "eval/test_return",
        "x": [5, 9],
        "iqm": [1, 2],
        "each": [[3, 4], [5, 7]],
    }
    data = {
        "curves": [{"label": "a", "metric": "train/return"}, curve],
        "n": [[4, 1], [5, 3], [6, 8]],
    }
    tmp_path.joinpath("made.json").write_text(json.dumps(data))
    monkeypatch.setattr(atlas, "RESULTS", tmp_path)
    assert atlas.value("made/curves/a, test_return/x=9") == 2
    assert atlas.value("made/curves/a, test_return/mean=9") == 5.5
    assert atlas.value("made/n/*/-1") == 3
    assert atlas.value("made/n/2") == 7
    assert atlas.filled("{made/n/0/0:.2f} of {made/n/2/1}") == "4.00 of 8"
    with pytest.raises(KeyError):
        atlas.value("made/missing")


def test_a_missing_section_or_command_is_an_error(atlas):
    page = "results/chapter3.md#figure-3-1-the-deterministic-variant"
    assert "fig_3_1_cartpole" in atlas.command(page, "fig_3_1_cartpole")
    with pytest.raises(ValueError, match="no command"):
        atlas.command(page, "fig_9_9")
    with pytest.raises(ValueError, match="no section"):
        atlas.section("results/chapter3.md#figure-9-9")
