"""Code that a file may name: parts of this package, and what the user's own modules define.

A configuration or a description names a part by `_target_: MODULE.CLASS`, next to its fields, and
what makes an environment by MODULE:NAME, under any key. It may come from anybody, so the whole tree
is judged before anything is imported. A name leads to

    a dataclass of hybrid_rl.ROOM; by MODULE:NAME a class of hybrid_rl.envs or gymnasium.envs, or
    what a module of the user defines, a class or by MODULE:NAME a function, which Python finds in a
    folder on PYTHONPATH or in the current one, not among installed packages; and not in the run
    that names it. MODULE:ID may also be of an installed package that depends on Gymnasium.

MODULE:NAME that the user types, or gives from Python, may be any. `imported` alone imports one.
"""

import ast
import os
import re
import sys
import sysconfig
from collections.abc import Collection, Iterable, Iterator
from dataclasses import is_dataclass
from importlib import import_module, metadata
from importlib.machinery import PathFinder
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hybrid_rl.errors import FAULTS, GYMNASIUM, UsageError, printable, relative, user_line
from hybrid_rl.fields import FieldError, check_all

PACKAGE = Path(__file__).parents[1]
OF_PYTHON = [
    Path(sysconfig.get_path(name)).resolve() for name in ("stdlib", "platstdlib", "scripts")
]
CHECKOUT = ("envs", "hydra_plugins", "scripts", "tests", "thesis")  # modules beside PACKAGE
NONE = "is no part of hybrid_rl"
OTHER = f"{NONE}; put its folder on PYTHONPATH if it is yours"
INSTALLED = f"{NONE}; to use an installed class, subclass it in a module of yours"
TARGET, OURS = "_target_", "hybrid_rl."
NAMED = re.compile(r"([^\W\d][\w.]*):([^\W\d][\w./-]*)")  # MODULE:NAME, MODULE:ID
ANYWHERE = re.compile(rf"(?<![\w.])(?={NAMED.pattern})")  # in a text
PART_FOLDERS = (  # folders of hybrid_rl that hold parts
    *("beliefs", "constraints", "controllers", "core", "critics", "data", "envs", "features"),
    *("learners", "models", "objectives", "policies", "proposals", "rewards", "schedules"),
    "targets",
    "training",
)
DEEPEST, SHOWN = 40, 60  # names in a key; characters of a name in a message


def leaves(node: Any, where: str = "") -> Iterator[tuple[str, Any]]:
    """Every `_target_` and text in a tree of dicts and lists, with its full key; outer first."""
    if where.count(".") > DEEPEST:
        raise UsageError(f"{printable(where)[:SHOWN]}...: is nested too deeply")
    pairs = [*(node.items() if isinstance(node, dict) else enumerate(node))]
    for name, value in pairs:
        if name == TARGET or isinstance(value, str):
            yield f"{where}{name}", value
    for name, value in pairs:
        if isinstance(value, (dict, list)):
            yield from leaves(value, f"{where}{name}.")


def targets(node: Any) -> Iterator[tuple[str, Any]]:
    """Every `_target_` in a tree."""
    return ((key, name) for key, name in leaves(node) if f".{key}".endswith(f".{TARGET}"))


def check(node: Any, near: Path | None = None) -> None:
    """Judge every name in a tree of dicts and lists; only modules of this package are imported.

    near: the run folder or the file that the tree comes from; None: from the user, who may write
    any MODULE:NAME.
    """
    for key, name in leaves(node) if near else targets(node):
        try:
            if not f".{key}".endswith(f".{TARGET}"):
                _judge(name, near)
            else:
                (part_class if str(name).startswith(OURS) else _source)(name, near)
        except ValueError as error:
            raise UsageError(f"{printable(key)}={printable(name)[:SHOWN]}: {error}") from error


def imported(text: str) -> tuple[Any, str]:
    """The module of MODULE:NAME or MODULE:ID, and what follows the colon."""
    if not (found := NAMED.fullmatch(text)):
        raise ValueError("give MODULE:NAME")
    return import_module(found[1]), found[2]


def part_class(target: Any, near: Path | None = None) -> Any:
    """The class of the part that a `_target_` names; near: as for `check`."""
    source = _source(target, near)
    module, _, name = str(target).rpartition(".")
    try:
        home = import_module(module)
        found = getattr(home, name)
    except FAULTS as error:  # whatever the user's module does
        raise ValueError(user_line(error) or f"cannot be imported ({error})") from error
    kept = found.__module__ if isinstance(found, type) else ""  # where the class is written
    sound = bool(kept) and kept.partition(".")[0] == module.partition(".")[0]
    if ours := module.startswith(OURS):
        sound = kept == module and is_dataclass(found)
    if not sound or Path(str(home.__file__)).resolve() != source:
        raise ValueError(NONE if ours else OTHER)
    return found


