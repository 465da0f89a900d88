"""What the tests of broken worlds share; see faulty.py."""

import sys

import pytest


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A working folder with a world, its task file and a model."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    (tmp_path / "my_conf" / "task").mkdir(parents=True)
    yield tmp_path
    sys.modules.pop("w", None)
