"""Runs that take seconds, and commands called in this process; equal runs share their programs."""

import hashlib
import json
import resource
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hydra.utils import instantiate
from omegaconf import DictConfig
from programs import shared

from hybrid_rl import train
from hybrid_rl.cli import command, hydra_line
from hybrid_rl.data.demonstrations import save
from hybrid_rl.settings import build as config
from hybrid_rl.settings.groups import search_path
from hybrid_rl.types import Transition

CONF = search_path(Path(__file__).parent / "conf")
TINY = [CONF, "settings=tiny"]  # YAML, since that may set what a method does not use
SMALL = [CONF, "settings=small"]


def run(folder: Path, *overrides: str) -> dict:
    """The summary of a tiny run into `folder`, as a notebook makes it."""
    with shared():
        return train.train(config.load([*TINY, f"run_dir={folder}", *overrides]))


def finished(*overrides: str) -> Any:
    """The fixture of a module: the folder of a tiny run that is done."""

    @pytest.fixture(scope="module")
    def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
        folder = tmp_path_factory.mktemp("finished") / "run"
        run(folder, *overrides)
        return folder

    return folder


def demonstrate(folder: Path, given: DictConfig, episodes: int = 10) -> str:
    """The override that names a file of random decisions, for the task of a configuration."""
    spec, rng = instantiate(given.env, _convert_="all").spec, np.random.default_rng(0)
    count = 4 * episodes
    obs, after = rng.normal(size=(2, count, spec.obs))
    flags = np.zeros((2, count))
    rows = Transition(obs, rng.uniform(-1, 1, (count, spec.act)), obs[:, 0], *flags, after)
    file, dt = folder / f"{given.task}.npz", spec.dt * given.episode.action_repeat
    save(file, given.task, dt, rows, np.arange(count) // 4)
    return f"demonstrations={file}"


def call(main: Callable[[], None], *arguments: str | Path) -> int:
    """Exit code of a command."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["hybrid_rl", *map(str, arguments)])
        try:
            main()
        except SystemExit as end:
            return end.code
    return 0


def call_command(main: Callable[[], None], *arguments: str | Path) -> int:
    """Exit code of a command that reports what goes wrong, as in a process of its own."""
    return call(lambda: command.run(main), *arguments)


def call_train(*arguments: str | Path) -> int:
    """Exit code of `python -m hybrid_rl.train`."""
    with shared():
        return call(lambda: hydra_line.main(train._job), *arguments)


def rows_of(folder: Path) -> list[dict]:
    """The rows of metrics.jsonl of a run."""
    return [json.loads(line) for line in (folder / "metrics.jsonl").read_text().splitlines()]


@contextmanager
def limited(size: int) -> Iterator[None]:
    """The system refuses to write files beyond as many bytes."""
    heard = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, most[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, most)
        signal.signal(signal.SIGXFSZ, heard)


def write_run(
    folder: Path, settings: str, metrics: dict[str, dict], first: int = 0, **summary: Any
) -> Path:
    """A run folder; settings: its YAML; metrics: name -> step -> values of the seeds from first."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = [
        {"step": step, "seed": seed, "wall_s": step / 10, name: value}
        for name, values in metrics.items()
        for step, each in values.items()
        for seed, value in enumerate(each, first)
    ]
    (folder / "metrics.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    (folder / "config.yaml").write_text(settings)
    if summary:
        (folder / "summary.json").write_text(json.dumps(summary))
    return folder


def summary_of(folder: Path) -> dict:
    """What summary.json of a run holds."""
    return json.loads((folder / "summary.json").read_text())


def contents(folder: Path) -> dict[str, str]:
    """Every file below `folder` -> its digest, and every folder."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        if path.is_file()
        else ""
        for path in sorted(folder.rglob("*"))
    }


def only_line(capfd: pytest.CaptureFixture[str]) -> str:
    """What a command wrote to stderr, which is one line of ours."""
    line = capfd.readouterr().err
    assert line.startswith("hybrid_rl: ")
    assert line.count("\n") == 1
    return line


def refusal(
    capfd: pytest.CaptureFixture[str],
    *arguments: str | Path,
    of: Callable[[], None] | None = None,
    code: int = 2,
) -> str:
    """The one line with which a command, train if none is given, ends with this exit code."""
    ended = call_train(*arguments) if of is None else call_command(of, *arguments)
    assert ended == code
    return only_line(capfd)
