"""Text, JSON and YAML from files that may be damaged, or come from anybody: plain values alone."""

import json
import os
import stat
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


def json_file(file: Path) -> dict[str, Any]:
    """The group of keys in a file of JSON."""
    try:
        values = json.loads(text(file))
    except json.JSONDecodeError as error:
        raise UsageError(f"{file}: is not JSON: {error}") from error
    return _group(file, values)


def yaml_file(file: Path) -> dict[str, Any]:
    """The group of keys in a YAML file."""
    try:
        values = yaml.load(text(file), Loader)
    except yaml.YAMLError as error:
        raise UsageError(f"{file}: is no YAML: {' '.join(str(error).split())}") from error
    return _group(file, values)


def _group(file: Path, values: Any) -> dict[str, Any]:
    if not isinstance(values, dict):
        raise UsageError(f"{file}: is empty, or no group of keys")
    return values
