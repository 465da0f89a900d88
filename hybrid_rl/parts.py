"""What a file may build: parts of this package, and those in the user's own folders.

A configuration or a description names a part by `_target_: MODULE.CLASS`, next to its fields. It
may come from anybody, so every name is judged before anything is imported. A part is

    a dataclass of hybrid_rl.ROOM, or
    a class that a module of the user defines, which Python finds in a folder on PYTHONPATH or in
    the current one, not among installed packages; and not in the run that names it.
"""

import ast
import os
import sys
import sysconfig
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from importlib import import_module
from importlib.machinery import PathFinder
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hybrid_rl.errors import FAULTS, GYMNASIUM, UsageError, printable, relative, user_line
from hybrid_rl.fields import FieldError, choices, method_of

TARGET, OURS = "_target_", "hybrid_rl."
PACKAGE = Path(__file__).parent
PART_FOLDERS = (  # folders of hybrid_rl that hold parts
    *("beliefs", "constraints", "controllers", "core", "critics", "data", "envs", "features"),
    *("learners", "models", "objectives", "policies", "proposals", "rewards", "schedules"),
    "targets",
    "training",
)
NONE = "is no part of hybrid_rl"
OTHER = f"{NONE}; put its folder on PYTHONPATH if it is yours"
DEEPEST, SHOWN = 40, 60  # names in a key; characters of a name in a message


def targets(node: Any, where: str = "") -> Iterator[tuple[str, Any]]:
    """Every `_target_` in a tree of dicts and lists, with its full key; outer ones first.

    Raises:
        UsageError: for a tree that is nested too deeply.
    """
    if where.count(".") > DEEPEST:
        raise UsageError(f"{printable(where)[:SHOWN]}...: is nested too deeply")
    if isinstance(node, dict) and TARGET in node:
        yield f"{where}{TARGET}", node[TARGET]
    for name, value in node.items() if isinstance(node, dict) else enumerate(node):
        if isinstance(value, (dict, list)):
            yield from targets(value, f"{where}{name}.")


def asked(node: Any, of: str = "${env}") -> set[str]:
    """The methods that this package's parts in a tree need of `of`, which their fields refer to."""
    found = set()
    for value in node.values() if isinstance(node, dict) else node:
        found |= asked(value, of) if isinstance(value, (dict, list)) else set()
    if isinstance(node, dict) and str(node.get(TARGET)).startswith(OURS):
        for field in fields(part_class(node[TARGET])):
            if node.get(field.name) == of:
                found |= {*map(method_of, choices(field.type))}
    return found - {""}


def check(node: Any, near: Path | None = None) -> None:
    """Judge every name in a tree of dicts and lists; only modules of this package are imported.

    near: the run folder or the file that the tree comes from; None: from the user.

    Raises:
        UsageError: for a name that is no part's; the line begins with KEY=NAME; or too deep a tree.
    """
    for key, target in targets(node):
        try:
            part_class(target) if str(target).startswith(OURS) else _source(target, near)
        except ValueError as error:
            raise UsageError(f"{printable(key)}={printable(target)[:SHOWN]}: {error}") from error


def part_class(target: Any, near: Path | None = None) -> Any:
    """The class of the part that a `_target_` names; near: as for `check`.

    Raises:
        ValueError: if it names none, or its module cannot be imported.
    """
    source = _source(target, near)
    module, _, name = str(target).rpartition(".")
    try:
        home = import_module(module)
        found = getattr(home, name)
    except FAULTS as error:  # whatever the user's module does
        raise ValueError(user_line(error) or f"cannot be imported ({error})") from error
    if not isinstance(found, type) or Path(str(home.__file__)).resolve() != source:
        raise ValueError(OTHER)
    if module.startswith(OURS) and not (is_dataclass(found) and found.__module__ == module):
        raise ValueError(NONE)
    if found.__module__.partition(".")[0] != module.partition(".")[0]:
        raise ValueError(OTHER)
    return found


