"""The picture of peers: its minutes are those of the page, and no method is left out."""

import json

import numpy as np
import pytest

from scripts import peers_picture
from scripts.pages import values

NAMES = ("peers", "bf16")
TABLES = values.RESULTS.parent / "tables.yaml"


@pytest.fixture(scope="module")
def results():
    """Numbers of the peers, and ours."""
    peers, ours = (json.loads((values.RESULTS / f"{name}.json").read_text()) for name in NAMES)
    return peers["h100"], ours["tasks"]


def test_minutes_are_the_first_seconds_and_the_other_decisions_of_all_learners(results):
    clocks = results[0]["clocks"]
    ten, peer = clocks["ten of hybrid_stochastic"], clocks["CrossQ"]
    at = np.array([1000.0, 50_000.0])
    expected = ten["first_s"] / 60 + 10 * at / ten["rate"] / 60
    np.testing.assert_allclose(peers_picture.minutes(ten, at), expected)
    assert peers_picture.minutes(peer, at)[0] == pytest.approx(peer["first_s"] / 60)
    rule = next(line for line in TABLES.read_text().splitlines() if "    to 50,000: '(" in line)
    text = rule.partition("'")[2].rstrip("'").replace("{label}", "CrossQ")
    assert values.evaluated(text)[0] == pytest.approx(peers_picture.minutes(peer, at)[1])


def test_every_method_is_in_each_of_its_panels(results):
    peers, ours = results
    grid = peers_picture.draw(peers, ours).axes
    for robot, panels in zip(peers_picture.ROBOTS, (grid[:2], grid[2:]), strict=True):
        methods = {"hybrid_stochastic": ours[robot], **peers[robot]}
        del methods["env"]
        for method, returns in methods.items():
            name = peers_picture.SHOWN[method][0]
            for axes in panels[: 1 if method in peers_picture.UNCLOCKED else 2]:
                (line,) = [one for one in axes.lines if one.get_label() == name]
                last = max(int(step) for step in returns if step.isdigit())
                low, high = min(returns[str(last)]), max(returns[str(last)])
                assert low < np.asarray(line.get_ydata())[-1] < high
