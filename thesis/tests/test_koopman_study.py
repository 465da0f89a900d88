"""The study of Koopman operators: falls, tracking and embeddings."""

import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from studied import code, drawn, trained
from tiny import write_run

from hybrid_rl.analysis import drawing
from hybrid_rl.analysis.results import RunFolder
from hybrid_rl.envs.analytic.quadcopter_se3 import DT
from hybrid_rl.thesis.studies import (
    embeddings,
    fall_frames,
    falls,
    falls_picture,
    koopman,
    tracking,
)
from hybrid_rl.thesis.studies.falls import Fall
from hybrid_rl.thesis.studies.tracking import Track

SHORT = [
    "experiment=thesis/fig_7_2",
    "env.terminate=false",
    *(f"{name}=200" for name in ("total_steps", "episode.steps", "eval_every", "checkpoint_every")),
    "num_seeds=2",
    "log_every=100",
]


def test_settled_is_the_start_of_the_last_stretch_below() -> None:
    error = np.array(
        [
            [1, 0, 1, 0, 0],  # again above at 2
            [0, 0, 0, 0, 0],
            [0, 0, 0, 0, 1],  # never
            [1, np.nan, 0, 0, 0],
        ]
    )
    np.testing.assert_array_equal(falls.settled(error, 0.5), [3, 0, np.inf, 2])


def test_wilsons_interval_is_the_published_one() -> None:
    """Newcombe, Statistics in Medicine 17 (1998), table I, method 3: 81 of 263, 15 of 148, ..."""
    for successes, trials, right in (
        (81, 263, (0.2553, 0.3662)),
        (15, 148, (0.0624, 0.1605)),
        (0, 20, (0.0000, 0.1611)),
        (1, 29, (0.0061, 0.1718)),
    ):
        np.testing.assert_allclose(falls.wilson(successes, trials), right, atol=6e-5)


def fall(error: np.ndarray, label: str = "a", std: float = 0.0) -> Fall:
    """Trials [S, T+1] with these errors, one rotor of four at half of its control."""
    trials, length = error.shape
    obs = np.zeros((trials, length, 18))
    obs[..., 12] = np.sqrt(error)
    action = np.zeros((trials, length - 1, 4))
    action[..., 0] = 0.5
    return Fall(label, obs, action, error, std, 2e-6)


def test_numbers_of_falls_by_hand() -> None:
    """One trial of two is at rest from 1.2 s on; the greatest twist is 3."""
    error = np.full((2, 801), 0.001)
    error[0, :240] = 9.0
    error[1] = 4.0
    numbers = falls.reported(fall(error), np.ones((2, 800, 3)))
    assert numbers["at_rest"]["1.5"][0] == 0.5
    np.testing.assert_allclose(numbers["at_rest"]["4"][1:], [0.0945, 0.9055], atol=1e-4)
    assert numbers["median_time_at_rest"] == pytest.approx(1.2)
    np.testing.assert_allclose(numbers["error"]["4"], [2.0005, 0.4009, 3.6001], atol=1e-4)
    assert numbers["greatest_twist_1_s"] == [2.5, 3.0]
    assert numbers["rms_u"] == pytest.approx(3 / 2)  # of one rotor of four
    assert numbers["trace_1_s"][0] == 600
    assert numbers["microseconds_a_decision"] == pytest.approx(2)


def test_log_det_of_the_information_by_hand() -> None:
    """Two regressors along the axes: diag(4 + p, 9 + p)."""
    s = np.array([[[2.0, 0.0], [0.0, 3.0]]])
    np.testing.assert_allclose(falls.log_det(s, 1.0), np.log(5 * 10))
    np.testing.assert_allclose(falls.trace(s), [[4, 13]])


def test_logged_twist_holds_between_two_rows(tmp_path) -> None:
    """Each row is the mean of the decisions before it."""
    write_run(tmp_path, "", {"world/twist": {2: [2, 12], 4: [4, 14]}})
    right = [[2, 2, 4, 4], [12, 12, 14, 14]]
    np.testing.assert_array_equal(falls.logged(RunFolder(tmp_path), (0, 1), 4), right)


