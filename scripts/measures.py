"""Sizes of this project, and the budgets that they keep.

    python -m scripts.measures          prints the table
    python -m scripts.measures --lower  also lowers every budget to what stands

The budgets are in tests/budgets.json; tests/test_budget.py fails where a measure is above its
budget. A budget is only ever lowered: a line that is added is paid for by one that goes. It may go
in another room: `--lower` moves a room's budget to what stands, as long as the sum is kept.
"""

import ast
import json
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import TypeVar

Node = TypeVar("Node", bound=ast.AST)
TOP = Path(__file__).parents[1]
BUDGETS = TOP / "tests" / "budgets.json"
SUMS = ("lines of hybrid_rl without tools, and envs", "lines of tests")
TOOLS = "hybrid_rl/tools/"  # stands on the public API, as a project of a user's would
HOMES = {"hybrid_rl.envs": "envs", "hybrid_rl.thesis": "thesis"}  # in a checkout


@cache
def sources(*folders: str) -> dict[str, str]:
    """Path -> text of all Python files in these folders."""
    files = [path for folder in folders for path in sorted((TOP / folder).rglob("*.py"))]
    return {str(path.relative_to(TOP)): path.read_text(encoding="utf-8") for path in files}


def library() -> dict[str, str]:
    """The files of hybrid_rl and envs, without the tools."""
    files = sources("hybrid_rl", "envs").items()
    return {path: text for path, text in files if not path.startswith(TOOLS)}


def lines(files: dict[str, str]) -> int:
    """Lines of these files."""
    return sum(text.count("\n") for text in files.values())


@cache
def tree_of(text: str) -> ast.Module:
    """The syntax tree of a file."""
    return ast.parse(text)


def nodes(files: dict[str, str], kind: type[Node]) -> Iterator[Node]:
    """Every node of this kind in the syntax trees of these files."""
    for text in files.values():
        yield from (node for node in ast.walk(tree_of(text)) if isinstance(node, kind))


def named(node: ast.AST) -> str:
    """The last name of an expression: Protocol of typing.Protocol[T]."""
    if isinstance(node, ast.Subscript):
        return named(node.value)
    return getattr(node, "attr", None) or getattr(node, "id", "")


def room(path: str) -> str:
    """The room of a file: its folder below hybrid_rl, envs, or the file itself at the root."""
    first, _, rest = path.partition("/")
    return f"{first}/{rest.split('/')[0]}" if first == "hybrid_rl" else first


def imports(path: str, text: str, known: dict[str, str]) -> set[str]:
    """The files that a file imports, also for its types or when it is called.

    known: module -> file.
    """
    found = set()
    for node in ast.walk(tree_of(text)):
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            found |= {known.get(name) or known.get(node.module) for name in names}
        elif isinstance(node, ast.Import):
            found |= {known.get(alias.name) for alias in node.names}
    return {each for each in found if each} - {path}


def arrows() -> dict[str, set[str]]:
    """File -> the files of the project that it imports."""
    files, known = sources("hybrid_rl", "envs"), {}
    for path in files:
        module = path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
        known[module if module.startswith("hybrid_rl") else f"hybrid_rl.{module}"] = path
    return {path: imports(path, text, known) for path, text in files.items()}


def closure(start: str, graph: dict[str, set[str]]) -> set[str]:
    """What can be reached from `start`, with it."""
    found, left = set(), [start]
    while left:
        here = left.pop()
        if here not in found:
            found.add(here)
            left += graph[here]
    return found


def circles(graph: dict[str, set[str]]) -> list[frozenset[str]]:
    """Groups of nodes that reach one another."""
    reach = {node: closure(node, graph) for node in graph}
    groups = {frozenset(o for o in reach[node] if node in reach[o]) for node in graph}
    return [group for group in groups if len(group) > 1]


def floors(graph: dict[str, set[str]]) -> int:
    """Rooms on the longest way down; rooms of a circle are one."""
    groups = {node: frozenset({node}) for node in graph}
    groups |= {node: group for group in circles(graph) for node in group}

    @cache
    def depth(group: frozenset[str]) -> int:
        below = {groups[other] for node in group for other in graph[node]} - {group}
        return 1 + max(map(depth, below), default=0)

    return max(map(depth, groups.values()))


def tested() -> float:
    """Share of modules with a test file of their name [%]."""
    tests = {Path(path).name for path in sources("tests", "thesis/tests")}
    modules = [path for path in library() if not path.endswith(("__init__.py", "__main__.py"))]
    return 100 * sum(f"test_{Path(path).name}" in tests for path in modules) / len(modules)


def words() -> int:
    """Words that a reader sees of README and of the pages: without comments."""
    pages = [TOP / "README.md", *sorted((TOP / "docs").rglob("*.md"))]
    texts = (page.read_text(encoding="utf-8") for page in pages)
    return sum(len(re.sub("<!--.*?-->", " ", text, flags=re.DOTALL).split()) for text in texts)


def measures() -> dict[str, float]:
    """Name -> what stands."""
    files, graph = library(), arrows()
    rooms: dict[str, set[str]] = {}
    for path, others in graph.items():
        rooms.setdefault(room(path), set()).update(map(room, others))
    rooms = {name: others - {name} for name, others in rooms.items()}
    trained = closure("hybrid_rl/train.py", graph)
    raised = sum(node.exc is not None for node in nodes(files, ast.Raise))
    bases = [b for kind in nodes(files, ast.ClassDef) for b in kind.bases]
    calls = [node.func for node in nodes(files, ast.Call)]
    loose = [n for n in nodes(files, ast.AnnAssign) if n.value and named(n.annotation) == "Any"]
    found = {
        "lines of hybrid_rl without tools, and envs": lines(files),
        "lines of tests": lines(sources("tests", "thesis/tests")),
        "raise in the library": raised,
        "protocols": [named(base) for base in bases].count("Protocol"),
        "hasattr": [named(call) for call in calls].count("hasattr"),
        "values of type Any": len(loose),
        "modules at the root": len([p for p in files if p.count("/") == 1 and p[0] == "h"]),
        "floors": floors(rooms),
        "circles of files": len(circles(graph)),
        "files that train imports": len(trained),
        "lines that train imports": sum(
            sources("hybrid_rl", "envs")[p].count("\n") for p in trained
        ),
        "YAML files": len([*(TOP / "conf").rglob("*.yaml")]),
        "words of README and docs": words(),
        "modules without a test file of their name [%]": round(100 - tested(), 1),
    }
    for name in sorted({room(path) for path in files if path.count("/") > 1} | {"envs"}):
        found[f"lines of {name}"] = lines({p: t for p, t in files.items() if room(p) == name})
    return found


def main() -> None:
    """The command."""
    budgets, stands = json.loads(BUDGETS.read_text()) if BUDGETS.exists() else {}, measures()
    for name, value in stands.items():
        print(f"{name:46} {value:>9,}   budget {budgets.get(name, '-'):>9}")
    rate = 1000 * stands["raise in the library"] / lines(library())
    print(f"{'raise a thousand lines':46} {rate:9.1f}")
    if "--lower" in sys.argv:
        kept = {name: min(value, budgets.get(name, value)) for name, value in stands.items()}
        rooms = {name for name in stands if name.startswith("lines of ") and name not in SUMS}
        BUDGETS.write_text(json.dumps(kept | {n: stands[n] for n in rooms}, indent=2) + "\n")


if __name__ == "__main__":
    main()
