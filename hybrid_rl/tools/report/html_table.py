"""Tables of HTML: text is escaped, and columns of numbers are aligned to the right."""

import html
import re
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

NUMBER = re.compile(r"(-?[\d,.]+%?( \[.*\])?)?")  # with its band


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A table; columns whose values are all numbers are aligned to the right."""
    rows = [[_text(value) for value in row] for row in rows]
    numeric = [all(NUMBER.fullmatch(row[i]) for row in rows) for i in range(len(head))]

    def line(tag: str, cells: Sequence[str]) -> str:
        marks = [' class="number"' if number else "" for number in numeric]
        inside = (f"<{tag}{m}>{html.escape(c)}</{tag}>" for m, c in zip(marks, cells, strict=True))
        return f"<tr>{''.join(inside)}</tr>"

    body = "\n".join(line("td", row) for row in rows)
    return f'<div class="scroll"><table>\n{line("th", head)}\n{body}\n</table></div>\n'


def _text(value: Any) -> str:
    match value:
        case None:
            return ""
        case float() | np.floating():
            return f"{value:,.4g}" if abs(value) < 1000 else f"{value:,.0f}"
        case int():
            return f"{value:,}"
        case _:
            return str(value)