def build(node: Any, near: Path | None = None, where: str = "") -> Any:
    """The part that `node` describes, with the parts in it; what is no part stays as it is.

    where: key of `node` in its configuration, which messages about a field begin with.

    Raises:
        ValueError: for a name that is no part's, or fields that a part does not have or accept.
    """
    if isinstance(node, (dict, list)):
        check(node, near)
    return _made(node, near, where)


def _made(node: Any, near: Path | None, where: str) -> Any:
    if isinstance(node, list):
        return [_made(each, near, where) for each in node]
    if not isinstance(node, dict):
        return node
    fields = {k: _made(v, near, where and f"{where}.{k}") for k, v in node.items() if k != TARGET}
    if TARGET not in node:
        return fields
    kind = part_class(node[TARGET], near)
    try:
        return kind(**fields)
    except FieldError as error:
        raise (error.at(where) if where else error) from None
    except ValueError:
        raise
    except FAULTS as error:  # such as a field that it does not have
        raise ValueError(user_line(error) or str(error)) from error


def _source(target: Any, near: Path | None) -> Path:
    """The file of the module of a `_target_`; ValueError if it names no part."""
    *names, name = str(target).split(".")
    if not names and ":" in name:  # as in env.make
        raise ValueError(f"write {name.replace(':', '.')}")
    if not (names and all(each.isidentifier() for each in (*names, name))):
        raise ValueError(OTHER)
    if names[0] == "hybrid_rl":
        return _ours(names[1:])
    source = _theirs(names, near)
    try:
        tree = ast.parse(source.read_bytes(), str(source))
    except SyntaxError as error:
        raise ValueError(user_line(error)) from error
    nodes = list(ast.walk(tree))
    known = {node.name for node in nodes if isinstance(node, ast.ClassDef)}
    for node in nodes:
        if isinstance(node, ast.ImportFrom):
            known |= {alias.asname or alias.name for alias in node.names}
    if name not in known:
        raise ValueError(f"{relative(source)} has no class {name}")
    return source


def _ours(names: list[str]) -> Path:
    """The file of the module hybrid_rl.NAMES, which must lie in one of PART_FOLDERS."""
    if len(names) < 2 or names[0] not in PART_FOLDERS:
        raise ValueError(NONE)
    for parent in (PACKAGE, PACKAGE.parent) if names[0] == "envs" else (PACKAGE,):
        path = parent.joinpath(*names)
        for source in (path.with_suffix(".py"), path / "__init__.py"):  # a part may be a folder
            if source.is_file():
                return source.resolve()
    raise ValueError(NONE)


def _theirs(names: list[str], near: Path | None) -> Path:
    """The file of a module of the user; ValueError if there is none."""
    if names[0] == "gymnasium":
        raise ValueError(f"makes {GYMNASIUM}")
    try:
        spec = find_spec(names[0])  # of the first name alone, so that nothing is imported
    except (ImportError, ValueError, AttributeError):
        spec = None
    if spec is None:
        raise ValueError(OTHER)
    tops = [Path(top).absolute() for top in spec.submodule_search_locations or [spec.origin or ""]]
    if not all(_of_user(top.parent) for top in tops):
        raise ValueError(OTHER)
    if near is not None and any(_together(top, near.resolve()) for top in tops):
        raise ValueError(f"is code beside what names it; move {near} out of {tops[0]}")
    for number in range(2, len(names) + 1):
        below = spec.submodule_search_locations
        spec = below and PathFinder.find_spec(".".join(names[:number]), list(below))
        if spec is None:
            raise ValueError(OTHER)
    source = Path(spec.origin or "")
    if source.suffix != ".py" or not source.is_file():
        raise ValueError(OTHER)
    return source.resolve()


def _together(top: Path, near: Path) -> bool:
    """Whether one of the two paths lies in the other."""
    top = top.parent.resolve() / top.name
    return top == near or top in near.parents or near in top.parents


def _of_user(folder: Path) -> bool:
    """Whether a folder is on Python's path, and not of Python or of installed packages."""
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
