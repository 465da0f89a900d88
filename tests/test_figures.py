"""The figures command: it finds studies, saves a picture and its numbers, and checks arguments."""

import json
import sys

import pytest
from matplotlib.figure import Figure
from tiny import call_command, contents, refusal, write_run

from hybrid_rl import figures

pytestmark = pytest.mark.turns(3)

TOY = '''"""Toy: a line.

    python -m hybrid_rl.figures study=toy
"""

from typing import Annotated

import numpy as np
from matplotlib.figure import Figure

from hybrid_rl.cli.arguments import whole


def figure(
    title: Annotated[str, "above the axes"],
    points: Annotated[int, "of the line", whole(2)] = 3,
):
    picture = Figure()
    picture.subplots().plot(range(points))
    y = np.linspace(0, 1, points, dtype="float32")
    return picture, {"title": title, "y": y, "lost": [float("nan"), None], "by": {1: y[1]}}


def summary(numbers):
    return [f"{numbers['title']}: {len(numbers['y'])} points"]
'''


@pytest.fixture
def toy(tmp_path, monkeypatch):
    """A study in a folder of the user's."""
    folder = tmp_path / "more"
    folder.mkdir()
    (folder / "toy.py").write_text(TOY)
    (folder / "library.py").write_text('"""No study."""\n\n\ndef line():\n    return []\n')
    monkeypatch.syspath_prepend(folder)
    yield
    for name in ("toy", "library"):
        sys.modules.pop(name, None)


def draw(*arguments):
    """Exit code of the command."""
    return call_command(figures.main, *arguments)


def runs(folder):
    for algo in ("nn_mppi", "sac"):
        line = {step: [float(step), step + 1.0] for step in range(100, 1100, 100)}
        write_run(folder / algo / "0", f"task: hopper\nalgo: {algo}\n", {"train/return": line})
    return folder


@pytest.mark.parametrize("arguments", [[], ["study=list"]])
def test_the_studies_are_listed_without_their_libraries(toy, capsys, arguments):
    assert draw(*arguments) == 0
    lines = capsys.readouterr().out.splitlines()[1:]
    names = ["active_learning", "bayesian_optimisation", "contact_maps", "ergodic_coverage"]
    names += ["held_out", "imitation", "koopman", "koopman_settings"]
    names += ["learning_curves", "model_learning", "robots"]
    assert [line.split()[0] for line in lines] == names
    assert all(line.endswith(".") for line in lines)


def test_a_study_is_one_file(toy, tmp_path, capsys):
    out = tmp_path / "a.png"
    assert draw("study=toy", "title=x", "points=5", f"out={out}") == 0
    printed = capsys.readouterr().out
    assert printed == f"x: 5 points\n{out} and {out.with_suffix('.json')}\n"
    assert out.read_bytes().startswith(b"\x89PNG")
    assert json.loads(out.with_suffix(".json").read_text()) == {
        "title": "x",
        "y": [0, 0.25, 0.5, 0.75, 1],
        "lost": [None, None],
        "by": {"1": 0.25},
    }


def test_a_study_explains_itself(toy, capsys):
    assert draw("study=toy", "--help") == 0
    printed = capsys.readouterr().out
    assert printed.startswith("Toy: a line.")
    for line in ("  study=toy ", "  title= ", "needed; above the axes", "  points=3 ", "  out="):
        assert line in printed


@pytest.mark.parametrize("name", figures.studies())
def test_every_study_has_an_example_of_its_own_command(name, capsys):
    assert draw(f"study={name}", "--help") == 0
    printed = capsys.readouterr().out
    example = "" if name == figures.DEFAULT else f"study={name} "
    assert f"    python -m hybrid_rl.figures {example}" in printed


@pytest.mark.parametrize(
    ("suffix", "magic"), [("pdf", b"%PDF"), ("svg", b"<?xml"), ("png", b"\x89PNG")]
)
def test_formats_are_reproducible(tmp_path, suffix, magic):
    files = [tmp_path / f"{name}.{suffix}" for name in "ab"]
    for file in files:
        picture = Figure()
        picture.subplots().plot([0, 1], label="a line")
        figures.save(picture, {}, file)
    first, second = (file.read_bytes() for file in files)
    assert first.startswith(magic)
    assert first == second


def test_learning_curves_are_the_default(tmp_path, capsys):
    folder, out = runs(tmp_path / "runs"), tmp_path / "a.svg"
    assert draw(f"runs={folder}/*/*", f"out={out}") == 0
    printed = capsys.readouterr().out
    assert "hopper, nn_mppi: 2 seeds, last train/return 1,000 [1,000, 1,001]" in printed
    line = "hopper, train/return: nn_mppi ahead of sac in 50% [0%, 100%] of pairs of seeds, "
    assert line + "by the mean over the run" in printed
    assert "sac (2 seeds)" in out.read_text()
    numbers = json.loads(out.with_suffix(".json").read_text())
    assert [one["x"][-1] for one in numbers["curves"]] == [1000, 1000]
    assert numbers["metric"] == "train/return"
    named = {"task": "hopper", "metric": "train/return", "label": "nn_mppi", "other": "sac"}
    assert numbers["comparisons"] == [named | {"share": 0.5, "band": [0.0, 1.0], "between": None}]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["runs=RUNS", "metric=x/y"], "metric=x/y: not in these runs; they have train/return"),
        (["runs=RUNS", "view=cost"], "give KEY=VALUE with study, out, from, runs, metric, x"),
        (["from=nowhere.json"], "from=nowhere.json: cannot be read (No such file or directory)"),
        (["from=RUNS/../numbers.json"], "numbers.json: has no numbers of this study"),
        (["study=koopmann"], "or a module of yours (did you mean koopman?)"),
        (["study=library"], "library.py has no functions figure and summary"),
        (["study=toy", "title=x", "points=1"], "points=1: must be a whole number, 2 or more"),
    ],
)
def test_bad_usage_is_one_line_and_code_2(toy, tmp_path, monkeypatch, capfd, arguments, line):
    folder = runs(tmp_path / "runs")
    (tmp_path / "numbers.json").write_text('{"view": "falls"}')
    monkeypatch.chdir(tmp_path)
    before = contents(tmp_path)
    given = (text.replace("RUNS", str(folder)) for text in arguments)
    assert line in refusal(capfd, *given, of=figures.main)
    assert contents(tmp_path) == before
