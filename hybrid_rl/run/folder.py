"""A run folder and its config.yaml, which holds what the run was built from.

config.yaml names the version that wrote it, the single values of the configuration, the SECTIONS
with every interpolation resolved, and the parts that they refer to, by the keys that a user
overrides. A part that occurs several times, such as a model that both the planner and a learner
have, is written once and referenced by a YAML anchor.
"""

import shlex
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from datetime import datetime
from pathlib import Path
from typing import Any

import yaml
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from hybrid_rl.errors import MisfitError, PartError, UsageError, printable
from hybrid_rl.files import targets as parts
from hybrid_rl.files.atomic import write_text
from hybrid_rl.files.lock import lock
from hybrid_rl.files.reading import json_file, yaml_file
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.settings.build import CONF
from hybrid_rl.settings.values import SECTIONS, check
from hybrid_rl.settings.words import plain, quoted
from hybrid_rl.version import __version__

SWEEP = "sweep.json"  # in the folder of runs that one program trains (hybrid_rl.run.members)


@contextmanager
def claim_folders(configs: Sequence[DictConfig]) -> Iterator[list[Path]]:
    """New run folders for `configs`, locked by this process until the end of the block.

    One is run_dir; several are 0, 1, ... in it. What is empty afterwards is deleted again.
    """
    given, several = configs[0].run_dir, len(configs) > 1
    parent = new_folder(configs[0]) if given is None else Path(str(given))
    folders = [parent / str(number) for number in range(len(configs))] if several else [parent]
    with ExitStack() as stack:
        for folder in dict.fromkeys([parent, *folders]):
            if given is None or not folder.exists():
                stack.callback(remove_empty, folder)
        for folder, config in zip(folders, configs, strict=True):
            if several:
                config.run_dir = str(folder)
            stack.enter_context(lock(folder, "run_dir"))
        files = (run / name for run in (parent, *folders) for name in ("config.yaml", SWEEP))
        if any(map(Path.exists, files)):
            line = f"holds a run already; choose another, or resume={parent}"
            raise UsageError(f"run_dir={parent}: {line}")
        yield folders


def remove_empty(folder: Path) -> None:
    """Delete a folder, unless it holds something or is not there."""
    with suppress(OSError):
        folder.rmdir()


def new_folder(config: DictConfig, suffix: str = "") -> Path:
    """A new folder runs/TASK/ALGO/TIME[suffix]."""
    parent = Path("runs") / config.task / config.algo
    stem = f"{datetime.now():%Y-%m-%d_%H-%M-%S}{suffix}"
    folder, number = parent / stem, 0
    while True:
        try:
            folder.mkdir(parents=True)
            return folder
        except FileExistsError:
            number += 1
            folder = parent / f"{stem}_{number}"


def write(folder: Path, config: DictConfig) -> None:
    """Write config.yaml of a run with the resolved configuration `config`."""
    write_text(folder / "config.yaml", described(config))


def described(config: DictConfig) -> str:
    """The text of config.yaml of a run with the resolved configuration `config`."""
    single = [k for k, value in config.items() if not isinstance(value, DictConfig)]
    order = dict.fromkeys(["task", "algo", *single, *SECTIONS, *config])
    values: Any = {key: config[key] for key in order if key not in ("expert", "version")}
    made: Any = OmegaConf.create({"version": __version__} | values | {"resume": None})
    return as_yaml(made)


def as_yaml(config: DictConfig) -> str:
    """`config` as YAML; equal parts are one object, which PyYAML writes once."""
    first: dict[str, Any] = {}  # a part as text -> its first occurrence

    def share(node: Any) -> Any:
        if not isinstance(node, dict):
            return node
        names = sorted(node, key=lambda name: name != "_target_")  # it comes first
        node = {name: share(node[name]) for name in names}
        return first.setdefault(str(node), node) if "_target_" in node else node

    values = share(plain(config))
    return yaml.dump(values, Dumper=_Dumper, sort_keys=False, allow_unicode=True)


