"""A run folder and its config.yaml, which holds what the run was built from.

config.yaml names the version that wrote it, the single values of the configuration, the SECTIONS
with every interpolation resolved, and the parts that they refer to, by the keys that a user
overrides. A part that occurs several times, such as a model that both the planner and a learner
have, is written once and referenced by a YAML anchor.
"""

import io
import os
import shlex
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from datetime import datetime
from glob import glob
from itertools import chain
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import ConfigAttributeError, ConfigKeyError, OmegaConfBaseException

from hybrid_rl.errors import MisfitError, PartError, UsageError, printable
from hybrid_rl.files import targets as parts
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.run.files.anchors import as_yaml
from hybrid_rl.run.files.integrity import write_text
from hybrid_rl.run.files.lock import lock
from hybrid_rl.run.files.reading import json_file, yaml_file
from hybrid_rl.run.machine.provenance import git_commit
from hybrid_rl.settings.build import CONF
from hybrid_rl.settings.values import COUNTS, SECTIONS, check_words
from hybrid_rl.settings.words import quoted
from hybrid_rl.version import __version__

FIRST = "0.2"  # version that writes its number to config.yaml
SWEEP = "sweep.json"  # in the folder of runs that one program trains (hybrid_rl.run.together)
NO_CHECKPOINT = "holds a run without a checkpoint; delete it, or choose another"


@contextmanager
def claim_folder(config: DictConfig) -> Iterator[Path]:
    """A new run folder for `config`, locked by this process until the end of the block.

    If the block raises before anything is trained, what it wrote there is deleted again, and the
    folder too, if it was made here.
    """
    folder = new_folder(config) if config.run_dir is None else Path(str(config.run_dir))
    new = config.run_dir is None or not folder.exists()
    try:
        with lock(folder, "run_dir"), _cleared(folder):
            saved = checkpoint.steps(folder / "checkpoints")
            if saved or ((folder / "config.yaml").exists() and not rowless(folder)):
                line = f"holds a run already; choose another, or resume={folder}"
                raise UsageError(f"run_dir={folder}: {line if saved else NO_CHECKPOINT}")
            yield folder
    except BaseException:
        with suppress(OSError):  # it holds something
            if new:
                folder.rmdir()
        raise


@contextmanager
def _cleared(folder: Path) -> Iterator[None]:
    """If the block raises before it has written a row or a checkpoint, delete what it wrote."""
    before, then = {path.name for path in folder.iterdir()}, folder.stat()
    try:
        yield
    except BaseException:
        rows = folder / "metrics.jsonl"
        trained = rows.exists() and rows.stat().st_size > 0
        trained = trained or bool(checkpoint.steps(folder / "checkpoints"))
        if not trained and folder.exists() and os.path.samestat(folder.stat(), then):
            for name in {"config.yaml", "metrics.jsonl", "metrics.csv"} - before:
                (folder / name).unlink(missing_ok=True)
        raise


def rowless(folder: Path) -> bool:
    """Whether a run began there and wrote nothing, as when it was stopped while it compiled."""
    rows = folder / "metrics.jsonl"
    empty = rows.exists() and rows.stat().st_size == 0
    return empty and not checkpoint.steps(folder / "checkpoints")


def new_folder(config: DictConfig, suffix: str = "") -> Path:
    """A new folder runs/TASK/ALGO/TIME[suffix]."""
    parent = Path("runs") / config.task / config.algo
    stem = f"{datetime.now():%Y-%m-%d_%H-%M-%S}{suffix}"
    for number in range(10_000):
        folder = parent / (f"{stem}_{number}" if number else stem)
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            continue
        except OSError as error:
            line = f"run_dir={parent}: cannot be written to ({error.strerror})"
            raise UsageError(line) from error
        return folder
    raise UsageError(f"run_dir=null: no free name left for {parent / stem}")


def write(folder: Path, config: DictConfig) -> None:
    """Write config.yaml of a run with the resolved configuration `config`."""
    write_text(folder / "config.yaml", described(config))


def described(config: DictConfig) -> str:
    """What config.yaml of a run with the resolved configuration `config` holds."""
    single = [k for k, value in config.items() if not isinstance(value, DictConfig)]
    order = dict.fromkeys(["task", "algo", *single, *SECTIONS, *config])
    values: Any = {key: config[key] for key in order if key not in ("expert", "version")}
    made: Any = OmegaConf.create({"version": __version__} | values | {"resume": None})
    return as_yaml(made)


def read(folder: Path, key: str) -> DictConfig:
    """The configuration of the run in `folder`, which the argument `key` named."""
    path = folder / "config.yaml"
    config: Any = parse_config(folder, key)
    _check_version(folder, key, config)
    if "agent" in config:
        raise UsageError(
            f"{key}={folder}: trained from parts in Python, which its config.yaml cannot build; "
            "hybrid_rl.train(agent, run_dir=DIR, total_steps=N) reads it back and continues it"
        )
    missing = [name for name in ("task", "algo", "seed", *SECTIONS, *COUNTS) if name not in config]
    if missing:
        raise UsageError(f"{path}: lacks {', '.join(missing)}{of_another_commit(folder)}")
    with blame_config(folder):
        check_words(config)
    _check_seeds(folder, config)
    return config


def read_trained(folder: Path, key: str) -> DictConfig:
    """As `read`; UsageError also of a run without a checkpoint."""
    config = read(folder, key)
    if not checkpoint.steps(folder / "checkpoints"):
        raise UsageError(f"{key}={folder}: holds no checkpoint yet; train it further first")
    return config


