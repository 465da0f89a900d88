"""Learning curves: panels, lines and notes, and their numbers."""

import csv
import itertools
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from tiny import call_command

from hybrid_rl import figures
from hybrid_rl.analysis import tables
from hybrid_rl.analysis.curves import Curve, iqm
from hybrid_rl.analysis.learning_curves import (
    ACROSS,
    DOWN,
    figure,
    from_numbers,
    in_characters,
    plot,
    summary,
    to_numbers,
)
from hybrid_rl.analysis.style import BLUE, GREEN
from hybrid_rl.errors import UsageError
from hybrid_rl.figures import save


def curve(task="hopper", label="sac", seeds=3, scale=1.0, points=50, metric="train/return"):
    x = np.linspace(1000, 200_000, points)
    each = scale * (1 + np.arange(seeds))[:, None] * np.linspace(0, 1000, points)
    names = tuple(f"runs/{seed}" for seed in range(seeds))
    ends = each.min(0), each.max(0)
    return Curve(task, metric, label, tuple(range(seeds)), names, x, each, iqm(each), *ends, ())


def numbers_of(drawn, metric="train/return", x="step"):
    return {"metric": metric, "x": x, "curves": [to_numbers(one) for one in drawn]}


def test_a_panel_per_task_and_a_line_per_label_of_one_colour():
    drawn = [curve("ant", "sac", 1), curve("hopper", "nn_mppi", 5), curve("hopper", "sac", 3)]
    axes = plot(drawn).axes
    assert [panel.get_title() for panel in axes] == ["ant", "hopper"]
    labels = [[text.get_text() for text in panel.get_legend().get_texts()] for panel in axes]
    assert labels == [["sac (1 seed)"], ["nn_mppi (5 seeds)", "sac (3 seeds)"]]
    assert [line.get_color() for line in axes[1].lines] == [GREEN, BLUE]
    assert axes[0].lines[0].get_color() == axes[1].lines[1].get_color()
    assert [len(panel.collections) for panel in axes] == [0, 2]  # one seed has no band
    np.testing.assert_array_equal(axes[1].lines[1].get_ydata(), drawn[2].iqm)


def test_labels_carry_units_and_thousands():
    figure = plot([curve(scale=-1)])
    figure.canvas.draw()
    (panel,) = figure.axes
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("Decisions", "Training return")
    assert "200,000" in [text.get_text() for text in panel.get_xticklabels()]
    assert "\N{MINUS SIGN}1,600" in [text.get_text() for text in panel.get_yticklabels()]
    (panel,) = plot([curve(metric="sac/alpha")], x="wall_s").axes
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("Wall time [h]", "sac/alpha")
    assert panel.lines[0].get_xdata()[-1] == pytest.approx(200_000 / 3600)


@pytest.mark.parametrize(("tasks", "labels"), [(1, 1), (1, 9), (3, 4)])
def test_legends_and_notes_cover_no_axes(tasks, labels):
    """By their boxes in the rendered picture; and all are inside the picture."""
    drawn = []
    for task, i in itertools.product([f"task{i}" for i in range(tasks)], range(labels)):
        one = curve(task, f"a_method_with_a_long_name_{i}")
        drawn.append(replace(one, notes=(f"{task}, {i}: " + 30 * "word ",)))
    figure = plot(drawn)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    panels = [panel.get_window_extent() for panel in figure.axes]
    own = [panel.get_legend() for panel in figure.axes]
    legends = [one.get_window_extent(renderer) for one in [*own, *figure.legends] if one]
    assert len(legends) == tasks
    note = figure._supxlabel.get_window_extent(renderer)
    for box in [*legends, note]:
        assert not any(box.overlaps(panel.padded(-0.5)) for panel in panels)
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1
    assert not any(note.overlaps(legend) for legend in legends)
    labels_of_x = [panel.xaxis.label.get_window_extent(renderer) for panel in figure.axes]
    assert not any(box.overlaps(other) for box in labels_of_x for other in legends)


