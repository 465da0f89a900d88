"""The commands of hybrid_rl on the pages."""

import re
import shlex
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from itertools import cycle, islice
from pathlib import Path
from types import ModuleType
from typing import Any

from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override
from omegaconf import DictConfig

from hybrid_rl import figures
from hybrid_rl.cli.arguments import HELP, Argument
from hybrid_rl.errors import UsageError
from hybrid_rl.run import members
from hybrid_rl.settings.build import CONF

ROOT = Path(__file__).resolve().parents[1]
LIBRARY = [  # pages; those of the atlas are copied from other pages
    "README.md",
    "CONTRIBUTING.md",
    *(f"docs/{path.name}" for path in sorted(ROOT.glob("docs/*.md")) if path.name != "atlas.md"),
]
RESULTS = [f"docs/results/{path.name}" for path in sorted(ROOT.glob("docs/results/*.md"))]
GROUPS = ("GROUPS", "CHANGES", "ROBOT_CHANGES")  # what commands call their keys KEY.FIELD
LINE = re.compile(r"python -m hybrid_rl\.([\w.]+\w)([^`#\n]*)")
SCRIPT = re.compile(r"python -m scripts\.(\w+) ([^`#\n]+)")


def commands(page: str) -> list[tuple[str, list[str]]]:
    """(command, its words) of every line of a page that runs a command of hybrid_rl."""
    return [(name, shlex.split(words)) for name, words in LINE.findall(text(page))]


def module(name: str) -> ModuleType:
    """The module of a command."""
    spec = find_spec(f"hybrid_rl.{name}")
    package = spec is not None and spec.submodule_search_locations
    return import_module(f"hybrid_rl.{name}{'.__main__' if package else ''}")


def jobs(words: list[str]) -> list[tuple[str, ...]]:
    """Overrides of enough jobs of a sweep that each value is in one of them."""
    parsed = OverridesParser.create().parse_overrides([word for word in words if "=" in word])
    values = [listed(one) for one in parsed]
    most = max(map(len, values), default=1)
    rows = zip(*(islice(cycle(each), most) for each in values), strict=True)
    keys = [one.get_key_element() for one in parsed]
    return [tuple(f"{k}={v}" for k, v in zip(keys, row, strict=True)) for row in rows]


def listed(one: Override) -> list[str]:
    """The values of an override; of a range without steps its ends."""
    if one.is_interval_sweep():
        ends: Any = one.value()
        return [str(ends.start), str(ends.end)]
    return (
        list(one.sweep_string_iterator()) if one.is_sweep_override() else [one.get_value_string()]
    )


def training(page: str) -> list[tuple[str, ...]]:
    """Overrides of the jobs of the page's training commands, without those in a reader's folder."""
    lines = [words for name, words in commands(page) if name == "train"]
    lines = [words for words in lines if "config_dir=my_conf" not in words]
    return sorted({first_run(job) for words in lines for job in jobs(words)})


def first_run(job: tuple[str, ...]) -> tuple[str, ...]:
    """The job with the task and the method of a folder runs/TASK/ALGO/TIME in place of run=."""
    found: list[str] = []
    for word in job:
        run = re.fullmatch(r"run=runs/(.+)/(.+)/.+", word)
        found += [f"task={run[1]}", f"algo={run[2]}"] if run else [word]
    return tuple(found)


def text(page: str) -> str:
    """The page."""
    return (ROOT / page).read_text(encoding="utf-8")


def combinations(pages: list[str]) -> list[list[tuple[str, ...]]]:
    """The pages' training jobs, those with the same choices of groups together."""
    found: dict[tuple[str, ...], dict[tuple[str, ...], None]] = {}
    for page in pages:
        for job in training(page):
            groups = tuple(word for word in job if (CONF / word.partition("=")[0]).is_dir())
            found.setdefault(groups, {})[job] = None
    return [list(jobs) for jobs in found.values()]


def compose(pages: list[str]) -> None:
    """Compose all training jobs: those of one choice of groups at once, alone if that fails."""
    for jobs in combinations(pages):
        keys = dict(word.split("=", 1) for job in jobs for word in job)
        try:
            composed(tuple(f"{key}={value}" for key, value in keys.items()))
        except UsageError:  # one job takes the part away that another one sets
            for job in jobs:
                composed(job)


@cache
def composed(job: tuple[str, ...]) -> DictConfig:
    """The configuration of a job."""
    return members.load([*job])[0].config


def check_arguments(page: str) -> None:
    """Every other command of the page has the arguments that it is given."""
    for name, words in commands(page):
        if name in ("train", "list"):
            continue
        if any(f"`{word.removeprefix('study=')}.py`" in text(page) for word in words):
            continue  # a study that the page itself defines
        known = {one.name for one in declared(name, words)} | set(HELP)
        for word in words:
            key = word.partition("=")[0]
            section, dot, _ = key.partition(".")
            groups = (getattr(module(name), key, {}) for key in GROUPS)
            in_group = dot and any(section in each for each in groups)
            assert in_group or key in known, f"{name}: {word}"
    for name, words in SCRIPT.findall(text(page)):
        if name == "ppo_brax":  # its words are those of `train`; Brax is not imported in tests
            continue
        known = {one.name for one in import_module(f"scripts.{name}").ARGUMENTS}
        wrong = [word for word in shlex.split(words) if word.partition("=")[0] not in known]
        assert not wrong, f"{name}: {wrong}"


def declared(name: str, words: list[str]) -> list[Argument]:
    """Arguments of a command; of `figures` also those of the study that the words name."""
    if name != "figures":
        return module(name).ARGUMENTS
    (study,) = [w.removeprefix("study=") for w in words if "study=" in w] or [figures.DEFAULT]
    if study in ("list", "NAME"):
        return figures.ARGUMENTS
    assert study in figures.studies()
    return [*figures.ARGUMENTS, *figures.arguments(figures.study_of(study))]