class _Dumper(yaml.SafeDumper):
    """Lists on a line."""

    def sequence(self, data: list[Any]) -> yaml.Node:
        flow = not any(isinstance(value, (dict, list)) for value in data)
        return self.represent_sequence("tag:yaml.org,2002:seq", data, flow_style=flow)


_Dumper.add_representer(list, _Dumper.sequence)


def read(folder: Path, key: str) -> DictConfig:
    """The configuration of the run in `folder`, which the argument `key` named."""
    config: Any = parse_config(folder, key)
    _check_version(folder, key, config)
    if "agent" in config:
        raise UsageError(
            f"{key}={folder}: trained from parts in Python, which its config.yaml cannot build; "
            "hybrid_rl.train(agent, run_dir=DIR, total_steps=N) reads it back and continues it"
        )
    with blame_config(folder):
        check(config)
    return config


def read_trained(folder: Path, key: str) -> DictConfig:
    """The configuration of a run that has a checkpoint; UsageError otherwise, and as of `read`."""
    config = read(folder, key)
    if not checkpoint.steps(folder / "checkpoints"):
        raise UsageError(f"{key}={folder}: holds no checkpoint yet")
    return config


def _check_version(folder: Path, key: str, config: Mapping[str, Any]) -> None:
    """Raise UsageError if another minor version made the run."""
    summary = {}
    with suppress(UsageError):
        summary = json_file(folder / "summary.json", optional=True)
    version = config.get("version") or summary.get("versions", {}).get("hybrid_rl")
    if str(version).split(".")[:2] != __version__.split(".")[:2]:
        commit = summary.get("git_commit")
        todo = f"check out its commit, {commit}, or train again" if commit else "train again"
        made = f"made by hybrid_rl {version or 'before 0.2'}, and this is {__version__}"
        raise UsageError(f"{key}={folder}: {made}; {todo}")


@contextmanager
def blame_config(folder: Path) -> Iterator[None]:
    """Errors about the configuration of a run name its config.yaml."""
    path = folder / "config.yaml"
    try:
        yield
    except PartError:  # of a file of the user's own
        raise
    except (UsageError, MisfitError, OmegaConfBaseException) as error:
        line = str(error).partition("\n")[0]
        raise UsageError(f"{path}: {line.removeprefix(f'{path}: ')}") from error


def members(folder: Path) -> dict[Path, dict[str, float]]:
    """The runs of the sweep in `folder`, and the values of each by key; {} if it holds none."""
    columns = json_file(folder / SWEEP, optional=True)
    rows = (dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True))
    return {folder / str(number): row for number, row in enumerate(rows)}


def going_on(folder: str | Path) -> str:
    """The line with the command that continues a run, or all those of a sweep."""
    resume = shlex.quote(f"resume={quoted(str(folder))}")
    return f"continue: python -m hybrid_rl.train {resume}"


def words(values: Mapping[str, float]) -> str:
    """The values that set a run of a sweep apart, as typed; empty if it has none."""
    return printable(" ".join(f"{key}={value}" for key, value in values.items()))


def parse_config(folder: Path, key: str = "runs") -> DictConfig:
    """The content of config.yaml of the run in `folder`, which the argument `key` named.

    It may come from anybody: it has plain values only, names parts only (files.targets), and
    compiled programs are kept where this machine keeps them.
    """
    path = folder / "config.yaml"
    if not path.exists():
        inside = max((str(file.parent) for file in folder.glob("*/config.yaml")), default="")
        flaw = "no run folder there (no config.yaml in it)" + f"; in it is {inside}" * bool(inside)
        if runs := members(folder):
            listed = ", ".join(f"{run} ({words(values)})" for run, values in runs.items())
            flaw = f"holds a sweep; give one of its runs: {listed}"
        raise UsageError(f"{key}={folder}: {flaw}")
    values = yaml_file(path)
    try:
        parts.check({**values, "recipe": str(values.get("recipe"))}, folder)
    except ValueError as error:
        _check_version(folder, key, values)  # another one may have had such a part
        raise UsageError(f"{path}: {error}") from error
    here = yaml_file(CONF / "train.yaml")["compile_cache"]
    return OmegaConf.create(values | {"compile_cache": here})
