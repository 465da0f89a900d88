"""A run folder: one process writes to it, and its config.yaml is read back or blamed in one line.

While a process trains, the folder holds `lock`: a file that the operating system locks (flock)
and that names the process. The system lets go of it when the process ends, however that ends: a
file that a killed process left is no lock.
"""

import errno
import fcntl
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import datetime
from pathlib import Path
from pkgutil import resolve_name
from tempfile import TemporaryFile
from typing import Any

import yaml
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import ConfigAttributeError, ConfigKeyError, OmegaConfBaseException

from hybrid_rl.config import COUNTS, SECTIONS
from hybrid_rl.errors import MisfitError, UsageError
from hybrid_rl.run import checkpoint

LOCK = "lock"
NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL)  # of some network disks


@contextmanager
def locked(folder: Path, key: str) -> Iterator[Path]:
    """`folder`, which is of this process alone until the end of the block.

    Raises:
        UsageError: where another process has it, or it cannot be written to.
    """
    path = folder / LOCK
    handle = _opened(path, key)
    try:
        with suppress(OSError):  # on a full disk the file stays empty
            os.ftruncate(handle, 0)
            os.write(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode())
        yield folder
    finally:
        with suppress(OSError):
            path.unlink()
        os.close(handle)


def _opened(path: Path, key: str) -> int:
    """The handle of the lock file at `path`, locked."""
    while True:
        try:
            handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        except OSError as error:
            line = f"{key}={path.parent}: cannot be written to ({error.strerror})"
            raise UsageError(line) from error
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.path.samestat(os.fstat(handle), path.stat()):
                return handle
        except FileNotFoundError:  # the process before has just deleted it
            pass
        except BlockingIOError:
            holder = os.read(handle, 200).decode(errors="replace").strip() or "another process"
            os.close(handle)
            raise UsageError(
                f"{key}={path.parent}: is being written by {holder}; wait for it, or stop it"
            ) from None
        except OSError as error:
            if error.errno not in NO_LOCKS:
                os.close(handle)
                raise
            print(f"{path.parent}: no locks on this disk; let no other process write there")
            return handle
        os.close(handle)


@contextmanager
def fresh(config: DictConfig) -> Iterator[Path]:
    """A new run folder for `config`, of this process alone until the end of the block.

    Raises:
        UsageError: where it holds a run already, another process has it, or it cannot be written.
    """
    folder = made(config) if config.run_dir is None else Path(str(config.run_dir))
    with locked(writable(folder, "run_dir"), "run_dir"):
        if (folder / "config.yaml").exists() or checkpoint.steps(folder / "checkpoints"):
            raise UsageError(
                f"run_dir={folder}: holds a run already; choose another, or resume={folder}"
            )
        yield folder


def made(config: DictConfig, suffix: str = "") -> Path:
    """A folder runs/TASK/ALGO/TIME[suffix] that did not exist.

    Raises:
        UsageError: where it cannot be written.
    """
    parent = writable(Path("runs") / config.task / config.algo, "run_dir")
    stem = f"{datetime.now():%Y-%m-%d_%H-%M-%S}{suffix}"
    for number in range(10_000):
        folder = parent / (f"{stem}_{number}" if number else stem)
        try:
            folder.mkdir()
        except FileExistsError:
            continue
        return folder
    raise UsageError(f"run_dir=null: no free name left for {parent / stem}")


def writable(folder: Path, key: str) -> Path:
    """`folder`, made if need be.

    Raises:
        UsageError: where it cannot be written to.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with TemporaryFile(dir=folder):  # of no other run that begins at the same time
            pass
    except OSError as error:
        raise UsageError(f"{key}={folder}: cannot be written to ({error.strerror})") from error
    return folder


def read(folder: Path, key: str) -> DictConfig:
    """The configuration of the run in `folder`, which `key` named.

    Raises:
        UsageError: where there is no run, or its config.yaml is not what training wrote.
    """
    path = folder / "config.yaml"
    if not path.exists():
        raise UsageError(f"{key}={folder}: no run folder there (no config.yaml in it)")
    config: Any = _parsed(path)
    missing = [name for name in ("task", "algo", "seed", *SECTIONS, *COUNTS) if name not in config]
    if missing:
        raise UsageError(f"{path}: lacks {', '.join(missing)}")
    for where, target in _targets({"env": config.env} | dict(config.items())):
        try:
            resolve_name(target)
        except (ImportError, AttributeError, ValueError) as error:
            raise UsageError(
                f"{path}: {where}={target} cannot be imported ({error}); put the folder of its "
                "module on PYTHONPATH"
            ) from error
    held = checkpoint.shapes(folder / "checkpoints").get("key")
    if held and held[0] != config.num_seeds:
        raise UsageError(f"{path} says {config.num_seeds} seeds, its checkpoint holds {held[0]}")
    return config


@contextmanager
def blamed(folder: Path) -> Iterator[None]:
    """What is wrong with the configuration of a run is its file's fault, not the user's keys'.

    Raises:
        UsageError: which names config.yaml.
    """
    path = folder / "config.yaml"
    try:
        yield
    except (ConfigKeyError, ConfigAttributeError) as error:
        raise UsageError(f"{path}: lacks {error.full_key or error.key}") from error
    except (UsageError, MisfitError, OmegaConfBaseException) as error:
        line = str(error).partition("\n")[0]
        raise UsageError(f"{path}: {line.removeprefix(f'{path}: ')}") from error


def _parsed(path: Path) -> DictConfig:
    """What a file holds that OmegaConf wrote."""
    try:
        config = OmegaConf.load(path)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = f"line {mark.line + 1}" if mark else "it"
        raise UsageError(f"{path}: {line} is no YAML") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise UsageError(f"{path}: is no text in YAML") from error
    except OSError as error:  # of the system, or OmegaConf's for a file that is one word
        reason = error.strerror or "it holds no keys"
        raise UsageError(f"{path}: cannot be read ({reason})") from error
    if not isinstance(config, DictConfig):
        raise UsageError(f"{path}: holds no keys")
    if not config:
        raise UsageError(f"{path}: is empty")
    return config


def _targets(node: Any, where: str = "") -> Iterator[tuple[str, str]]:
    """Every `_target_` below a part of a configuration, with its key."""
    for name, value in node.items():
        if name == "_target_":
            yield f"{where}{name}", str(value)
        elif isinstance(value, DictConfig):
            yield from _targets(value, f"{where}{name}.")