def sine(delay: float, dt: float = 1 / 30, shift: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A path [1, T, 2] that is late on a reference, and the reference."""
    t = dt * np.arange(400)

    def at(t: np.ndarray) -> np.ndarray:
        return np.stack([0.5 * np.cos(t), 0.3 * np.sin(2 * t)], 1)[None]

    return at(t - delay) + shift, at(t)


@pytest.mark.parametrize("delay", [0.0, 0.05, 0.1234, -0.08])
def test_the_lag_of_a_late_sine_is_its_delay(delay) -> None:
    """Between the decisions, too; negative where the path is early."""
    path, reference = sine(delay)
    assert tracking.lag(path[0], reference[0], 1 / 30) == pytest.approx(delay, abs=2e-4)


def test_a_path_that_never_moves_has_no_lag_and_no_correlation() -> None:
    path, reference = sine(0)
    assert np.isnan(tracking.lag(0 * path[0], reference[0], 1 / 30))
    assert np.isnan(tracking.lag(np.zeros((90, 1)), np.zeros((90, 1)), 1 / 30))
    flat = np.concatenate([reference, 0 * reference[..., :1]], -1)
    found = tracking.correlation(flat, flat)
    np.testing.assert_allclose(found[0, :2], 1)
    assert np.isnan(found[0, 2])


def test_rmse_of_a_late_sine_in_closed_form() -> None:
    """Over whole periods: amplitude sqrt(2) sin(w delay / 2); and of a shifted path."""
    t = 2 * np.pi * np.arange(200) / 200
    path, reference = np.sin(t - 0.1)[None, :, None], np.sin(t)[None, :, None]
    right = np.sqrt(2) * np.sin(0.05)
    np.testing.assert_allclose(tracking.rmse(path, reference), right)
    np.testing.assert_allclose(tracking.rmse(reference + 0.003, reference), 0.003)
    np.testing.assert_allclose(tracking.correlation(path, reference), np.cos(0.1))
    noise = np.random.default_rng(0).normal(0, 0.02, (1, 200, 1))
    noisy = tracking.rmse(path + noise, reference, 0.02)
    np.testing.assert_allclose(noisy, right, rtol=0.05)


def evaluated(folder: Path, task: str, *success: list[float]) -> None:
    """A run with evaluations of success, those of all seeds every 200 decisions."""
    rows = {200 * (i + 1): each for i, each in enumerate(success)}
    settings = f"task: {task}\nalgo: k\neval_every: 200\n"
    write_run(folder, settings, {"eval/policy_success": rows})


def test_distances_of_arms_by_hand(tmp_path, monkeypatch) -> None:
    """Two attempts of two decisions; the last one ends at the target."""
    obs = np.zeros((1, 4, 6))
    obs[0, 1] = 1, 9, 2, 9, 4, 6  # (1, 2) to (4, 6)
    made = SimpleNamespace(truncated=np.array([[0, 1, 0, 1]]), next_obs=obs)
    monkeypatch.setattr(embeddings, "read", lambda *_: SimpleNamespace(made=made))
    evaluated(tmp_path / "gain_32", "two_link", [0.0], [1.0])
    _, numbers = koopman.figure("embedding", f"{tmp_path}/gain_32")
    one = numbers["two_link"]["gain_32"]
    assert one["distance"][0] == [5, 0]
    assert one["share_within"] == [0, 1]


def test_runs_become_falls(tmp_path, monkeypatch) -> None:
    """One run under two names."""
    direct, babble = (tmp_path / "runs" / f"koopman_{name}" for name in ("direct", "babble"))
    trained(*SHORT, "algo=koopman_direct", f"run_dir={direct}")
    shutil.copytree(direct, babble)
    settings = (babble / "config.yaml").read_text()
    (babble / "config.yaml").write_text(settings.replace("koopman_direct", "koopman_babble"))
    runs = f"{tmp_path}/runs/*"
    both = falls.falls(runs)
    monkeypatch.setattr(falls_picture, "falls", lambda pattern: both)
    numbers = drawn(tmp_path / "f.png", "koopman", "view=falls", f"runs={runs}")["methods"]
    assert set(numbers) == {"koopman_direct", "koopman_babble"}
    assert both[0].seconds > 0
    means = both[0].error[:, 1:].reshape(2, 2, 100).mean(-1)
    twist = falls.logged(RunFolder(direct), (0, 1), 200)[:, ::100]
    np.testing.assert_allclose(means, twist, rtol=1e-4)
    u = 6 * both[1].action
    assert numbers["koopman_direct"]["rms_u"] == pytest.approx(np.sqrt((u**2).mean()), rel=1e-3)
    assert code("koopman", "view=initial", f"runs={runs}", f"out={tmp_path}/f.png") == 0


def test_tracks_become_numbers_and_a_picture(tmp_path, monkeypatch) -> None:
    """A late method and an exact one; numbers of each trial."""
    (late, reference), (exact, _) = sine(0.1), sine(0.0)
    action, rate = np.full((1, 400, 2), 0.5), np.array([3.0])
    tracks = {
        "late": Track("late", late, reference, action, rate, 0.0, 1 / 30),
        "exact": Track("exact", exact + 0.003, reference, action, rate, 0.0, 1 / 30),
    }
    of = SimpleNamespace(config=SimpleNamespace(task="sprk_sand"))
    monkeypatch.setattr(tracking, "find", lambda pattern: list(tracks))
    monkeypatch.setattr(tracking, "labels", lambda folders: folders)
    monkeypatch.setattr(tracking, "read", lambda folder, *tasks: of)
    monkeypatch.setattr(tracking, "of", lambda run, label: tracks[label])
    numbers = drawn(tmp_path / "f.png", "koopman", "view=tracking", "runs=any")["methods"]
    assert numbers["late"]["lag_ms"][0] == pytest.approx(100, abs=1)
    assert numbers["exact"]["rmse_mm"][0] == pytest.approx(3 * np.sqrt(2), rel=1e-3)
    assert numbers["exact"]["rms_action"][0] == 0.5


def test_carts_are_stabilised_when_all_episodes_are_whole(tmp_path) -> None:
    """Trials after 1, 3 and 3 iterations, and one never."""
    success = [1, 0, 0.8, 0], [0, 0, 0.8, 0], [1, 1, 1, 0.8]
    evaluated(tmp_path / "noise_32", "cart_pendulum", *success)
    given = ("view=embedding", f"runs={tmp_path}/*_*")
    numbers = drawn(tmp_path / "f.png", "koopman", *given)["cart_pendulum"]["noise_32"]
    assert numbers["iterations_of_trials"] == [1, 3, 3, None]
    assert numbers["iterations"] == [3, 1, 3]
    assert numbers["share_by_100"] == 0.75


def test_a_fall_is_a_strip_of_attitudes_with_heights(tmp_path, monkeypatch) -> None:
    """Two trials; the first one's heights at the times of the pictures, which differ."""
    obs = np.zeros((2, 800, 18))
    obs[:, :, 3:12] = np.eye(3).ravel()
    obs[0, :, 2] = -np.arange(800) * DT
    obs[0, 400:, 3:12] = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]).ravel()  # on its side
    fall = SimpleNamespace(label="mine", obs=obs)
    monkeypatch.setattr(fall_frames, "falls", lambda pattern: [fall])
    drawings = []

    def frames(scene, poses, width, height) -> np.ndarray:
        drawings.append(poses)
        return np.zeros((len(poses), height, width, 3), np.uint8)

    monkeypatch.setattr(drawing, "frames", frames)
    numbers = drawn(tmp_path / "f.png", "koopman", "view=frames", "runs=any")
    np.testing.assert_allclose(numbers["height"]["mine"], [-t for t in numbers["time"]], atol=0.01)
    (poses,) = drawings
    np.testing.assert_array_equal(poses[:, :3], np.broadcast_to(poses[0, :3], poses[:, :3].shape))
    assert not np.allclose(poses[0], poses[-1])
