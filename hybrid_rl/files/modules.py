"""The user's modules and what they define, found without importing anything."""

import ast
import os
import re
import sys
import sysconfig
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from importlib import metadata
from importlib.machinery import PathFinder
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hybrid_rl.errors import GYMNASIUM, user_line

PACKAGE = Path(__file__).parents[1]
CHECKOUT = ("envs", "hydra_plugins", "scripts", "tests", "thesis")  # modules beside PACKAGE
NONE = "is no part of hybrid_rl"
OTHER = f"{NONE}; put its folder on PYTHONPATH if it is yours"


def theirs(names: list[str], near: Path | None) -> Path:
    """The file of a module of the user; ValueError if there is none."""
    if names[0] == "gymnasium":
        raise ValueError(f"makes {GYMNASIUM}")
    spec = None
    with suppress(ImportError, ValueError, AttributeError):
        spec = find_spec(names[0])  # of the first name alone, so that nothing is imported
    tops = _tops(spec) if spec else []
    ours = PACKAGE.parent if names[0] in CHECKOUT else None
    if not tops or any(top.parent == ours or not _of_user(top.parent) for top in tops):
        raise ValueError(OTHER)
    if near is not None and any(_together(top, near.resolve()) for top in tops):
        raise ValueError(f"is code beside what names it; move {near} out of {tops[0]}")
    return below(names)


def _tops(spec: Any) -> list[Path]:
    """The files or folders of a module that is in no other."""
    return [Path(top).absolute() for top in spec.submodule_search_locations or [spec.origin or ""]]


def below(names: list[str]) -> Path:
    """The file of a module, of whose packages only the search path is used; ValueError if none."""
    spec = find_spec(names[0])
    for number in range(2, len(names) + 1):
        inside = spec and spec.submodule_search_locations
        spec = inside and PathFinder.find_spec(".".join(names[:number]), list(inside))
    source = Path(spec.origin or "" if spec else "")
    if source.suffix != ".py" or not source.is_file():
        raise ValueError(OTHER)
    return source.resolve()


def _together(top: Path, near: Path) -> bool:
    """True if one of the two paths lies in the other."""
    top = top.parent.resolve() / top.name
    return top == near or top in near.parents or near in top.parents


def _of_user(folder: Path) -> bool:
    """True if a folder is on Python's path, and not of Python or of installed packages."""
    folder = folder.resolve()
    if not any(folder == Path(entry or os.curdir).resolve() for entry in sys.path):
        return False
    installed = {"site-packages", "dist-packages"} & {*folder.parts}
    return not installed and not any(own in (folder, *folder.parents) for own in _of_python())


@cache
def _of_python() -> tuple[Path, ...]:
    """The folders of Python itself."""
    names = ("stdlib", "platstdlib", "scripts")
    return tuple(Path(sysconfig.get_path(name)).resolve() for name in names)


def absent(name: str) -> bool:
    """True if Python finds no module `name`."""
    try:
        return find_spec(name) is None
    except (ImportError, ValueError, AttributeError):  # it is there, in an odd way
        return False


def registers(names: list[str]) -> bool:
    """True if a module is an installed package that depends on Gymnasium, and may register ids."""
    try:
        home = metadata.distribution(names[0])
    except (metadata.PackageNotFoundError, ValueError):
        return False
    folder = Path(str(home.locate_file(names[0]))).resolve()
    needs = any(re.match(r"gymnasium\b", each) for each in home.requires or ())
    return needs and len(names) == 1 and folder in map(Path.resolve, _tops(find_spec(names[0])))


def defines(names: list[str], source: Path, name: str, *kinds: type, depth: int = 5) -> bool:
    """True if a module defines `name`, or imports it from one of its package that does."""
    try:
        tree = ast.parse(source.read_bytes(), str(source))
    except SyntaxError as error:
        raise ValueError(user_line(error)) from error
    package = names if source.name == "__init__.py" else names[:-1]
    found = []
    for node in _statements(tree.body):
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and node.name == name:
            found.append(isinstance(node, kinds))
        for alias in node.names if isinstance(node, ast.Import | ast.ImportFrom) else ():
            if (alias.asname or alias.name) not in (name, "*"):
                continue
            above = package[: len(package) + 1 - node.level] if getattr(node, "level", 0) else []
            home = [*above, *filter(None, (getattr(node, "module", "") or "").split("."))]
            own = home[:1] == names[:1] and depth > 0
            other = name if alias.name == "*" else alias.name
            known = own and defines(home, below(home), other, *kinds, depth=depth - 1)
            found += [known] if known or alias.name != "*" else []
    return bool(found) and all(found)


def _statements(nodes: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """The statements of a module, without those of functions and classes."""
    for node in nodes:
        yield node
        if isinstance(node, ast.If | ast.Try | ast.With | ast.ExceptHandler):
            yield from _statements(ast.iter_child_nodes(node))
