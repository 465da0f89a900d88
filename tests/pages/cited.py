"""The numbers of a page, compared with values recomputed from the JSON next to it.

A page's module lists `CITED`: sentences (`Text`) and tables (`Table`) with their values, and
`PLAIN`: phrases whose numbers are not our measurements (settings, sizes, others' results) or have
no file. A value is rounded to the decimals that the page shows.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
NUMBER = r"(?<![\w.])(?:(?<!\d )-)?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?![\w]|\.\d)"
# Digits that are not results: code, links, references, comments.
IGNORED = re.compile(
    r"```.*?```|!\[[^\]]*\]|^    .*?$|`[^`]*`|\]\([^)]*\)|<!--.*?-->|^#.*?$"
    r"|(?i:\b(?:figures?|tables?|chapter|sections?|algorithm|theorem|erratum|eq\.)\s+"
    r"\(?[A-Z]?\d[\d.\-]*\)?(?:(?:,| and| to)\s+\(?[A-Z]?\d[\d.\-]*\)?)*)"
    r"|\(\d\.\d+\)",
    re.MULTILINE | re.DOTALL,
)


class Citation(NamedTuple):
    """A number on a page: its position, its text, and the text that its value gives."""

    start: int
    end: int
    shown: str
    right: str


@dataclass(frozen=True)
class Text:
    """A phrase that occurs once on the page; each # is a number with its value."""

    phrase: str
    values: Sequence[float]

    def citations(self, page: str) -> list[Citation]:
        match = only_match(re.compile(_pattern(self.phrase)), page, self.phrase)
        spans = [match.span(i + 1) for i in range(len(self.values))]
        return [_citation(page, *span, x) for span, x in zip(spans, self.values, strict=True)]


@dataclass(frozen=True)
class Table:
    """The table with this header; `values(label, column)` are those of a cell, in order.

    A cell may show only the first of its values (no band), or none. Label and column are text
    without marks: the label is the row's first cell, or the last one above it that is not empty,
    and the second cell if that column has no header.
    """

    header: str
    values: Callable[[str, str], Sequence[float]]
    after: str = ""  # a phrase before this table, if several tables have this header
    plain: tuple[str, ...] = ()  # columns that are not our measurements

    def citations(self, page: str) -> list[Citation]:
        result, first = [], ""
        for cells in self.rows(page):
            first = _bare(cells[0][0]) or first
            label = f"{first}, {_bare(cells[1][0])}" if self._labels == 2 else first
            for column, cell in zip(self._columns, cells, strict=True):
                tokens = list(re.finditer(NUMBER, _without_marks(cell[0])))
                if not tokens or column in self.plain or cell in cells[: self._labels]:
                    continue
                values = self.values(label, column)
                assert len(tokens) <= len(values), f"{label}, {column}: {cell[0]}"
                for token, value in zip(tokens, values, strict=False):
                    span = cell.start() + token.start(), cell.start() + token.end()
                    result.append(_citation(page, *span, value))
        return result

    def labels(self, page: str) -> list[tuple[int, int]]:
        """Spans of the header, of each row's label and of the plain columns: settings."""
        start = self._match(page).start()
        spans = [(start, page.index("\n", start))]
        for cells in self.rows(page):
            spans += [cell.span() for cell in cells[: self._labels]]
            named = zip(self._columns, cells, strict=True)
            spans += [cell.span() for column, cell in named if column in self.plain]
        return spans

    @property
    def _columns(self) -> list[str]:
        return [_bare(cell) for cell in self.header.split("|")]

    @property
    def _labels(self) -> int:
        return 2 if self._columns[1] == "" else 1

    def rows(self, page: str) -> list[list[re.Match]]:
        """The cells of each row, as matches on the page."""
        lines = re.compile(r"^\|.*\|$", re.MULTILINE)
        body = self._match(page)
        cell = re.compile(r"(?<=\|)[^|\n]+")
        return [
            list(cell.finditer(page, *line.span())) for line in lines.finditer(page, *body.span(1))
        ]

    def _match(self, page: str) -> re.Match:
        header = r"\s*\|\s*".join(re.escape(cell.strip()) for cell in self.header.split("|"))
        whole = re.compile(rf"\|\s*{header}\s*\|\n\|[-| ]+\|\n((?:\|.*\n?)+)")
        if not self.after:
            return only_match(whole, page, self.header)
        match = whole.search(page, page.index(self.after))
        assert match, f"not after {self.after!r}: {self.header}"
        return match


def citations(page: str, cited: Sequence[Text | Table]) -> list[Citation]:
    """All citations of a page, in order."""
    return sorted({number for one in cited for number in one.citations(page)})


def uncited(page: str, cited: Sequence[Text | Table], plain: Sequence[str]) -> list[str]:
    """Numbers of a page's text that are neither cited nor in a phrase of `plain`, in context.

    Raises:
        AssertionError: if a phrase of `plain` is not on the page.
    """
    covered = np.zeros(len(page), bool)
    spans = [match.span() for match in IGNORED.finditer(page)]
    spans += [(one.start, one.end) for one in citations(page, cited)]
    spans += [span for one in cited if isinstance(one, Table) for span in one.labels(page)]
    for phrase in plain:
        matches = list(re.finditer(_pattern(phrase), page))
        assert matches, f"not on the page: {phrase}"
        spans += [match.span() for match in matches]
    for start, end in spans:
        covered[start:end] = True
    return [
        f"{match[0]}: ... {' '.join(page[max(0, match.start() - 60) : match.end() + 40].split())}"
        for match in re.finditer(NUMBER, page)
        if not covered[match.start() : match.end()].all()
    ]


def only_match(pattern: re.Pattern, page: str, name: str) -> re.Match:
    matches = list(pattern.finditer(page))
    assert len(matches) == 1, f"{len(matches)} times on the page: {name}"
    return matches[0]


def _pattern(phrase: str) -> str:
    """The phrase as a pattern: any white space for a space, a number that may be bold for #."""
    parts = [r"\s+".join(map(re.escape, part.split(" "))) for part in phrase.split("#")]
    return rf"\*{{0,2}}({NUMBER})\*{{0,2}}".join(parts)


def _bare(cell: str) -> str:
    return re.sub(r"[*`]", "", cell).strip()


def _without_marks(cell: str) -> str:
    """Of the same length, so that positions stay."""
    return re.sub(r"\*|`[^`]*`", lambda m: " " * len(m[0]), cell)


def _citation(page: str, start: int, end: int, value: float) -> Citation:
    shown = page[start:end]
    decimals = len(shown.partition(".")[2])
    comma = "," if "," in shown or len(shown.lstrip("-").partition(".")[0]) < 4 else ""
    right = f"{value:{comma}.{decimals}f}"
    return Citation(start, end, shown, right.lstrip("-") if float(value) == 0 else _zero(right))


def _zero(text: str) -> str:
    """-0 is printed as 0."""
    return text.lstrip("-") if not re.search("[1-9]", text) else text
