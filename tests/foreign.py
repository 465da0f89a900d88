"""Run folders from anybody, and by which line they are refused."""

import json
import os
import sys
from functools import cache
from pathlib import Path

import pytest
import yaml
from tiny import SMALL, contents

from hybrid_rl.errors import UsageError
from hybrid_rl.run import folder as run_folder
from hybrid_rl.settings import build as config

METRIC = "metric=eval/return"
ROW = {"step": 5, "seed": 0, "wall_s": 1.0, "eval/return": -3.0}


@cache
def written() -> str:
    """config.yaml as training writes it."""
    return run_folder.described(config.load([*SMALL, "algo=sac"]))


def made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A run folder in the current one, with a module next to it that tells when it is imported."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "zz_evil", raising=False)
    path = tmp_path / "theirs" / "run"
    path.mkdir(parents=True)
    (path / "config.yaml").write_text(written())
    (path / "metrics.jsonl").write_text(json.dumps(ROW) + "\n")
    (path / "summary.json").write_text(json.dumps({"task": "pendulum", "algo": "sac"}))
    for each in (path, path.parent):
        (each / "zz_evil.py").write_text("open('ran', 'w')\nclass World: pass\n")
    return path


def no_plain_file(path: Path, kind: str) -> None:
    """Make a pipe, a link to an endless device, or a folder where a file should be."""
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path.symlink_to("/dev/zero")
    else:
        path.mkdir()


def refused(folder: Path, read=lambda folder: run_folder.read(folder, "run")) -> str:
    """The one line by which reading a folder is refused; it changes and imports nothing."""
    before, modules = contents(folder.parent.parent), set(sys.modules)
    with pytest.raises(UsageError) as caught:
        read(folder)
    assert contents(folder.parent.parent) == before
    assert not {"this", "zz_evil", "theirs", "antigravity"} & (set(sys.modules) - modules)
    line = str(caught.value)
    assert line.count("\n") == 0
    return line


def changed(folder: Path, **keys: object) -> None:
    """Give keys of config.yaml other values."""
    file = folder / "config.yaml"
    file.write_text(yaml.safe_dump(yaml.safe_load(file.read_text()) | keys))
