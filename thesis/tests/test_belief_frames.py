"""The belief at each time of an episode, learned again from the record, and its pictures."""

from pathlib import Path

import imageio.v3 as iio
import jax
import numpy as np
import pytest
from studied import drawn
from tiny import call

from hybrid_rl.cli import command
from hybrid_rl.envs.analytic.contact_plane import THREE
from hybrid_rl.run.saved import restore
from hybrid_rl.thesis.studies import belief_frames, belief_video, contacts
from hybrid_rl.thesis.studies.belief_panel import level
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


def test_pictures_are_evenly_spaced_and_the_last() -> None:
    """At most as many as asked for, but for the last; one is the last."""
    assert belief_video._marks(601, 200)[-3:] == [596, 600, 601]
    assert belief_video._marks(7, 200) == list(range(8))
    assert belief_video._marks(7, 1) == [7]


def test_frames_have_the_errors_of_the_log(contact_runs: Runs, tmp_path: Path) -> None:
    """Of the mean pose; and the quality of the map that is learned without keys."""
    got = {
        name: drawn(
            tmp_path / f"{name}.png",
            *("contact_maps", "view=frames", f"runs={run}", "trial=1", "times=0.5,1.2"),
        )
        for name, run in contact_runs.items()
    }
    (pose,) = contacts.trials(str(contact_runs["pose"]))
    for name, errors in zip(("position", "angle"), contacts.errors(pose), strict=True):
        assert got["pose"][name] == pytest.approx(errors[SEED, [4, 11]], rel=1e-3)  # rounded
    (run,) = contacts.trials(str(contact_runs["map"]))
    measured = contacts.quality(run, contacts.decisions(run, [5, 12]), [5, 12])
    for name, values in measured.items():
        assert got["map"][name] == pytest.approx(values[SEED], rel=1e-3)


def test_the_film_of_training(contact_runs: Runs, tmp_path: Path, draws: None) -> None:
    """The panel, as wide as high, changes with time."""
    size = "width=64", "height=48", "episode_steps=3"
    line = f"run={contact_runs['map']}", f"out={tmp_path}/a.gif", *size
    assert call(lambda: command.run(belief_video.main), *line) == 0
    pictures = iio.imread(tmp_path / "a.gif")
    assert pictures.shape == (4, 48, 64 + 48, 3)
    assert (pictures[0, :, 64:] != pictures[3, :, 64:]).any()
