"""Every number on README.md and docs/results is that of the JSON beside it; commands compose.

python tests/test_pages.py    writes onto the pages what the JSON files hold now
"""

import pytest
from pages import chapter3, chapter6, cited, results, robots, speed
from pages.cited import ROOT

PAGES = [results, chapter3, chapter6, robots, speed]


def text(page):
    return (ROOT / page.PAGE).read_text(encoding="utf-8")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.PAGE)
def test_cited_numbers_are_those_of_the_files(page):
    found = cited.citations(text(page), page.CITED)
    assert found
    wrong = [f"{one.shown} should be {one.right}" for one in found if one.shown != one.right]
    assert not wrong


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.PAGE)
def test_no_number_is_without_a_source(page):
    assert not cited.uncited(text(page), page.CITED, page.PLAIN)


def write(page):
    """The page with each number as its file has it."""
    old = new = text(page)
    for one in reversed(cited.citations(old, page.CITED)):
        new = new[: one.start] + one.right + new[one.end :]
    (ROOT / page.PAGE).write_text(new, encoding="utf-8")


if __name__ == "__main__":
    for page in PAGES:
        write(page)