def _check_version(folder: Path, key: str, config: DictConfig) -> None:
    """Raise UsageError if another minor version made the run."""
    version = config.get("version")
    if _minor(version) == _minor(__version__):
        return
    if version is None:
        version = _of_summary(folder, "versions", "hybrid_rl")
        if _minor(version) == _minor(__version__):
            raise UsageError(f"{folder / 'config.yaml'}: lacks version")
    commit = _of_summary(folder, "git_commit")
    todo = f"check out its commit, {commit}, or train again" if commit else "train again"
    raise UsageError(
        f"{key}={folder}: made by hybrid_rl {version or f'older than {FIRST}'}, and this is "
        f"{__version__}; {todo}"
    )


def _minor(version: Any) -> list[str]:
    """The first two numbers of a version."""
    return str(version).split(".")[:2]


def _of_summary(folder: Path, *keys: str) -> str | None:
    """What summary.json holds at `keys`, one below the other; None if it has no such thing."""
    try:
        value: Any = json_file(folder / "summary.json")
        for key in keys:
            value = value[key]
    except (ValueError, KeyError, TypeError):
        return None
    return None if value is None else str(value)


def _check_seeds(folder: Path, config: DictConfig) -> None:
    """Raise UsageError if the newest checkpoint holds learners of other seeds."""
    saved = checkpoint.meta(folder / "checkpoints").get("seeds")
    first, number = config.seed, config.num_seeds
    if saved is None or not (isinstance(first, int) and isinstance(number, int)):
        return
    if len(saved) != number or saved != list(range(first, first + number)):
        listed = ", ".join(map(str, saved))
        raise UsageError(
            f"{folder / 'config.yaml'}: seed={first} num_seeds={number}: its checkpoint holds the "
            f"learners of seed {listed}; put back seed={saved[0]} num_seeds={len(saved)}"
        )


@contextmanager
def blame_config(folder: Path, lacking: bool = False) -> Iterator[None]:
    """Errors about the configuration of a run, or just `lacking` keys, name its config.yaml."""
    path = folder / "config.yaml"
    try:
        yield
    except PartError:  # a file of the user's own
        raise
    except (ConfigKeyError, ConfigAttributeError) as error:
        line = f"{path}: lacks {error.full_key or error.key}{of_another_commit(folder)}"
        raise UsageError(line) from error
    except (UsageError, MisfitError, OmegaConfBaseException) as error:
        if lacking:  # the others are of another configuration
            raise
        line = str(error).partition("\n")[0]
        line = f"{path}: {line.removeprefix(f'{path}: ')}{of_another_commit(folder)}"
        raise UsageError(line) from error


def of_another_commit(folder: Path) -> str:
    """The end of a line about a run that another commit of this version made; else empty."""
    commit = other_commit(folder)
    return f"; made at another commit: check out {commit}, or train again" if commit else ""


def other_commit(folder: Path) -> str:
    """The commit that made the run in `folder`; empty if it is this one, or not known."""
    commit = _of_summary(folder, "git_commit")
    return "" if commit in (None, git_commit()) else commit


def members(folder: Path) -> dict[Path, dict[str, float]]:
    """The runs of the sweep in `folder`, and the values of each by key; {} if it holds none."""
    if not (folder / SWEEP).exists():
        return {}
    columns = json_file(folder / SWEEP)
    lists = [column if isinstance(column, list) else [] for column in columns.values()]
    if any(type(x) not in (int, float) for x in chain(*lists)) or len(set(map(len, lists))) != 1:
        raise UsageError(f"{folder / SWEEP}: is not what training writes")
    rows = (dict(zip(columns, row, strict=True)) for row in zip(*lists, strict=True))
    return {folder / str(number): row for number, row in enumerate(rows)}


def going_on(folder: str | Path) -> str:
    """The line with the command that continues a run, or all those of a sweep."""
    resume = shlex.quote(f"resume={quoted(str(folder))}")
    return f"continue: python -m hybrid_rl.train {resume}"


def words(values: Mapping[str, float]) -> str:
    """What sets a run of a sweep apart, as typed; empty if nothing does."""
    return printable(" ".join(f"{key}={value}" for key, value in values.items()))


def parse_config(folder: Path, key: str = "runs") -> DictConfig:
    """What config.yaml of the run in `folder` holds, which the argument `key` named.

    It may come from anybody: it has plain values only, names parts only (files.targets), and
    compiled programs are kept where this machine keeps them.
    """
    path = folder / "config.yaml"
    if not path.exists():
        if runs := members(folder):
            each = ", ".join(f"{run} ({words(values)})" for run, values in runs.items())
            raise UsageError(f"{key}={folder}: holds a sweep; give one of its runs: {each}")
        named = "" if folder == Path() else folder  # of an empty variable, too
        line = f"{key}={named}: no run folder there (no config.yaml in it)"
        below = ("", "/*", "/*/*") if named else ()  # also of a pattern
        found = [file for tail in below for file in glob(f"{folder}{tail}/config.yaml")]
        newest = max(found, key=lambda file: Path(file).stat().st_mtime, default="")
        raise UsageError(f"{line}; the newest is {key}={Path(newest).parent}" if newest else line)
    config = yaml_file(path, lambda text: OmegaConf.load(io.StringIO(text)))
    if not isinstance(config, DictConfig):
        raise UsageError(f"{path}: holds no keys")
    if not config:
        raise UsageError(f"{path}: is empty")
    try:
        values: Any = OmegaConf.to_container(config)
        parts.check({**values, "recipe": str(values.get("recipe"))}, folder)
    except ValueError as error:
        _check_version(folder, key, config)  # another one may have had such a part
        raise UsageError(f"{path}: {error}{of_another_commit(folder)}") from error
    defaults: Any = OmegaConf.load(CONF / "train.yaml")
    config.compile_cache = defaults.compile_cache
    return config
