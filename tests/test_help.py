"""What --help prints, and what the arguments of a command declare."""

import re
import subprocess
import sys
from importlib import import_module
from importlib.util import find_spec

import pytest
from tiny import call_command, call_train

from hybrid_rl import __main__ as commands
from hybrid_rl.cli import arguments
from hybrid_rl.cli.arguments import Argument, number, one_of, several, whole
from hybrid_rl.errors import UsageError
from hybrid_rl.settings.build import CONF

NAMES = sorted(set(commands.commands()) - {"train"})


@pytest.mark.parametrize("flag", arguments.HELP)
@pytest.mark.parametrize("name", NAMES)
def test_every_command_explains_itself(name, flag, capsys):
    """Purpose, an example, every argument with its default."""
    package = find_spec(f"hybrid_rl.{name}").submodule_search_locations
    module = import_module(f"hybrid_rl.{name}{'.__main__' if package else ''}")
    assert call_command(module.main, flag) == 0
    printed, err = capsys.readouterr()
    assert err == ""
    assert printed.startswith(module.__doc__.splitlines()[0])
    assert f"python -m hybrid_rl.{name}" in printed
    for argument in module.ARGUMENTS:
        assert f"  {argument.name}=" in printed
        assert argument.about in printed
    assert not re.search("=(True|False) ", printed)  # typed in small letters


def test_train_shows_the_keys_that_every_run_has(capsys):
    assert call_train("--help") == 0
    printed = capsys.readouterr().out
    assert "python -m hybrid_rl.train task=pendulum" in printed
    for key in ("task=halfcheetah", "num_seeds=1 ", "total_steps=null", "resume=null", "run_dir="):
        (line,) = [each for each in printed.splitlines() if each.startswith(f"  {key}")]
        assert len(line.split()) > 3, "a key without its meaning"
    assert "  schedule=null " in printed
    assert "--cfg job" in printed
    assert len(printed.splitlines()) < 60


def test_the_package_lists_its_commands():
    whole = [sys.executable, "-m", "hybrid_rl"]
    done = subprocess.run(whole, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    for file in (CONF.parent / "hybrid_rl").glob("[a-z]*.py"):
        if "__main__" in file.read_text():
            assert f"python -m hybrid_rl.{file.stem} " in done.stdout
    done = subprocess.run([*whole, "train", "task=ant"], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert "write python -m hybrid_rl.train" in done.stderr


def read(monkeypatch, *line):
    known = (
        Argument("sizes", 3, "how many", whole(least=2, even=True)),
        Argument("parts", ["a"], "which", several("a", "b")),
        Argument("seconds", 3.0, "how long", number(0.0)),
        Argument("kind", "", "which one", one_of("", "a", "b")),
        Argument("runs", "", "where", needed="runs=GLOB"),
    )
    monkeypatch.setattr(sys, "argv", ["hybrid_rl", *line])
    return arguments.read("Doc.", known, {"env": "a key"})


def test_arguments_are_parsed_as_declared(monkeypatch):
    values, changes = read(monkeypatch, "sizes=4", "parts=b,a", "env.x=1=2", "runs=r")
    rest = {"seconds": 3.0, "kind": ""}
    assert values == {"sizes": 4, "parts": ["b", "a"], "runs": "r", **rest}
    assert changes == {"env.x": "1=2"}
    assert read(monkeypatch, "runs=r")[0] == {"sizes": 3, "parts": ["a"], "runs": "r", **rest}


WRONG = [
    ("", "runs: not given; give runs=GLOB"),
    ("sizes=5", "sizes=5: must be an even number"),
    ("parts=a,c", "parts=c: choose one of a, b"),
    ("seconds=-1", "seconds=-1: must be a number, 0 or more"),
    ("kind=c", "kind=c: choose one of a, b"),
    ("sise=3", "sise=3: unknown argument; did you mean sizes=VALUE?"),
    ("--runs r", "--runs: unknown argument; did you mean runs=VALUE?"),
    ("x", "x: unknown argument; give KEY=VALUE with sizes, parts, seconds, kind, runs, env.KEY"),
]


@pytest.mark.parametrize(("line", "words"), WRONG)
def test_what_is_no_argument_is_one_line(monkeypatch, line, words):
    with pytest.raises(UsageError) as raised:
        read(monkeypatch, *line.split())
    assert words in str(raised.value)


def test_an_output_is_probed_without_a_trace(tmp_path):
    assert arguments.output("out", tmp_path / "a.png", (".png",)) == tmp_path / "a.png"
    for bad, words in (
        ("new/a.png", r"cannot be written to \(No such file or directory\)"),
        ("a.jpg", "must end in .png"),
    ):
        with pytest.raises(UsageError, match=words):
            arguments.output("out", tmp_path / bad, (".png",))
    assert not [*tmp_path.iterdir()]