def test_notes_are_on_the_picture():
    """Those that name their line; what ran where is in the JSON. Beyond eight, their number."""
    notes = ("hopper, sac: seed 3 diverged", "one core of a server")
    (text,) = [plot([replace(curve(), notes=notes)])._supxlabel.get_text()]
    assert text == "hopper, sac: seed 3 diverged"
    many = replace(curve(), notes=tuple(f"hopper, sac: note {i}" for i in range(20)))
    lines = plot([many])._supxlabel.get_text().splitlines()
    assert lines[-1] == "and 12 more notes, in the JSON next to this picture"


def test_a_line_is_thin_where_seeds_are_missing():
    """The thick line and the band end with the last point that all seeds have."""
    one = curve(points=5)
    one.each[2, 3:] = np.nan
    thick, thin = plot([one]).axes[0].lines
    np.testing.assert_array_equal(np.isfinite(thick.get_ydata()), [True] * 3 + [False] * 2)
    np.testing.assert_array_equal(np.isfinite(thin.get_ydata()), [False] * 2 + [True] * 3)
    assert thin.get_linewidth() < thick.get_linewidth()


def test_a_picture_is_redrawn_from_its_numbers(tmp_path):
    """The same curves and picture."""
    one = curve()
    one.each[2, -1] = np.nan
    drawn = [replace(one, notes=("a note",)), curve(metric="sac/alpha")]
    source = tmp_path / "a.json"
    save(plot(drawn), numbers_of(drawn, "train/return,sac/alpha"), tmp_path / "a.png")
    again = from_numbers(figure(source)[1])
    for name in ("label", "metric", "seeds", "notes"):
        assert [getattr(c, name) for c in again] == [getattr(c, name) for c in drawn]
    for name in ("x", "each", "iqm", "low", "high"):
        for old, new in zip(drawn, again, strict=True):
            np.testing.assert_allclose(getattr(new, name), getattr(old, name), rtol=1e-6)
    first, second = (
        call_command(figures.main, f"{key}={source}", f"out={tmp_path / name}.svg")
        for key, name in (("runs", "a"), ("from", "b"))
    )
    assert (first, second) == (0, 0)
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


def test_the_summary_compares_methods():
    """Up to the last point that all seeds have; then the notes."""
    one, two = curve(label="a", points=5), replace(curve(label="b", scale=2.5), notes=("a note",))
    one.each[2, -1] = np.nan
    lines = summary(numbers_of([one, two]))
    assert lines[0].startswith("hopper, a: 3 seeds, last train/return 1,500 [")
    assert " at 150,250, mean over the run " in lines[0]
    assert lines[2].startswith("hopper, train/return: a ahead of b in 11%")  # of seeds 2 and 0
    assert lines[2].endswith("by the mean between 1,000 and 150,250")
    few = "note: with 4 seeds or fewer an interval is their range, and not a 95% one"
    assert lines[3:] == [few, "note: a note"]
    assert all(len(summary(numbers_of([curve(seeds=n)]))) == 1 for n in (1, 5))


