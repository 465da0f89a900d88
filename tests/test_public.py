"""The public names: the page that lists them, their types and docstrings, and what pages import."""

import ast
import re
from importlib import import_module
from inspect import getdoc, signature
from pathlib import Path
from textwrap import dedent
from types import ModuleType

import pytest

import hybrid_rl as hr
from hybrid_rl.settings.registry import choices

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/*.md"))]
PAGE = (ROOT / "docs/python.md").read_text(encoding="utf-8")


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
        if re.fullmatch(r"[\w.]+", name):
            root, _, rest = name.partition(".")
            full = f"{known.get(root)}.{rest}".split(".")
            known[name] = ".".join(full[: 3 if full[1] in MODULES else 2])
    return {name for name in known.values() if name.split(".")[0] == "hybrid_rl"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_what_a_page_imports_is_public(page):
    """A name that the page of public names lists, or a part that a file of conf/ names."""
    public = {"hybrid_rl", "hybrid_rl.envs.gym", *(f"hybrid_rl.{name}" for name in hr.__all__)}
    public |= {f"hybrid_rl.{module}.{name}" for module in MODULES for name in MODULES[module]}
    files = (path.read_text(encoding="utf-8") for path in (ROOT / "conf").rglob("*.yaml"))
    public |= {name for text in files for name in re.findall(r"_target_: (hybrid_rl\S+)", text)}
    public |= {name for names in choices(ROOT / "conf").values() for name in names.values()}
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
    assert {name for block in blocks for name in used(block)} <= public


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
