"""The figures command: a picture, its numbers, and clear refusals."""

import itertools
import json
import sys
from dataclasses import replace

import imageio.v3 as iio
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

from hybrid_rl import figures
from hybrid_rl.cli import command
from hybrid_rl.figures import save
from hybrid_rl.studies.curves import Curve, from_json, iqm
from hybrid_rl.studies.style import COLOURS, plot


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


def test_several_metrics_are_rows_without_a_blank():
    """One column a task; where a task lacks a metric the panels close up."""
    metrics = ("train/return", "planner/mode_insertion_gradient")
    drawn = [curve(task, metric=metric) for metric in metrics for task in ("ant", "hopper")]
    axes = plot(drawn).axes
    assert [panel.get_title() for panel in axes] == ["ant", "hopper", "ant", "hopper"]
    assert axes[3].get_ylabel() == "Mode insertion gradient"
    assert [panel.get_subplotspec().rowspan.start for panel in axes] == [0, 0, 1, 1]
    axes = plot(drawn[:3]).axes
    assert len(axes) == axes[0].get_subplotspec().get_gridspec().ncols == 3
    assert all(panel.lines for panel in axes)


@pytest.mark.parametrize(("tasks", "labels"), [(1, 1), (1, 9), (3, 4)])
def test_legends_and_notes_cover_no_axes(tasks, labels):
    """In the boxes that the picture has when it is drawn; and none leaves the picture."""
    names = itertools.product([f"task{i}" for i in range(tasks)], range(labels))
    drawn = [
        replace(
            curve(task, f"a_method_with_a_long_name_{i}"), notes=(f"{task}: {i} " + 30 * "word ",)
        )
        for task, i in names
    ]
    figure = plot(drawn)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    panels = [panel.get_window_extent() for panel in figure.axes]
    legends = [panel.get_legend().get_window_extent(renderer) for panel in figure.axes]
    note = figure._supxlabel.get_window_extent(renderer)
    for box in [*legends, note]:
        assert not any(box.overlaps(panel.padded(-0.5)) for panel in panels)
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1
    assert not any(note.overlaps(legend) for legend in legends)
    labels_of_x = [panel.xaxis.label.get_window_extent(renderer) for panel in figure.axes]
    assert not any(box.overlaps(other) for box in labels_of_x for other in legends)


def test_notes_are_on_the_picture():
    """Many are cut short, and say so."""
    (text,) = [plot([replace(curve(), notes=("seed 3 diverged",))])._supxlabel.get_text()]
    assert text == "seed 3 diverged"
    many = replace(curve(), notes=tuple(f"note {i}" for i in range(20)))
    lines = plot([many])._supxlabel.get_text().splitlines()
    assert lines[-1] == "and 12 more notes, in the JSON beside this picture"


def test_markers_at_the_right_edge_are_whole():
    figure = plot([curve(points=5)])
    figure.canvas.draw()
    (panel,) = figure.axes
    last = panel.transData.transform((200_000, 0))[0]
    assert panel.bbox.x1 - last > panel.lines[0].get_markersize() / 2 * figure.dpi / 72


def test_a_line_is_thin_where_seeds_are_missing():
    """The thick line and the band end with the last point that all seeds have."""
    one = curve(points=5)
    one.each[2, 3:] = np.nan
    thick, thin = plot([one]).axes[0].lines
    np.testing.assert_array_equal(np.isfinite(thick.get_ydata()), [True] * 3 + [False] * 2)
    np.testing.assert_array_equal(np.isfinite(thin.get_ydata()), [False] * 2 + [True] * 3)
    assert thin.get_linewidth() < thick.get_linewidth()


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
    assert picture.shape[1] == 880
    assert 600 < picture.shape[0] < 700
    blue = np.abs(picture[..., :3].astype(int) - [0x00, 0x72, 0xB2]).max(-1) < 8
    assert blue.sum() > 1000  # the line was drawn


def test_a_picture_is_drawn_again_from_its_numbers(tmp_path, monkeypatch, capsys):
    """The same curves; and numbers that are the source are left as they are."""
    one = curve()
    one.each[2, -1] = np.nan
    drawn = [replace(one, notes=("a note",)), curve(metric="sac/alpha")]
    save(plot(drawn), drawn, tmp_path / "a.png", metric="train/return,sac/alpha", x="step")
    before = (tmp_path / "a.json").read_bytes()
    again, about = from_json(tmp_path / "a.json")
    assert about["x"] == "step"
    assert [(c.label, c.metric, c.seeds, c.notes) for c in again] == [
        (c.label, c.metric, c.seeds, c.notes) for c in drawn
    ]
    for name in ("x", "each", "iqm", "low", "high"):
        for old, new in zip(drawn, again, strict=True):
            np.testing.assert_allclose(getattr(new, name), getattr(old, name), rtol=1e-6)
    source = f"runs={tmp_path / 'a.json'}"
    assert call(monkeypatch, source, f"out={tmp_path / 'b.png'}") == 0
    again = f"runs={tmp_path / 'b.json'}"
    assert call(monkeypatch, again, f"out={tmp_path / 'c.png'}") == 0
    assert (tmp_path / "b.png").read_bytes() == (tmp_path / "c.png").read_bytes()
    assert call(monkeypatch, source, f"out={tmp_path / 'a.png'}") == 0
    assert (tmp_path / "a.json").read_bytes() == before
    (tmp_path / "c.json").write_text("{}")
    capsys.readouterr()
    assert call(monkeypatch, f"runs={tmp_path / 'c.json'}", f"out={tmp_path / 'c.png'}") == 2
    assert "c.json: holds no curves that figures wrote" in capsys.readouterr().err


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
