"""The figures command: a picture, its numbers, and clear refusals."""

import json
import sys

import imageio.v3 as iio
import numpy as np
import pytest

from hybrid_rl import command, figures
from hybrid_rl.curves import Curve, iqm
from hybrid_rl.figures import COLOURS, plot, save


def curve(task="hopper", label="sac", seeds=3, scale=1.0, points=50, metric="train/return"):
    x = np.linspace(1000, 200_000, points)
    each = scale * (1 + np.arange(seeds))[:, None] * np.linspace(0, 1000, points)
    names = tuple(f"runs/{seed}" for seed in range(seeds))
    ends = each.min(0), each.max(0)
    return Curve(task, metric, label, tuple(range(seeds)), names, x, each, iqm(each), *ends, ())


def runs(folder):
    for algo in ("nn_mppi", "sac"):
        for seed in range(2):
            place = folder / algo / str(seed)
            place.mkdir(parents=True)
            (place / "config.yaml").write_text(f"task: hopper\nalgo: {algo}\n")
            rows = [
                {"step": step, "seed": seed, "wall_s": step, "train/return": float(seed + step)}
                for step in range(100, 1100, 100)
            ]
            (place / "metrics.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    return folder


def call(monkeypatch, *arguments):
    """Exit code of the command."""
    monkeypatch.setattr(sys, "argv", ["figures", *map(str, arguments)])
    try:
        command.guarded(figures.main)
    except SystemExit as end:
        return end.code
    return 0


def test_a_panel_a_task_and_a_line_a_label_of_one_colour():
    drawn = [curve("ant", "sac", 1), curve("hopper", "nn_mppi", 5), curve("hopper", "sac", 3)]
    axes = plot(drawn).axes
    assert [panel.get_title() for panel in axes] == ["ant", "hopper"]
    said = [[text.get_text() for text in panel.get_legend().get_texts()] for panel in axes]
    assert said == [["sac (1 seed)"], ["nn_mppi (5 seeds)", "sac (3 seeds)"]]
    assert [line.get_color() for line in axes[1].lines] == list(COLOURS[:2])
    assert axes[0].lines[0].get_color() == axes[1].lines[1].get_color()
    assert [len(panel.collections) for panel in axes] == [0, 2]  # one seed has no band
    np.testing.assert_array_equal(axes[1].lines[1].get_ydata(), drawn[2].iqm)


def test_labels_carry_units_and_thousands():
    figure = plot([curve(scale=-1)])
    figure.canvas.draw()
    (panel,) = figure.axes
    assert (panel.get_xlabel(), panel.get_ylabel()) == (
        "Environment steps per learner",
        "Training return",
    )
    assert "200,000" in [text.get_text() for text in panel.get_xticklabels()]
    assert "\N{MINUS SIGN}1,600" in [text.get_text() for text in panel.get_yticklabels()]
    (panel,) = plot([curve(metric="sac/alpha")], x="wall_s").axes
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("Wall time [h]", "sac/alpha")
    assert panel.lines[0].get_xdata()[-1] == pytest.approx(200_000 / 3600)


def test_several_metrics_are_rows():
    """One column a task; a task without a metric leaves its place empty."""
    drawn = [
        curve("ant"),
        curve("hopper"),
        curve("hopper", metric="planner/mode_insertion_gradient"),
    ]
    axes = plot(drawn).axes
    assert len(axes) == 4
    assert [panel.get_title() for panel in axes] == ["ant", "hopper", "", "hopper"]
    assert axes[3].get_ylabel() == "Mode insertion gradient"
    assert not axes[2].axison


def test_more_lines_than_colours_stay_apart():
    drawn = [curve(label=f"algo{i:02}") for i in range(2 * len(COLOURS) + 1)]
    lines = plot(drawn).axes[0].lines
    assert len({(line.get_color(), line.get_linestyle()) for line in lines}) == len(drawn)


def test_a_single_point_is_visible():
    (panel,) = plot([curve(points=1)]).axes
    assert panel.lines[0].get_marker() == "o"


def test_the_numbers_lie_beside_the_picture(tmp_path):
    drawn = [curve(seeds=5)]
    out = save(plot(drawn), drawn, tmp_path / "new" / "a.png", metric="train/return")
    numbers = json.loads((tmp_path / "new" / "a.json").read_text())
    assert numbers["metric"] == "train/return"
    (said,) = numbers["curves"]
    assert (said["task"], said["label"], said["seeds"]) == ("hopper", "sac", [0, 1, 2, 3, 4])
    np.testing.assert_allclose(said["iqm"], drawn[0].iqm, rtol=1e-6)
    picture = iio.imread(out)
    assert picture.shape[:2] == (660, 880)
    blue = np.abs(picture[..., :3].astype(int) - [0x00, 0x72, 0xB2]).max(-1) < 8
    assert blue.sum() > 1000  # the line was drawn


@pytest.mark.parametrize(
    ("suffix", "magic"), [("pdf", b"%PDF"), ("svg", b"<?xml"), ("png", b"\x89PNG")]
)
def test_formats_go_by_suffix_and_are_reproducible(tmp_path, suffix, magic):
    first, second = [
        save(plot([curve()]), [curve()], tmp_path / f"{i}.{suffix}").read_bytes() for i in range(2)
    ]
    assert first.startswith(magic)
    assert first == second


def test_the_command_draws_and_tells(tmp_path, monkeypatch, capsys):
    folder = runs(tmp_path / "runs")
    out = tmp_path / "a.svg"
    assert call(monkeypatch, f"runs={folder}/*/*", f"out={out}") == 0
    said = capsys.readouterr().out
    assert "hopper, nn_mppi: 2 seeds, last train/return 1,000 [1,000, 1,001]" in said
    assert "hopper, train/return: nn_mppi ahead of sac in 50% [0%, 100%] of pairs" in said
    assert "sac (2 seeds)" in out.read_text()
    numbers = json.loads(out.with_suffix(".json").read_text())
    assert [entry["x"][-1] for entry in numbers["curves"]] == [1000, 1000]


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["runs=nowhere/*"], "runs=nowhere/*: no run there (a folder that holds metrics.jsonl)"),
        (["runs=RUNS", "metric=x/y"], "metric=x/y: not in these runs; they have train/return"),
        (["runs=RUNS", "x=hours"], "x=hours: must be step, wall_s, or a number"),
        (["runs=RUNS", "out=a.jpg"], "out=a.jpg: must end in .png, .pdf, .svg"),
        (["runs=RUNS", "smooth=much"], "smooth=much: must be a number"),
        (["runs=RUNS", "threshold=high"], "threshold=high: must be a number in the metric's unit"),
        (["runs=RUNS", "colour=red"], "colour=red: unknown argument"),
        ([], "runs: not given"),
    ],
)
def test_bad_usage_is_one_line_and_code_2(tmp_path, monkeypatch, capsys, arguments, line):
    folder = runs(tmp_path / "runs")
    monkeypatch.chdir(tmp_path)
    given = [text.replace("RUNS", str(folder)) for text in arguments]
    assert call(monkeypatch, *given) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert line in said.err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["runs"]
