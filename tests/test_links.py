"""Links on the pages lead to files and headings that exist; external ones have the right form."""

import re
from pathlib import Path

import pytest

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


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
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
