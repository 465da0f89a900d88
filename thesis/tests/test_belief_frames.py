"""The belief at each time of an episode, learned again from the record, and its pictures."""

import json
from pathlib import Path
from typing import Any

import imageio.v3 as iio
import jax
import numpy as np
import pytest
from matplotlib.figure import Figure
from tiny import call, only_line

from hybrid_rl import figures, render
from hybrid_rl.cli import command
from hybrid_rl.envs.analytic.contact_plane import THREE
from hybrid_rl.run.saved import restore
from hybrid_rl.thesis.studies import belief_frames, belief_video, contacts
from hybrid_rl.thesis.studies.belief_panel import Panel, View, level
from hybrid_rl.thesis.studies.recorded import read

pytestmark = pytest.mark.xdist_group("contact_runs")  # their fixture is expensive

STEPS, SEED = 12, 1
Runs = dict[str, Path]


@pytest.mark.parametrize("name", ["map", "pose"])
def test_the_last_belief_is_that_of_the_checkpoint(contact_runs: Runs, name: str) -> None:
    """Of the second learner, in several parts."""
    recorded = read(contact_runs[name])
    trial = belief_frames.trial_of(recorded, SEED)
    learned = restore(contact_runs[name], recorded.run)[1].learners["belief"]
    kept = jax.tree.map(lambda a: a[SEED], learned)
    *_, last = belief_frames.beliefs(trial, [0, 5, STEPS])
    jax.tree.map(lambda a, b: np.testing.assert_allclose(a, b, atol=1e-5), last, kept)


def test_the_scene_and_the_outline_are_those_of_the_record(contact_runs: Runs) -> None:
    """theta of the log, positions of the memory; the disc is where theta moved it."""
    recorded = read(contact_runs["pose"])
    trial = belief_frames.trial_of(recorded, SEED)
    (run,) = contacts.trials(str(contact_runs["pose"]))
    theta = [run.rows[f"world/pose_{axis}"][SEED, 0] for axis in ("x", "y", "angle")]
    qpos, apart = belief_frames.scenes(trial)
    np.testing.assert_allclose(qpos[:, :3], np.tile(theta, (STEPS + 1, 1)), atol=1e-6)
    np.testing.assert_array_equal(qpos[1:, 3:], run.s[SEED])
    np.testing.assert_array_equal(qpos[0, 3:], run.start[SEED, :2])
    assert apart == 0
    x, y, angle = theta
    turn = np.exp(1j * angle) * complex(THREE[0][0] - 0.5, THREE[0][1] - 0.5)
    lines = belief_frames.truth(trial)
    away = [np.abs(line @ [1, 1j] - turn - complex(x, y)) for line in lines]
    assert min(np.abs(each - 0.13).max() for each in away) < 1e-3  # radii of disc and ball


def test_a_level_of_a_cone_is_a_circle() -> None:
    """First index along x; also in a box that is no square."""
    x, y = np.linspace(0, 2, 101), np.linspace(0, 1, 81)
    cone = np.hypot(x[:, None] - 1.4, y[None] - 0.5)
    (circle,) = level(cone, (0, 0), (2, 1), 0.3)
    np.testing.assert_allclose(np.hypot(*(circle - [1.4, 0.5]).T), 0.3, atol=1e-3)


def test_a_panel_shows_the_last_view_only() -> None:
    """The arrays of its artists."""
    axes: Any = Figure().add_subplot()
    panel = Panel(axes, (0, 0), (2, 1), [np.zeros((3, 2))])
    rng = np.random.default_rng(0)
    values, lines = rng.random((6, 7)), [rng.random((5, 2)) for _ in range(4)]
    panel.show(View(None, lines, rng.random((4, 2)), rng.random((3, 2))))
    view = View(values, lines[:2], rng.random((2, 2)), rng.random((1, 2)))
    panel.show(view)
    (image,) = axes.images
    np.testing.assert_array_equal(image.get_array(), values.T)
    outlines, truth = axes.collections
    assert [len(each.get_segments()) for each in (outlines, truth)] == [2, 1]
    np.testing.assert_array_equal(outlines.get_segments()[1], lines[1])
    path, contacts_ = axes.lines
    np.testing.assert_array_equal(path.get_xydata(), view.path)
    np.testing.assert_array_equal(contacts_.get_xydata(), view.contacts)
    assert (axes.get_xlim(), axes.get_ylim()) == ((0, 2), (0, 1))


def draw(*arguments: str | Path) -> int:
    """Exit code of the study."""
    line = "study=contact_maps", "view=frames"
    return call(lambda: command.run(figures.main), *line, *arguments)


def test_frames_have_the_errors_of_the_log(
    contact_runs: Runs, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """Of the mean pose; and the quality of the map that is learned without keys."""
    got = {}
    for name, run in contact_runs.items():
        line = f"runs={run}", "trial=1", "times=0.5,1.2", f"out={tmp_path}/{name}.png"
        assert draw(*line) == 0
        got[name] = json.loads((tmp_path / f"{name}.json").read_text())
    (pose,) = contacts.trials(str(contact_runs["pose"]))
    for name, errors in zip(("position", "angle"), contacts.errors(pose), strict=True):
        assert got["pose"][name] == pytest.approx(errors[SEED, [4, 11]], rel=1e-3)  # rounded
    (run,) = contacts.trials(str(contact_runs["map"]))
    measured = contacts.quality(run, contacts.decisions(run, [5, 12]), [5, 12])
    for name, values in measured.items():
        assert got["map"][name] == pytest.approx(values[SEED], rel=1e-3)
    capfd.readouterr()
    assert draw(f"runs={contact_runs['map'].parent}/*") == 2
    assert "view=frames draws one run, and 2 match" in only_line(capfd)
    assert draw(f"runs={contact_runs['map']}", "trial=2") == 2
    assert "trial=2: the run has trials 0 to 1" in only_line(capfd)


def test_pictures_are_evenly_spaced_and_the_last() -> None:
    """At most as many as asked for, but for the last; one is the last."""
    assert belief_video._marks(601, 200)[-3:] == [596, 600, 601]
    assert belief_video._marks(7, 200) == list(range(8))
    assert belief_video._marks(7, 1) == [7]


def test_render_draws_training(
    contact_runs: Runs, tmp_path: Path, capfd: pytest.CaptureFixture[str], can_draw: bool
) -> None:
    """The panel, as wide as high, changes with time; an unknown learner is one line."""
    if not can_draw:
        return
    line = f"run={contact_runs['map']}", "mode=training", f"out={tmp_path}/a.gif"
    main = lambda: command.run(render.main)  # noqa: E731
    assert call(main, *line, "width=64", "height=48", "episode_steps=3") == 0
    pictures = iio.imread(tmp_path / "a.gif")
    assert pictures.shape == (4, 48, 64 + 48, 3)
    assert (pictures[0, :, 64:] != pictures[3, :, 64:]).any()
    assert capfd.readouterr().out.endswith("of training, 0.74 times real time\n")
    assert call(main, *line, "seed=7") == 2
    assert "seed=7: the run has 0, 1" in only_line(capfd)
