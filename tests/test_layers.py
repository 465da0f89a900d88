"""Which rooms import which, the size of files, and the bugs that scripts/mutants.py plants.

types, errors, version, fields, files
      ^
core, networks
      ^
models controllers ... data <- training <- settings, outside <- run <- analysis <- commands
                                                                cli             <- thesis
parts never import each other: YAML files combine them; some read files by data/archive
a part may be a folder, whose files import each other

envs -> types, fields, protocols, errors, files
tools stand outside: nothing imports them, and they import what is public (tests/test_public.py)
"""

import ast
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from scripts.mutants import MUTANTS

ROOT = Path(__file__).resolve().parents[1]
PATTERNS = ("hybrid_rl/**/*.py", "envs/**/*.py", "thesis/*.py", "thesis/studies/*.py")
FILES = sorted(file for pattern in PATTERNS for file in ROOT.glob(pattern))
LAYER_FILES = {"types", "errors", "fields", "version"}
SHARED = {"types", "fields", "protocols", "core", "networks"}
CONFIG = {
    *("types", "fields", "protocols", "errors", "version", "files", "networks", "envs"),
    *("training", "settings"),
}
ALLOWED = {
    "types": set(),
    "errors": set(),
    "version": set(),
    "fields": set(),
    "files": {"errors", "fields", "files"},  # judges names, and writes whole
    "protocols": {"types", "errors", "fields", "protocols"},
    "core": {"types", "fields", "protocols", "core"},
    "networks": {"types", "fields", "protocols", "core", "networks"},
    "envs": {"types", "fields", "protocols", "core", "errors", "files", "envs"},
    "training": {"errors", *SHARED, "files", "envs", "data", "training"},
    "archive": {"types", "files", "protocols"},
    "data": {*SHARED, "files", "archive"},
    "beliefs": {*SHARED, "files", "archive"},
    "policies": {*SHARED, "archive"},
    "settings": CONFIG,  # from words to the parts that YAML names
    "outside": {"errors", *SHARED, "files", "envs", "data", "training", "outside"},
    "run": {*CONFIG, "core", "archive", "data", "controllers", "outside", "run"},  # on the host
    "cli": {*CONFIG, "run", "cli"},  # what the commands share
    "analysis": {*SHARED, *CONFIG, "data", "outside", "run", "cli", "analysis"},
    # as a user's project would; nothing imports it
    "thesis": {*SHARED, *CONFIG, "data", "beliefs", "learners", "run", "outside", "cli", "analysis"}
    | {"thesis"},
}
HYDRA = {"command", "settings", "run", "cli", "tools", "analysis", "thesis"}
VAGUE = {"utils", "util", "common", "base", "helpers", "helper", "misc", "manager"}

over_files = pytest.mark.parametrize("file", FILES, ids=lambda f: str(f.relative_to(ROOT)))


def module_of(file):
    """hybrid_rl.core.sampling of hybrid_rl/core/sampling.py; envs/ counts as hybrid_rl.envs."""
    parts = file.relative_to(ROOT).with_suffix("").parts
    parts = parts if parts[0] == "hybrid_rl" else ("hybrid_rl", *parts)
    return ".".join(parts)


def layer_of(module):
    """The folder of a module, or the name of its file; "command" for a command."""
    if module.startswith("hybrid_rl.data.archive"):  # no part
        return "archive"
    parts = module.split(".")
    if len(parts) < 2 or parts[1].startswith("__"):
        return "package"
    is_file = (ROOT / "hybrid_rl" / f"{parts[1]}.py").exists()
    return "command" if is_file and parts[1] not in LAYER_FILES else parts[1]


def imports_of(file):
    """Full names of all modules and objects that a file imports."""
    names = set()
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            outer = module_of(file).split(".")[: -node.level] if node.level else []
            inner = [*outer, *filter(None, [node.module])]
            names |= {".".join([*inner, alias.name]) for alias in node.names}
    return names


@over_files
def test_imports_point_inward(file):
    layer = layer_of(module_of(file))
    if layer == "tools":  # stand outside: test_public.py
        return
    ours = {name for name in imports_of(file) if name.split(".")[0] == "hybrid_rl"}
    assert not {name for name in ours if layer_of(name) == "tools"}
    if layer in ("command", "package"):  # __init__.py names what is public
        return
    allowed = {"package", *ALLOWED.get(layer, SHARED)}
    own = ".".join([*module_of(file).split(".")[:3], ""])  # the folder of a part
    outward = {name for name in ours if layer_of(name) not in allowed and not name.startswith(own)}
    assert not outward, f"{layer} may import only {sorted(allowed)}"


def test_no_modules_import_each_other_in_a_circle():
    """Nor do commands, and wherever in a file the import stands; the package only names others."""
    modules = {module_of(file).removesuffix(".__init__"): file for file in FILES}
    graph = {}
    for module, file in modules.items():
        names = imports_of(file) if layer_of(module) != "package" else set()
        graph[module] = {known for name in names for known in (name, name.rpartition(".")[0])}
        graph[module] &= {*modules} - {module}
    TopologicalSorter(graph).prepare()  # raises CycleError, which shows the circle


@over_files
def test_only_the_host_imports_hydra(file):
    third_party = {name.split(".")[0] for name in imports_of(file)}
    assert layer_of(module_of(file)) in HYDRA or not third_party & {"hydra", "omegaconf"}


@over_files
def test_environments_are_imported_from_the_package(file):
    assert not {name for name in imports_of(file) if name.split(".")[0] in ("envs", "conf")}


@over_files
def test_file_names_are_specific(file):
    assert not VAGUE & set(file.relative_to(ROOT).with_suffix("").parts)


@over_files
def test_a_file_is_at_most_400_lines_and_a_function_50(file):
    text = file.read_text()
    assert len(text.splitlines()) <= 400
    functions = (ast.FunctionDef, ast.AsyncFunctionDef)
    sizes = {
        node.name: node.end_lineno - node.lineno + 1
        for node in ast.walk(ast.parse(text))
        if isinstance(node, functions)
    }
    assert not {name: lines for name, lines in sizes.items() if lines > 50}


def test_importing_the_package_imports_no_heavy_module():
    code = "import hybrid_rl, sys; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    heavy = {"jax", "flax", "numpy", "mujoco", "brax", "hydra", "matplotlib"}
    assert not heavy & set(done.stdout.split())


@pytest.mark.parametrize("name", MUTANTS)
def test_a_bug_to_plant_finds_its_text_and_its_tests(name):
    mutant = MUTANTS[name]
    assert mutant.old in (ROOT / mutant.file).read_text(encoding="utf-8")
    assert all((ROOT / tests).exists() for tests in mutant.tests.split())