def build(node: Any, near: Path | None = None, where: str = "") -> Any:
    """The part that `node` describes, with the parts in it; what is no part stays as it is.

    where: key of `node` in its configuration, which messages about a field begin with.
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
        return check_all(kind(**fields))
    except FieldError as error:
        raise (error.at(where) if where else error) from None
    except ValueError:
        raise
    except FAULTS as error:  # such as a field that it does not have
        line = user_line(error) or (f"{where}: {error}" if where else str(error))
        raise ValueError(line) from error


def _source(target: Any, near: Path | None) -> Path:
    """The file of the module of a `_target_`; ValueError if it names no part."""
    *names, name = str(target).split(".")
    if not (names and all(word.isidentifier() for word in (*names, name))):
        as_in_make = not names and ":" in name
        raise ValueError(f"write {name.replace(':', '.')}" if as_in_make else OTHER)
    if names[0] == "hybrid_rl":
        return _ours(names[1:])
    source = theirs(names, near)
    if not defines(names, source, name, ast.ClassDef):
        raise ValueError(f"{relative(source)} has no class {name}")
    return source


def _judge(text: str, near: Path | None) -> None:
    """ValueError for a text of a file with an interpolation, or MODULE:NAME that it may not name.

    A module that Python does not find leads nowhere.
    """
    if "${" in text:
        raise ValueError("is an interpolation; it must be a plain value")
    for module, name in ANYWHERE.findall(text):
        names, kinds = module.split("."), (ast.ClassDef,)
        if names[0] == "hybrid_rl":
            source = _ours(names[1:], ("envs",))
        elif names[:2] == ["gymnasium", "envs"]:
            source = below(names)
        elif _tops(names[0]) is None or (not name.isidentifier() and registers(names)):
            continue
        else:
            source = theirs(names, near)
            kinds = (ast.ClassDef, ast.FunctionDef)
        if name.isidentifier() and not defines(names, source, name, *kinds):
            kind = "class" if len(kinds) == 1 else "class or function"
            raise ValueError(f"{relative(source)} has no {kind} {name}")


def _ours(names: list[str], rooms: Collection[str] = PART_FOLDERS) -> Path:
    """The file of the module hybrid_rl.NAMES, which must lie in one of `rooms`."""
    known = len(names) > 1 and names[0] in rooms
    for parent in (PACKAGE, PACKAGE.parent) if known else ():  # envs/ may stand beside the package
        path = parent.joinpath(*names)
        for source in (path.with_suffix(".py"), path / "__init__.py"):  # a part may be a folder
            if source.is_file() and (parent == PACKAGE or names[0] == "envs"):
                return source.resolve()
    raise ValueError(NONE)


def theirs(names: list[str], near: Path | None) -> Path:
    """The file of a module of the user; ValueError if there is none."""
    if names[0] == "gymnasium":
        raise ValueError(f"makes {GYMNASIUM}")
    tops = _tops(names[0])
    ours = PACKAGE.parent if names[0] in CHECKOUT else None
    if not tops or any(top.parent == ours or not _of_user(top.parent) for top in tops):
        raise ValueError(INSTALLED if tops and ours is None else OTHER)
    if near is not None:
        file, real = near.resolve(), [top.parent.resolve() / top.name for top in tops]
        if any(top == file or top in file.parents or file in top.parents for top in real):
            raise ValueError(f"is code beside what names it; move {near} out of {tops[0]}")
    return below(names)


def _tops(name: str) -> list[Path] | None:
    """The files or folders of a module that is in no other; None: Python finds no such module."""
    try:
        spec = find_spec(name)  # of a first name alone, so that nothing is imported
    except (ImportError, ValueError, AttributeError):  # it is there, in an odd way
        return []
    tops = spec and (spec.submodule_search_locations or [spec.origin or ""])
    return tops and [Path(top).absolute() for top in tops]


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


def _of_user(folder: Path) -> bool:
    """True if a folder is on Python's path, and not of Python or of installed packages."""
    folder = folder.resolve()
    if not any(folder == Path(entry or os.curdir).resolve() for entry in sys.path):
        return False
    installed = {"site-packages", "dist-packages"} & {*folder.parts}
    return not installed and not any(own in (folder, *folder.parents) for own in OF_PYTHON)


def registers(names: list[str]) -> bool:
    """True if a module is an installed package that depends on Gymnasium, and may register ids."""
    try:
        home = metadata.distribution(names[0])
    except (metadata.PackageNotFoundError, ValueError):
        return False
    folder = Path(str(home.locate_file(names[0]))).resolve()
    needs = any(re.match(r"gymnasium\b", each) for each in home.requires or ())
    return needs and len(names) == 1 and folder in map(Path.resolve, _tops(names[0]) or ())


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
