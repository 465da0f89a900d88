"""Write the numbers of the pages from the JSON of docs/results, and the atlas.

    make pages

marks.py describes the marks between which numbers stand on a page, values.py how a mark names one.
"""

import re
from pathlib import Path

from scripts.pages import atlas, marks

ROOT = Path(__file__).resolve().parents[2]
ATLAS = ROOT / "docs" / "atlas.md"
MARK = rf"<!-- (= |table |{'|'.join(marks.WRITERS)})"


def pages() -> list[Path]:
    """The pages with marks."""
    paths = sorted([ROOT / "README.md", *ROOT.glob("docs/**/*.md"), *ROOT.glob("paper/*.md")])
    return [path for path in paths if re.search(MARK, path.read_text(encoding="utf-8"))]


def text(path: Path) -> str:
    """The page with the numbers of the JSON."""
    if path == ATLAS:
        return atlas.page()
    try:
        return marks.written(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ValueError(f"{path.relative_to(ROOT)}: {error}") from error


def main() -> None:
    """Write what differs, the atlas last, as it quotes the others."""
    for path in [*pages(), ATLAS]:
        if path.read_text(encoding="utf-8") != text(path):
            path.write_text(text(path), encoding="utf-8")
            print(path.relative_to(ROOT))


if __name__ == "__main__":
    main()
