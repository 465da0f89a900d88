"""The first minute."""

import pytest
from tiny import call_command, refusal

from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.tools import demo


def test_it_shows_a_robot_and_what_to_type_next(tmp_path, monkeypatch, capsys, can_draw):
    """A video, or without graphics the reason and what to install."""
    monkeypatch.setattr(demo, "SHOWN", 3)
    out = tmp_path / "robot.mp4"
    words = ["policy=pendulum", f"out={out}", "window=false"]
    assert call_command(demo.main, *words) == 0
    printed = capsys.readouterr().out
    assert "trained policies: ant, cartpole" in printed
    assert "pendulum: 3 decisions, return" in printed
    assert out.exists() == can_draw
    assert can_draw or "no video: " in printed
    assert "python -m hybrid_rl.train task=pendulum" in printed


def test_without_graphics_it_says_so(tmp_path, monkeypatch):
    def none():
        raise offscreen.NoGraphicsError("nothing draws")

    monkeypatch.setattr(demo, "SHOWN", 3)
    monkeypatch.setattr(offscreen, "backend", none)
    line = demo.film("pendulum", tmp_path / "a.mp4")
    assert line.endswith("no video: nothing draws")


def test_a_window_needs_a_display_and_viser(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(demo.sys, "platform", "linux")
    monkeypatch.setattr(demo, "find_spec", lambda name: name)
    assert not demo.windowed("auto")
    monkeypatch.setenv("DISPLAY", ":0")
    assert demo.windowed("auto")
    assert not demo.windowed("false")
    monkeypatch.setattr(demo, "find_spec", lambda name: None)
    assert not demo.windowed("auto")


@pytest.mark.parametrize(
    ("words", "line"),
    [
        ("window=perhaps", "window=perhaps: choose one of auto, true, false"),
        ("policy=none window=false", "policy=none: "),
        ("out=a.txt window=false", "out=a.txt: must end in"),
    ],
)
def test_what_does_not_fit_is_one_line(words, line, capfd):
    assert line in refusal(capfd, *words.split(), of=demo.main)
