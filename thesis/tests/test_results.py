"""The pages of results have the numbers of their JSON; docs/atlas.md has every figure and table."""

from pathlib import Path

import pytest

from scripts.pages import __main__ as command
from scripts.pages import atlas, machines, values

ROOT = Path(__file__).resolve().parents[2]
LAST = {3: 6, 4: 2, 5: 7, 6: 10, 7: 7}  # chapter of the thesis -> its last figure
TABLES = {"Table 6.1", "Table B.1", "Table C.1"}


@pytest.fixture(scope="module")
def entries():
    """Figure or table -> its entry."""
    return {name: entry for chapter in atlas.entries().values() for name, entry in chapter.items()}


PAGES = [*(path for path in command.pages() if path.parent == values.RESULTS), command.ATLAS]


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_a_page_is_the_one_that_the_command_writes(page):
    assert command.text(page) == page.read_text(encoding="utf-8"), "`make pages` writes it"


def test_every_result_has_a_machine():
    for path in values.RESULTS.glob("*.json"):
        assert machines.machine(path.stem)


def test_every_file_of_a_machine_exists():
    """A comma in brackets without quotes makes several names of one in YAML."""
    files = [file.split(" (")[0] for entry in machines.entries() for file in entry["files"]]
    assert not [file for file in files if not list(values.RESULTS.glob(f"{file}.json"))]


def test_every_figure_and_table_of_the_thesis_has_an_entry(entries):
    figures = {f"Figure {c}-{i + 1}" for c, last in LAST.items() for i in range(last)}
    assert set(entries) == figures | TABLES


def test_every_claim_has_a_picture_and_numbers(entries):
    for name, entry in entries.items():
        assert entry["verdict"] in atlas.VERDICTS, name
        assert ("brief" in entry) != (entry["verdict"] == "holds"), name
        if entry["verdict"] != "nothing to test":
            assert (ROOT / "docs" / atlas.picture(entry)).is_file(), name
            assert entry["results"], name
