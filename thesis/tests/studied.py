"""Studies, called in this process."""

import json
from pathlib import Path
from typing import Any

from tiny import call

from hybrid_rl import figures, train
from hybrid_rl.cli import command
from hybrid_rl.settings import build as config


def trained(*overrides: str) -> None:
    """A run that keeps no compiled programs."""
    train.train(config.load([*overrides, "compile_cache=null"]))


def code(study: str, *arguments: str) -> int:
    """Exit code of the command that draws a study."""
    return call(lambda: command.run(figures.main), f"study={study}", *arguments)


def drawn(out: Path, study: str, *arguments: str) -> Any:
    """The numbers of a study, whose picture is `out`."""
    assert code(study, *arguments, f"out={out}") == 0
    assert out.stat().st_size > 1000
    return json.loads(out.with_suffix(".json").read_text())
