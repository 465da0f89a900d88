"""The public names: the page that lists them, their types and docstrings, and what pages import."""

import ast
import re
from functools import cache
from importlib import import_module
from inspect import getdoc, signature
from pathlib import Path
from textwrap import dedent
from types import ModuleType

import pytest

import hybrid_rl as hr
from hybrid_rl.envs.adapters import stand_in
from hybrid_rl.settings.groups import choices

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/*.md"))]
PAGE = (ROOT / "docs/python.md").read_text(encoding="utf-8")
TOOLS = ROOT / "hybrid_rl/tools"
PRIVATE = {"benchmark": 1}  # tool -> names that it imports and that are not public: add none


def rows(table):
    """Names in the first and in the second column of a table of the page."""
    lines = PAGE.split("|---|---|\n")[table].partition("\n\n")[0].splitlines()
    return [[re.findall(r"`(\w+)`", cell) for cell in line.split("|")[1:3]] for line in lines]


MODULES = {module: names for (module,), names in rows(2)}  # of the page -> its public names


def test_the_page_lists_the_public_names():
    names = [name for each, _ in rows(1) for name in each]
    assert sorted([*names, *MODULES]) == sorted(hr.__all__)
    assert dir(hr) == sorted([*hr.__all__, "__version__"])


@pytest.mark.parametrize("module", MODULES)
def test_the_public_names_of_a_module_are_there(module):
    for name in MODULES[module]:
        assert getdoc(getattr(getattr(hr, module), name))


def used(code):
    """The names of hybrid_rl that code imports, and those that it takes from a public module."""
    tree, known = ast.parse(dedent(code)), {"hr": "hybrid_rl"}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom | ast.Import):
            parent = f"{node.module}." if isinstance(node, ast.ImportFrom) else ""
            known |= {each.asname or each.name: f"{parent}{each.name}" for each in node.names}
    for node in ast.walk(tree):
        name = ast.unparse(node) if isinstance(node, ast.Attribute) else ""
        root, _, rest = name.partition(".")
        full = f"{known.get(root)}.{rest}".split(".")
        open_to_all = known.get(root) in ("hybrid_rl", *(f"hybrid_rl.{each}" for each in MODULES))
        if re.fullmatch(r"[\w.]+", name) and open_to_all:
            known[name] = ".".join(full[: 3 if full[1] in MODULES else 2])
    return {name for name in known.values() if name.split(".")[0] == "hybrid_rl"}


@cache
def public():
    """The names that the page of public names lists, and the parts that files of conf/ name."""
    names = {"hybrid_rl", "hybrid_rl.envs.gym", *(f"hybrid_rl.{name}" for name in hr.__all__)}
    names |= {f"hybrid_rl.{module}.{name}" for module in MODULES for name in MODULES[module]}
    names |= {f"hybrid_rl.protocols.{name}" for name in dir(hr.protocols)}
    names |= {f"hybrid_rl.envs.adapters.stand_in.{name}" for name in dir(stand_in)}
    names.add("hybrid_rl.__version__")
    files = (path.read_text(encoding="utf-8") for path in (ROOT / "conf").rglob("*.yaml"))
    names |= {name for text in files for name in re.findall(r"_target_: (hybrid_rl\S+)", text)}
    return names | {name for parts in choices(ROOT / "conf").values() for name in parts.values()}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_what_a_page_imports_is_public(page):
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert {name for block in blocks for name in used(block)} <= public()


def test_tools_import_what_is_public():
    """As a project of a user's would, but for as many names as PRIVATE has."""
    found = {}
    for file in TOOLS.rglob("*.py"):
        names = used(file.read_text(encoding="utf-8")) - public()
        tool = found.setdefault(file.relative_to(TOOLS).parts[0].removesuffix(".py"), set())
        tool |= {name for name in names if not f"{name}.".startswith("hybrid_rl.tools.")}
    assert not {tool: names for tool, names in found.items() if len(names) > PRIVATE.get(tool, 0)}


@pytest.mark.parametrize("name", hr.__all__)
def test_a_public_name_has_a_docstring_and_types(name):
    value = getattr(hr, name)
    assert getdoc(value)
    if callable(value) and not isinstance(value, type):
        found = signature(value)
        annotations = [found.return_annotation, *(p.annotation for p in found.parameters.values())]
        assert found.empty not in annotations


def test_another_name_is_no_attribute():
    with pytest.raises(AttributeError, match=r"'hybrid_rl' has no attribute 'trian'"):
        hr.trian  # noqa: B018


@pytest.mark.parametrize("name", ["evaluate", "train"])
def test_a_command_is_a_module_that_can_be_called(name):
    module = import_module(f"hybrid_rl.{name}")
    assert isinstance(module, ModuleType)
    assert module is getattr(hr, name)
    assert signature(module) == signature(getattr(module, name))
