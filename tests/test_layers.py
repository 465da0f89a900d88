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
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

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


@cache
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


def outward(file):
    """What a file imports from where it may not."""
    layer = layer_of(module_of(file))
    if layer == "tools":  # stand outside: test_public.py
        return set()
    ours = {name for name in imports_of(file) if name.split(".")[0] == "hybrid_rl"}
    wrong = {name for name in ours if layer_of(name) == "tools"}
    if layer in ("command", "package"):  # __init__.py names what is public
        return wrong
    allowed = {"package", *ALLOWED.get(layer, SHARED)}
    own = ".".join([*module_of(file).split(".")[:3], ""])  # the folder of a part
    others = {name for name in ours if layer_of(name) not in allowed}
    return wrong | {name for name in others if not name.startswith(own)}


def test_imports_point_inward():
    assert not {file: names for file in FILES if (names := outward(file))}


def test_no_modules_import_each_other_in_a_circle():
    """Nor do commands, and wherever in a file the import stands; the package only names others."""
    modules = {module_of(file).removesuffix(".__init__"): file for file in FILES}
    graph = {}
    for module, file in modules.items():
        names = imports_of(file) if layer_of(module) != "package" else set()
        graph[module] = {known for name in names for known in (name, name.rpartition(".")[0])}
        graph[module] &= {*modules} - {module}
    TopologicalSorter(graph).prepare()  # raises CycleError, which shows the circle


def test_only_the_host_imports_hydra():
    others = [file for file in FILES if layer_of(module_of(file)) not in HYDRA]
    tops = {file: {name.split(".")[0] for name in imports_of(file)} for file in FILES}
    assert not [file for file in others if tops[file] & {"hydra", "omegaconf"}]
    assert not [file for file in FILES if tops[file] & {"envs", "conf"}]  # hybrid_rl.envs


def test_file_names_are_specific():
    assert not [file for file in FILES if VAGUE & {*file.relative_to(ROOT).with_suffix("").parts}]


def test_a_file_is_at_most_400_lines_and_a_function_50():
    texts = {file: file.read_text() for file in FILES}
    assert not [file for file, text in texts.items() if len(text.splitlines()) > 400]
    functions = (ast.FunctionDef, ast.AsyncFunctionDef)
    sizes = [
        (file, node.name, node.end_lineno - node.lineno + 1)
        for file, text in texts.items()
        for node in ast.walk(ast.parse(text))
        if isinstance(node, functions)
    ]
    assert not [each for each in sizes if each[-1] > 50]


def test_importing_the_package_imports_no_heavy_module():
    code = "import hybrid_rl, sys; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    heavy = {"jax", "flax", "numpy", "mujoco", "brax", "hydra", "matplotlib"}
    assert not heavy & set(done.stdout.split())


def test_a_bug_to_plant_finds_its_text_and_its_tests():
    for name, mutant in MUTANTS.items():
        assert mutant.old in (ROOT / mutant.file).read_text(encoding="utf-8"), name
        assert all((ROOT / tests).exists() for tests in mutant.tests.split()), name
