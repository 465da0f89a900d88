"""Text, JSON and YAML from files that may be damaged, or come from anybody: plain values alone."""

import json
import os
import stat
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO

import yaml

from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import NO_WAIT

TEXT = 2**25  # [bytes] of a file at most
Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def open_file(file: Path) -> BinaryIO:
    """A plain file, open for reading; a pipe or a device is none."""
    try:
        handle = os.open(file, os.O_RDONLY | NO_WAIT)
        if stat.S_ISREG(os.fstat(handle).st_mode):
            return os.fdopen(handle, "rb")
        os.close(handle)
        flaw = "it is no plain file"
    except OSError as error:
        flaw = error.strerror
    raise UsageError(f"{file}: cannot be read ({flaw})")


def text(file: Path) -> str:
    """The text of a file."""
    with open_file(file) as data:
        content = data.read(TEXT + 1)
    if len(content) > TEXT:
        raise UsageError(f"{file}: is larger than {TEXT // 2**20} MB")
    try:
        return content.decode("utf-8").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise UsageError(f"{file}: is not text (UTF-8)") from error


def json_file(file: Path, optional: bool = False) -> dict[str, Any]:
    """The group of keys in a file of JSON; optional: {} if there is no file."""
    return {} if optional and not file.exists() else _group(file, "JSON", json.loads)


def yaml_file(file: Path) -> dict[str, Any]:
    """The group of keys in a YAML file."""
    return _group(file, "YAML", lambda content: yaml.load(content, Loader))


def _group(file: Path, kind: str, parse: Callable[[str], Any]) -> dict[str, Any]:
    """The group of keys that `parse` makes of the text of a file."""
    content, flaw = text(file), "is empty, or no group of keys"
    try:
        if isinstance(values := parse(content), dict):
            return values
    except (ValueError, yaml.YAMLError) as error:
        flaw = f"is no {kind}: {' '.join(str(error).split())}"
    raise UsageError(f"{file}: {flaw}")
