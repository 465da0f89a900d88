"""Text, JSON and YAML from files that may be damaged, or come from anybody.

A file that is no plain one, such as a pipe or a device, is not read; one that is too large, or
whose content would grow beyond measure, is refused before it is parsed.
"""

import json
import os
import stat
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO

import yaml

from hybrid_rl.errors import UsageError
from hybrid_rl.files.atomic import NO_WAIT

TEXT, YAML, LINE = 2**25, 2**20, 2**20  # [bytes] of a file, of one in YAML, of a line at most
VALUES = 20_000  # of a YAML file at most; what is referenced counts each time
DEEPEST = 40  # groups within groups
Loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def open_file(file: Path) -> BinaryIO:
    """A plain file, open for reading."""
    try:
        handle = os.open(file, os.O_RDONLY | NO_WAIT)
        if stat.S_ISREG(os.fstat(handle).st_mode):
            return os.fdopen(handle, "rb")
        os.close(handle)
        flaw = "it is no plain file"
    except OSError as error:
        flaw = error.strerror
    raise UsageError(f"{file}: cannot be read ({flaw})")


def text(file: Path, most: int = TEXT) -> str:
    """The text of a file of at most so many bytes."""
    with open_file(file) as data:
        content = data.read(most + 1)
    if len(content) > most:
        raise UsageError(f"{file}: is larger than {most // 2**20} MB")
    try:
        return content.decode("utf-8").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        raise UsageError(f"{file}: is not text (UTF-8)") from error


def lines(file: Path, most: int | None = None) -> Iterator[bytes]:
    """The lines of a file with their ends, of its first `most` bytes."""
    with open_file(file) as data:
        left, number = most, 0
        while left is None or left > 0:
            line = data.readline(LINE if left is None else min(left, LINE))
            if not line:
                return
            number += 1
            if len(line) == LINE:
                raise UsageError(f"{file}: line {number} is longer than {LINE // 2**20} MB")
            left = None if left is None else left - len(line)
            yield line


def from_json(content: str | bytes) -> Any:
    """The value of a text in JSON; ValueError if it is none, or nested too deeply."""
    try:
        return json.loads(content)
    except RecursionError as error:
        raise ValueError("is nested too deeply") from error


def json_file(file: Path) -> dict[str, Any]:
    """The group of keys in a file of JSON."""
    content, values = text(file), None
    with suppress(ValueError):
        values = from_json(content)
    if not isinstance(values, dict):
        raise UsageError(f"{file}: is not JSON, or no group of keys")
    return values


def yaml_file(file: Path, load: Callable[[str], Any]) -> Any:
    """The result of `load` for the text of a YAML file."""
    content = text(file, YAML)
    try:
        flaw = _flaw(content)
        if not flaw:
            return load(content)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None) or getattr(error, "context_mark", None)
        flaw = f"line {mark.line + 1} is no YAML" if mark else "is no text in YAML"
    except (ValueError, RecursionError) as error:
        flaw = str(error).partition("\n")[0]
    raise UsageError(f"{file}: {flaw}")


def _flaw(content: str) -> str:
    """The reason for which YAML is refused: too large, or more than plain values; "" if none."""
    sizes = [0]  # values in each open group; the first counts the whole file
    anchors: list[str | None] = []  # of each open group
    known: dict[str, int] = {}  # anchor -> values below it
    for event in yaml.parse(content, Loader):
        line, word = f"line {event.start_mark.line + 1}", getattr(event, "value", "")
        match event:
            case yaml.CollectionStartEvent():
                sizes.append(1)
                anchors.append(event.anchor)
            case yaml.CollectionEndEvent():
                size, anchor = sizes.pop(), anchors.pop()
                sizes[-1] += size
                if anchor:
                    known[anchor] = size
            case yaml.AliasEvent() if event.anchor not in known:
                return f"*{event.anchor} refers to itself, or to nothing"
            case yaml.AliasEvent():
                sizes[-1] += known[event.anchor]
            case yaml.ScalarEvent():
                if event.anchor:
                    known[event.anchor] = 1
                sizes[-1] += 1
        if "${" in word:
            return f"{line}: {word} is an interpolation; it must be a plain value"
        if word == "<<":
            return f"{line} is no YAML of training (<< merges keys)"
        if getattr(event, "tag", None) not in (None, "!"):
            return f"{line} is no YAML of training (a tag)"
        if len(sizes) > DEEPEST:
            return f"{line} is nested too deeply"
        if sizes[-1] > VALUES:
            return f"holds more than {VALUES:,} values"
    return ""
