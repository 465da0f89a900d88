"""One function follows a name of code, and what it would follow is judged under every key."""

import ast
import json
import random
import re
from pathlib import Path
from typing import Any

import pytest
import yaml
from foreign import written

from hybrid_rl.errors import UsageError
from hybrid_rl.files import targets as parts

ROOT = Path(__file__).resolve().parents[1]
EXTERNAL = {"_target_": "hybrid_rl.envs.adapters.external.External"}


def leaves(node: Any, path: tuple = ()) -> list[tuple]:
    """The paths of all values in a tree."""
    pairs = node.items() if isinstance(node, dict) else enumerate(node)
    inner = [(*path, key) for key, _ in pairs]
    values = [node[key[-1]] for key in inner]
    deep = [leaves(v, k) for k, v in zip(inner, values, strict=True) if isinstance(v, dict | list)]
    return [*inner, *(each for found in deep for each in found)]


def test_every_key_of_a_configuration_asks_the_rule(tmp_path):
    """Also keys that are new: all that training writes, one after another."""
    tree = yaml.safe_load(written()) | {"env": EXTERNAL | {"make": "", "kwargs": {"a": [1]}}}
    paths = {path[-1]: path for path in leaves(tree)}.values()
    assert len(paths) > 70
    for path in paths:
        whole = yaml.safe_load(json.dumps(tree))
        node = whole
        for key in path[:-1]:
            node = node[key]
        node[path[-1]] = "subprocess:getoutput"
        with pytest.raises(UsageError, match=r"=subprocess:getoutput: ") as caught:
            parts.check(whole, tmp_path)
        assert str(caught.value).startswith(".".join(map(str, path)))


WORDS = "import_module|__import__|exec|eval|instantiate|locate|get_class|get_method|run_path"
FOLLOWED = {  # what is imported by a name that is no constant: judged, typed, or from a table
    "hybrid_rl/files/targets.py": {"module", "found[1]"},
    "envs/adapters/external.py": {"registered(self.id)"},
    "hybrid_rl/tools/stand_in.py": {"kind.id"},
    "envs/mujoco/offscreen.py": {"f'mujoco.{name}'"},
    "hybrid_rl/__init__.py": {"f'{module}.{member}'", "module"},
    "hybrid_rl/analysis/studies.py": {"home", "module", "name"},
}


def followed(file: Path) -> set[str]:
    """The names, but for constants, by which a source file imports or runs something."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text("utf-8"))):
        name = ast.unparse(node.func) if isinstance(node, ast.Call) else ""
        asked = re.fullmatch(rf"(.*\.)?({WORDS})|gymnasium\.make(_vec)?", name)
        if asked and not isinstance(node.args[0], ast.Constant):
            found.add(ast.unparse(node.args[0]))
    return found


def test_one_function_follows_a_name():
    """`parts.imported`; a new way to import what a key names has to ask it."""
    homes = ("hybrid_rl/**/*.py", "envs/**/*.py", "thesis/*.py", "thesis/studies/*.py")
    files = [file for home in homes for file in ROOT.glob(home)]
    found = {each.relative_to(ROOT).as_posix(): followed(each) for each in files}
    assert {name: names for name, names in found.items() if names} == FOLLOWED


def test_what_is_followed_is_what_is_judged():
    """A text that `imported` takes is found by `check`, whatever else stands in it."""
    rng, taken = random.Random(0), 0
    for _ in range(20_000):
        text = "".join(rng.choice("os.:-/ A_1\u00e9=") for _ in range(rng.randint(2, 9)))
        if found := parts.NAMED.fullmatch(text):
            taken += 1
            assert parts.ANYWHERE.findall(text)[0] == found.groups()
        else:
            with pytest.raises(ValueError, match="give MODULE:NAME"):
                parts.imported(text)
    assert taken > 50
