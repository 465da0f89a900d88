"""The commands of hybrid_rl on the pages."""

import re
import shlex
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from itertools import cycle, islice
from types import ModuleType

from hydra.core.override_parser.overrides_parser import OverridesParser
from omegaconf import DictConfig

from hybrid_rl import config
from pages.cited import ROOT

PAGES = [  # those of the atlas are copied from other pages
    "README.md",
    "CONTRIBUTING.md",
    *(
        str(path.relative_to(ROOT))
        for path in sorted((ROOT / "docs").rglob("*.md"))
        if path.name != "atlas.md"
    ),
]
LINE = re.compile(r"python -m hybrid_rl\.([\w.]+\w)([^`#\n]*)")


def commands(page: str) -> list[tuple[str, list[str]]]:
    """(command, its words) of every line of a page that runs a command of hybrid_rl."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return [(name, shlex.split(words)) for name, words in LINE.findall(text)]


def module(name: str) -> ModuleType:
    """The module of a command."""
    spec = find_spec(f"hybrid_rl.{name}")
    package = spec is not None and spec.submodule_search_locations
    return import_module(f"hybrid_rl.{name}{'.__main__' if package else ''}")


def jobs(words: list[str]) -> list[tuple[str, ...]]:
    """Overrides of enough jobs of a sweep that each value is in one of them."""
    parsed = OverridesParser.create().parse_overrides([word for word in words if "=" in word])
    values = [
        list(one.sweep_string_iterator()) if one.is_sweep_override() else [one.get_value_string()]
        for one in parsed
    ]
    most = max(map(len, values), default=1)
    rows = zip(*(islice(cycle(each), most) for each in values), strict=True)
    keys = [one.get_key_element() for one in parsed]
    return [tuple(f"{k}={v}" for k, v in zip(keys, row, strict=True)) for row in rows]


def training(page: str) -> list[tuple[str, ...]]:
    """Overrides of the jobs of the page's training commands, without those in a reader's folder."""
    lines = [words for name, words in commands(page) if name == "train"]
    lines = [words for words in lines if "--config-dir" not in words]
    return sorted({job for words in lines for job in jobs(words)})


@cache
def composed(job: tuple[str, ...]) -> DictConfig:
    """The configuration of a job."""
    return config.load(job)
