"""The sources of the documentation site: every method has a section, the core alone plans."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from hybrid_rl.list import FIRST
from hybrid_rl.settings.groups import options

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
SECTIONS = {  # of the thesis: section -> its subsections
    "2.1": 2, "2.2": 3, "2.3": 1, "3.1": 2, "3.2": 2, "3.3": 0, "4.1": 1, "4.2": 1, "4.3": 0,
    "5.1": 0, "5.2": 0, "5.3": 1, "5.4": 0, "5.5": 0, "6.1": 1, "6.2": 5, "6.3": 4, "6.4": 0,
    "7.1": 1, "7.2": 1, "7.3": 3, "7.4": 1, "7.5": 2, "7.6": 0,
}  # fmt: skip
LAST = {"2": 11, "3": 8, "4": 6, "5": 4, "6": 28, "7": 13}  # chapter of the thesis -> its last eq.


def test_every_method_has_one_section():
    """From which scripts/docs.py makes the method's page."""
    page = (ROOT / "docs" / "methods.md").read_text(encoding="utf-8")
    lines = re.findall(r"^### (.+)$", page, re.MULTILINE)
    assert sorted(name for line in lines for name in line.split(", ")) == options("algo")


def test_cited_sections_and_equations_of_the_thesis_exist():
    """Next to the word `thesis` in sources, and everywhere on the page of methods."""
    pages = [ROOT / "docs" / "methods.md"]
    for folder in ("hybrid_rl", "envs", "conf", "thesis/conf", "thesis/studies"):
        pages += [p for p in (ROOT / folder).rglob("*.*") if p.suffix in (".py", ".yaml")]
    wrong, count = [], 0
    for page in pages:
        text = " ".join(page.read_text(encoding="utf-8").split())
        near = [text] if page.suffix == ".md" else re.findall(r"thesis.{60}", text)
        for line in near:
            sections = re.findall(r"sections? (\d\.\d)(?:\.(\d))?", line)
            equations = re.findall(r"eq\. \(?(\d)\.(\d+)", line)
            wrong += [(page.name, s) for s in sections if int(s[1] or 0) > SECTIONS.get(s[0], -1)]
            wrong += [(page.name, e) for e in equations if int(e[1]) > LAST.get(e[0], 0)]
            count += len(sections) + len(equations)
    assert not wrong
    assert count > 50


def test_the_same_nine_methods_come_first_in_the_listing_and_the_readme():
    table = (ROOT / "README.md").read_text(encoding="utf-8").partition("| `algo=` |")[2]
    rows = table.split("\n\n")[0].splitlines()[2:]
    names = [found for row in rows for found in re.findall(r"`(\w+)`", row.split("|")[1])]
    assert names[: len(FIRST)] == list(FIRST)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_kept_without_outputs_and_name_what_exists(path):
    """`make docs` runs them."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert all(not cell["outputs"] and cell["execution_count"] is None for cell in code)
    text = "".join("".join(cell["source"]) + "\n" for cell in cells)
    assert {*re.findall(r"experiment=([\w/]+)", text)} <= {*options("experiment")}
    for link in re.findall(r"\]\(([^)#]+\.md)", text):
        assert (path.parent / link).is_file(), link


def program(path):
    """The code of a notebook as plain Python, with runs of 400 decisions at most.

    %%writefile writes; other magics are left out.
    """
    lines = []
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] != "code":
            continue
        if text.startswith("%%writefile "):
            name, body = text.removeprefix("%%writefile ").split("\n", 1)
            lines.append(f"Path({name!r}).write_text({body!r})")
        else:
            lines += [line for line in text.splitlines() if not line.startswith("%")]
    code = "\n".join(lines)
    long = re.compile(r"(total_steps[=:] ?)(\d+)")
    return long.sub(lambda found: f"{found[1]}{min(int(found[2]), 400)}", code)


@pytest.mark.turns(len(NOTEBOOKS))
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path):
    """One for each commit; `make docs` runs all of them in Jupyter."""
    code = program(path)
    assert "train" in code or "figure(" in code
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
