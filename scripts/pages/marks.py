"""The marks of a page, between which its numbers are written from the JSON of docs/results.

In a sentence, around a text with one or more numbers (`values.py` has the expressions):

    <!-- = band("hybrid_hopper/sac@50000") -->366 [313, 456]<!-- / -->

Before a table its name, <!-- table PAGE/SECTION -->; docs/tables.yaml has what its cells hold.
Everything but `cells` may be missing:

    PAGE/SECTION:
      rows: {half-cheetah: hybrid_halfcheetah, hopper: hybrid_hopper}
      columns: {with its planner: full, alone: policy}
      cells: band("{row}/{col}@{x}")
      except: {"hopper, 50,000": {alone: 'iqm("hybrid_first/policy@50000")'}}

A cell's expression is `cells`, or the one that `cells` has for its column; a column without one is
prose. {row} is what `rows` has for the row's label or for its longest beginning, else the label;
{col} is the same of the header; {label} and {head} are label and header, {x} and {y} their last
numbers. A row without a label has the one above it, and the second column is part of the label if
it has no header.

Before a table that is written whole: <!-- leaves --> for which_method.yaml, and
<!-- community --> for the files of the folder community.

A text or a cell may show the first of the expression's numbers only. They are written with the
decimals that stand there.
"""

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from scripts.pages import community, leaves
from scripts.pages.values import evaluated

TABLES = Path(__file__).resolve().parents[2] / "docs" / "tables.yaml"
NUMBER = re.compile(r"(?<![\w.])(?:(?<!\d )-)?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?![\w]|\.\d)")
INLINE = re.compile(r"(<!-- = )(.+?)( -->)(.*?)(<!-- / -->)", re.DOTALL)
TABLE = re.compile(r"(<!-- table (\S+) -->\n)((?:\|.*\n){3,})")
WRITERS: dict[str, Callable[..., str]] = {  # word of a mark -> the table of the words after it
    "leaves": leaves.table,
    "community": community.table,
}
WHOLE = re.compile(rf"(<!-- ({'|'.join(WRITERS)})(?: (.+))? -->\n)(?:\|.*\n)+")
CELL = re.compile(r"(?<=\|)[^|\n]+")


def written(page: str) -> str:
    """The page with the numbers of its marks."""
    if first := re.search(r"^[ \t]*(?:[*+-]|\d+\.)?[ \t]*<!-- [=/].{,60}", page, re.MULTILINE):
        raise ValueError(
            f"{first[0].strip()}: Markdown ends a line's text if it begins with a mark"
        )
    found = page.count("<!-- = "), page.count("<!-- table")
    if found != (len(INLINE.findall(page)), len(TABLE.findall(page))):
        raise ValueError("a mark without its end, <!-- / -->, or without its table below it")
    page = WHOLE.sub(lambda m: m[1] + WRITERS[m[2]](*filter(None, [m[3]])), page)
    page = INLINE.sub(lambda m: m[1] + m[2] + m[3] + filled(m[4], m[2]) + m[5], page)
    return TABLE.sub(lambda m: m[1] + table(m[3], specification(m[2])), page)


@cache
def tables() -> dict[str, dict[str, Any]]:
    """Name -> what the cells of a table hold."""
    return yaml.safe_load(TABLES.read_text(encoding="utf-8"))


def specification(name: str) -> dict[str, Any]:
    """What the cells of a table hold.

    Raises:
        ValueError: if docs/tables.yaml has no such name.
    """
    if name not in tables():
        raise ValueError(f"docs/tables.yaml has no {name}")
    return tables()[name]


def filled(text: str, expression: str) -> str:
    """The text with its numbers replaced by the first ones of the expression."""
    tokens = list(NUMBER.finditer(re.sub(r"\*|`[^`]*`", lambda m: " " * len(m[0]), text)))
    values = evaluated(expression) if tokens else []
    if len(tokens) > len(values):
        raise ValueError(f"{expression}: {len(values)} numbers for {text.strip()!r}")
    for token, value in reversed(list(zip(tokens, values, strict=False))):
        text = text[: token.start()] + formatted(value, token[0]) + text[token.end() :]
    return text


def formatted(value: float, like: str) -> str:
    """The value with the decimals, and with commas as, of a number; -0 is 0."""
    decimals = len(like.partition(".")[2])
    comma = "," if "," in like or len(like.lstrip("-").partition(".")[0]) < 4 else ""
    text = f"{value:{comma}.{decimals}f}"
    return text if re.search("[1-9]", text) else text.lstrip("-")


def table(text: str, spec: dict[str, Any]) -> str:
    """The table with the numbers of its specification."""
    header, ruler, *rows = text.splitlines(keepends=True)
    columns = [bare(cell) for cell in CELL.findall(header)]
    first, labelled, result = "", set(), [header, ruler]
    for row in rows:
        cells = CELL.findall(row)
        first = bare(cells[0]) or first
        labels = 2 if columns[1] == "" else 1
        label = f"{first}, {bare(cells[1])}" if labels == 2 else first
        labelled.add(label)
        for i in range(labels, len(cells)):
            expression = cell(spec, label, columns[i])
            cells[i] = filled(cells[i], expression) if expression else cells[i]
        result.append("|" + "|".join(cells) + "|\n")
    if unknown := sorted(spec.get("except", {}).keys() - labelled):
        raise ValueError(f"except: no row {', '.join(unknown)}")
    return "".join(result)


def cell(spec: dict[str, Any], label: str, column: str) -> str | None:
    """The expression of a cell, or None."""
    other = spec.get("except", {}).get(label, {})
    expression = spec["cells"]
    if column in other or isinstance(expression, dict):
        expression = other[column] if column in other else expression.get(column)
    row, col = chosen(spec.get("rows", {}), label), chosen(spec.get("columns", {}), column)
    names = {"row": row, "col": col, "label": label, "head": column}
    return expression and expression.format(**names, x=last(label), y=last(column))


def chosen(values: dict[Any, Any], name: str) -> Any:
    """The value of the longest key with which the name begins, else the name."""
    keys = [key for key in values if name.startswith(str(key))]
    return values[max(keys, key=lambda key: len(str(key)))] if keys else name


def last(text: str) -> str:
    """The last number of a text, without commas, or nothing."""
    return (NUMBER.findall(text) or [""])[-1].replace(",", "")


def bare(cell: str) -> str:
    """A cell without its marks."""
    return re.sub(r"[*`]", "", cell).strip()
