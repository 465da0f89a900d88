"""The study of contact maps: measures by hand, and both views of small runs."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from studied import drawn

from hybrid_rl.envs.analytic.contact_plane import ContactPlane
from hybrid_rl.thesis.studies import contact_maps_picture, contact_poses, contacts, false_contacts

pytestmark = pytest.mark.xdist_group("contact_runs")  # their fixture is expensive

WORLD = ContactPlane(objects=((0.3, 0.5, 0, 0.1, 0.1, 0.1), (0.75, 0.5, 0, 0.1, 0.1, 0.1)))

NO_RUN: Any = None


def test_measures_of_a_path_around_one_of_two_discs() -> None:
    """All of its outline, none of the other's; and a map that is the truth, or half of it."""
    angle = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    s = np.array([0.3, 0.5]) + 0.13 * np.stack([np.cos(angle), np.sin(angle)], -1)
    marks, felt = [80], np.ones((1, 80))
    run: Any = SimpleNamespace(world=WORLD, s=s[None].astype(np.float32), y=felt, touch=felt)
    truth = -contacts.distances(WORLD, contacts.grid(WORLD)) + WORLD.radius
    left = np.where(np.arange(contacts.GRID)[:, None] < 64, truth, -1.0)
    ring = np.where(np.abs(truth) < 0.02, 1.0, -1.0)  # hollow: filled for `iou`
    for f, iou, raw in ((truth, 1, 1), (left, 0.5, 0.5), (ring, 1.3, 0.5)):
        measured = contacts.quality(run, f[None, None], marks)
        assert measured["objects"][0, 0] == 1
        assert measured["outline"][0, 0] == pytest.approx(0.5, abs=0.01)
        if iou <= 1:
            assert measured["iou"][0, 0] == pytest.approx(iou, abs=0.03)
            assert measured["iou_raw"][0, 0] == pytest.approx(raw, abs=0.03)
        else:
            assert measured["iou"][0, 0] > measured["iou_raw"][0, 0] + 0.2
    middles = (np.arange(10) + 0.5) / 10
    x, y = np.meshgrid(middles, middles)
    free = (np.hypot(x - 0.3, y - 0.5) > 0.13) & (np.hypot(x - 0.75, y - 0.5) > 0.13)
    cells = {tuple(np.floor(10 * at).astype(int)) for at in s}
    inside = sum(bool(free[j, i]) for i, j in cells)
    assert measured["cells"][0, 0] == pytest.approx(inside / free.sum())


def test_points_of_an_outline_are_equally_far_along_it() -> None:
    """Around a bar: the share of its straight sides is that of their lengths."""
    half, radius = (0.2, 0.04), 0.05
    world = ContactPlane(objects=((0.5, 0.5, 0.0, *half, 0.01),), radius=radius)
    points, owner = contacts._outline(world)
    away = np.abs(points - 0.5)
    straight = (away < np.array(half) - 0.01).any(1).mean()
    sides = 4 * (sum(half) - 0.02)
    assert straight == pytest.approx(sides / (sides + 2 * np.pi * (radius + 0.01)), abs=0.01)
    assert (owner == 0).all()


def test_time_to_touch_all_objects_and_mean_over_time() -> None:
    """A path that is at the first disc from the start and at the second after 2 s; or never."""
    angle = np.linspace(0, 0.6, 10)
    first = np.array([0.3, 0.5]) + 0.13 * np.stack([np.cos(angle), np.sin(angle)], -1)
    second = np.array([0.75, 0.5]) - 0.13 * np.stack([np.cos(angle), np.sin(angle)], -1)
    s = np.stack([np.concatenate([first, first, second]), np.concatenate([first] * 3)])
    run = contacts.Trials(
        "", NO_RUN, WORLD, s[:, 0], s.astype(np.float32), *[np.ones((2, 30))] * 2, {}
    )
    seconds = contacts.touched_all(run)
    assert seconds[0] == pytest.approx(2.1, abs=0.15)
    assert np.isnan(seconds[1])
    iou = np.array([[0.4, 0.8], [0.2, 0.2]])  # after 1.5 s and 3 s
    speed = contact_maps_picture.speed(run, iou, np.array([1.5, 3.0]))
    np.testing.assert_allclose(speed["mean_iou"]["each"], [(0.2 + 0.6) / 2, (0.1 + 0.2) / 2])
    assert speed["seconds_to_all"]["trials"] == 1


def test_returns_to_a_position_against_their_expected_time() -> None:
    """Ten of 100 decisions after it left are near; a disc's area, counted on the map's grid."""
    s = np.full((111, 2), 0.9, np.float32)
    s[:11] = s[50:60] = [0.2, 0.2]
    free = np.ones((contacts.GRID, contacts.GRID), bool)
    ratio = false_contacts.returned(WORLD, free, s, np.array([3]))
    assert ratio == pytest.approx(0.1 / (np.pi * contacts.CLOSE**2), rel=0.1)
    still = np.full((20, 2), 0.2, np.float32)
    assert np.isnan(false_contacts.returned(WORLD, free, still, np.array([3])))