def test_a_table_has_a_row_for_each_value_of_each_seed(tmp_path, capsys):
    """Read by Python's own parser; the columns are those of SimbaV2's published curves."""
    one = curve(points=3, metric="eval/return")
    one.each[2, 1] = np.nan
    drawn = [one, curve("ant", "hybrid, long", seeds=1, points=3)]
    save(plot(drawn), numbers_of(drawn, "eval/return"), tmp_path / "a.png")
    arguments = f"runs={tmp_path / 'a.json'}", f"out={tmp_path / 'a.csv'}"
    assert call_command(figures.main, *arguments) == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(tmp_path / "a.csv")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.json", "a.png"]
    with (tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["exp_name", "env_name", "seed", "metric", "env_step", "value"]
    read = {
        (r["exp_name"], r["env_name"], r["metric"], int(r["seed"]), int(r["env_step"])): r
        for r in rows
    }
    assert len(read) == len(rows) == 8 + 3
    assert float(read["sac", "hopper", "avg_return", 2, 200_000]["value"]) == 3000
    assert float(read["hybrid, long", "ant", "train/return", 0, 100_500]["value"]) == 500
    assert ("sac", "hopper", "avg_return", 2, 100_500) not in read


def test_a_table_of_others_is_drawn_beside_the_runs(tmp_path, monkeypatch):
    """What was written is read back, also where a seed lacks a value."""
    ours, theirs = curve(points=3, metric="eval/return"), curve(points=4, metric="eval/return")
    theirs.each[2, 1] = np.nan
    (tmp_path / "sb3.csv").write_text(tables.text([theirs], "step"))
    monkeypatch.setattr("hybrid_rl.analysis.learning_curves.curves", lambda *given: [ours])
    given = {"runs": "a", "metric": "eval/return", "others": str(tmp_path / "sb3.csv")}
    first, got = from_numbers(figure(**given)[1])
    assert (first.label, got.label, got.seeds) == ("sac", "sac (sb3.csv)", (0, 1, 2))
    np.testing.assert_array_equal(got.x, np.float32(theirs.x))
    np.testing.assert_array_equal(got.each[:2], np.float32(theirs.each[:2]))
    with pytest.raises(UsageError, match="must have the columns exp_name, env_name, seed, metric"):
        figure(**given | {"others": __file__})
    ours = curve("ant", metric="eval/return")
    with pytest.raises(UsageError, match="env_name of ant, and of no other task"):
        figure(**given)


def columns(text):
    """The row of the star in each column, from 0 at the bottom."""
    rows = [line.partition("|")[2].ljust(ACROSS) for line in text.splitlines() if "|" in line]
    assert len(rows) == DOWN
    stars = np.array([[mark == "*" for mark in row] for row in reversed(rows)])
    assert (stars.sum(0) == 1).all()
    return stars.argmax(0)


def test_each_column_has_one_star_at_the_height_of_the_line():
    x, y = [100, 300, 600], [-10.0, 1230.0, 610.0]
    text = in_characters(x, y, "Return", "decisions")
    rows = columns(text)
    assert (rows[0], rows.max(), rows[-1]) == (0, DOWN - 1, (DOWN - 1) // 2)
    top = round((ACROSS - 1) * 200 / 500)
    assert (np.diff(rows[: top + 1]) >= 0).all()
    assert (np.diff(rows[top + 1 :]) <= 0).all()
    lines = text.splitlines()
    assert lines[0] == "Return"
    assert lines[1].startswith("1,230 |")
    assert lines[DOWN].startswith("  -10 |")
    assert lines[-1].split() == ["100", "600", "decisions"]
    assert text.isascii()


def test_limits_that_lie_close_together_have_more_digits():
    lines = in_characters([1, 2], [-1.62, -1.48], "", "").splitlines()
    assert (lines[1].split()[0], lines[DOWN].split()[0]) == ("-1.48", "-1.62")


def test_a_constant_is_a_line_at_the_bottom():
    assert (columns(in_characters([1, 2], [5.0, 5.0], "", "")) == 0).all()


def test_several_metrics_are_rows_without_a_blank():
    """One column per task; if a task lacks a metric, no panel is empty."""
    metrics = ("train/return", "planner/mode_insertion_gradient")
    drawn = [curve(task, metric=metric) for metric in metrics for task in ("ant", "hopper")]
    axes = plot(drawn).axes
    assert [panel.get_title() for panel in axes] == ["ant", "hopper", "ant", "hopper"]
    assert axes[3].get_ylabel() == "Mode insertion gradient"
    assert [panel.get_subplotspec().rowspan.start for panel in axes] == [0, 0, 1, 1]
    axes = plot(drawn[:3]).axes
    assert len(axes) == axes[0].get_subplotspec().get_gridspec().ncols == 3
    assert all(panel.lines for panel in axes)