def test_false_contacts_by_hand() -> None:
    """Two false readings of a trial, one of them where the map has an object."""
    s = np.tile(np.linspace([0.05, 0.05], [0.95, 0.05], 40)[None], (2, 1, 1)).astype(np.float32)
    y, touch = np.zeros((2, 40)), np.zeros((2, 40))
    y[0, 4] = y[0, 35] = touch[1, 7] = 1
    run = contacts.Trials("", NO_RUN, WORLD, s[:, 0], s, y, y * touch, {"world/touch": touch})
    f = np.full((2, contacts.GRID, contacts.GRID), -1.0)
    f[:, : contacts.GRID // 2] = 1.0
    got = false_contacts.measures(run, f)
    np.testing.assert_allclose(got["wrong"]["each"], [2 / 40, 1 / 40])
    np.testing.assert_array_equal(got["count"]["each"], [2, 0])
    np.testing.assert_array_equal(got["rejected"]["each"], [0.5])
    assert false_contacts.measures(run._replace(y=touch), f) == {}


def test_false_contacts_touch_nothing() -> None:
    """Of readings at the first disc only the true ones count, as for the time to touch all."""
    angle = np.linspace(0, 0.6, 10)
    s = (np.array([0.3, 0.5]) + 0.13 * np.stack([np.cos(angle), np.sin(angle)], -1))[None]
    y, touch = np.ones((1, 10)), np.zeros((1, 10))
    f = np.full((1, 1, contacts.GRID, contacts.GRID), -1.0)
    for true, objects in ((touch, 0), (y, 1)):
        run = contacts.Trials("", NO_RUN, WORLD, s[:, 0], s.astype(np.float32), y, true, {})
        assert contacts.quality(run, f, [10])["objects"][0, 0] == objects
        assert np.isnan(contacts.touched_all(run)[0])


def test_a_pose_is_found_where_it_stays_good() -> None:
    """A good pose that is lost again does not count."""
    position = np.array([[0.5, 0.01, 0.5, 0.02, 0.01], [0.5] * 5, [0.01] * 5])
    angle = np.array([[0.01] * 5, [0.01] * 5, [0.01, 0.2, 0.01, 0.01, 0.01]])
    good = contacts.good(position, angle)
    np.testing.assert_array_equal(contacts.found(good), [4, np.inf, 3])
    np.testing.assert_array_equal(contacts.first(good), [2, np.inf, 1])


def test_a_robot_is_stuck_in_one_cell() -> None:
    """The last 10 s of 20: at rest; half of them; fewer; a line through all cells."""
    rest, line = np.full((200, 2), 0.55), np.linspace([0, 0.55], [2, 0.55], 200)
    half = np.concatenate([line[:100], rest[:50], line[100:150]])
    fewer = np.concatenate([line[:100], rest[:49], line[100:151]])
    s = np.stack([rest, half, fewer, line])
    np.testing.assert_array_equal(contacts.stuck(s, 0.1), [True, True, False, False])


def test_the_sign_test_leaves_ties_out() -> None:
    """P(0 or 5 of 5 coins) = 2 / 32; never is later than any time, and equal to never."""
    one = np.array([1.0, 2, 3, 4, 5, np.inf, 7])
    other = np.array([2.0, 3, 4, 5, np.inf, np.inf, 7])
    assert contacts.sign_test(one, other) == {"sooner": 5, "later": 0, "p": pytest.approx(2 / 32)}
    assert contacts.sign_test(other, other)["p"] == 1


@pytest.mark.parametrize("copies", [1, 3])
def test_the_entropy_of_poses_is_that_of_their_density(copies) -> None:
    """A Gaussian around the angle pi, of 400 particles, and of 134 in three copies."""
    rng, std = np.random.default_rng(0), np.array([0.02, 0.05, 0.1])
    theta = [0.5, 0.5, np.pi] + std * rng.normal(size=(402 // copies, 3))
    theta[:, 2] = (theta[:, 2] + np.pi) % (2 * np.pi) - np.pi
    wanted = 1.5 * np.log(2 * np.pi * np.e) + np.log(std).sum()
    assert contact_poses.entropy_of(np.repeat(theta, copies, 0)) == pytest.approx(wanted, abs=0.3)


def test_maps_of_a_small_run_and_a_map_file(contact_runs: dict[str, Path], tmp_path: Path) -> None:
    """Numbers at each time for both trials, and a map file."""
    line = ("view=map", f"runs={contact_runs['map']}", "times=0.5,1.2")
    numbers = drawn(tmp_path / "map.png", "contact_maps", *line, f"map_out={tmp_path}/m.npz")
    (one,) = numbers["methods"].values()
    assert numbers["times"][-1] == pytest.approx(1.2)
    assert one["trials"] == 2
    assert 0 < one["cells"]["iqm"][-1] < 0.2
    with np.load(tmp_path / "m.npz") as file:
        assert file["f"].shape == (contacts.GRID, contacts.GRID)


def test_poses_of_a_small_run(contact_runs: dict[str, Path], tmp_path: Path) -> None:
    """Errors of both trials."""
    run = f"runs={contact_runs['pose']}"
    numbers = drawn(tmp_path / "pose.png", "contact_maps", "view=pose", run)
    (one,) = numbers["methods"].values()
    assert all(0 < error < 1.5 for error in one["position"]["median"])
    assert one["first"]["never"] + sum(each is not None for each in one["first"]["each"]) == 2
    assert len(one["truth_behind"]["each"]) == 2
    numbers = drawn(tmp_path / "absence.png", "contact_maps", "view=absence", run)
    assert [len(one["each"]) for one in numbers["kinds"].values()] == [2, 2, 2]
