"""Drawing without a display: pictures, videos, backends."""

import os
import subprocess
import sys
from functools import partial

import imageio.v3 as iio
import numpy as np
import pytest
from scenes import FIXED, FREE
from tiny import limited

from hybrid_rl.analysis import drawing
from hybrid_rl.envs.mujoco import offscreen


def centre(picture, channel):
    """Mean (row, column) of the pixels of one pure colour, as shares of the picture."""
    rest = [c for c in range(3) if c != channel]
    result = (picture[..., channel] > 150) & (picture[..., rest] < 90).all(-1)
    assert result.any()
    return np.argwhere(result).mean(0) / picture.shape[:2]


def positions(number=6):
    return np.linspace(-1, 1, number)[:, None]


def written(out, fps=25):
    return drawing.write(out, 6, fps, lambda at, _: drawing.frames(FIXED, positions()[at], 64, 48))


def test_pictures_show_the_positions(draws):
    pictures = list(drawing.frames(FIXED, positions(3), 64, 48))
    assert all(picture.shape == (48, 64, 3) for picture in pictures)
    red = np.array([centre(picture, 0) for picture in pictures])
    np.testing.assert_allclose(red[:, 0], 0.5, atol=0.05)
    assert (np.diff(red[:, 1]) > 0.1).all()  # to the right
    assert centre(pictures[1], 2)[0] < 0.4  # y is up


def test_without_a_camera_of_its_own_the_robot_is_followed(draws):
    near, far = drawing.frames(FREE, np.array([[0.0], [5.0]]), 64, 48)
    np.testing.assert_allclose(centre(near, 0), centre(far, 0), atol=0.05)
    assert len(list(drawing.frames("<mujoco/>", np.zeros((1, 0)), 64, 48))) == 1


def test_an_mp4_plays_everywhere(tmp_path, draws):
    out = written(tmp_path / "new" / "a.mp4", 25)
    values = iio.immeta(out, plugin="pyav")
    assert (values["codec"], values["video_format"], values["fps"]) == ("h264", "yuv420p", 25)
    film = iio.imread(out, plugin="pyav")
    assert film.shape == (6, 48, 64, 3)
    assert centre(film[5], 0)[1] > centre(film[0], 0)[1] + 0.2
    assert [path.name for path in out.parent.iterdir()] == ["a.mp4"]


def test_a_gif_goes_round_at_no_more_than_its_speed(tmp_path, draws):
    out = written(tmp_path / "a.gif", 40)
    values = iio.immeta(out)
    assert (values["duration"], values["loop"]) == (50, 0)  # [ms]: every second of 40 a second
    film = iio.imread(out)
    assert film.shape == (3, 48, 64, 3)
    assert centre(film[2], 0)[1] > centre(film[0], 0)[1] + 0.2


@pytest.mark.parametrize("name", ["a.mp4", "a.gif", "a.png", "beside.png"])
def test_a_full_disk_is_one_line_and_no_file(tmp_path, monkeypatch, name):
    made = np.random.default_rng(0).integers(0, 255, (3, 48, 64, 3), "uint8")
    monkeypatch.setattr(drawing, "frames", lambda *_: iter(made))
    draw = partial(drawing.draw_beside, made) if name == "beside.png" else written
    with limited(100), pytest.raises(OSError, match="File too large") as caught:
        draw(out=tmp_path / name)
    assert caught.value.filename == str(tmp_path / name)
    assert [*tmp_path.iterdir()] == []


@pytest.fixture
def choosing(monkeypatch):
    """Decrees which backends work."""
    offscreen.chosen.cache_clear()
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr(sys, "platform", "linux")

    def works(*names):
        code = f"import sys; sys.exit('{{backend}}' not in {names})"
        monkeypatch.setattr(offscreen, "TRIAL", code)

    yield works
    offscreen.chosen.cache_clear()


@pytest.mark.parametrize(
    ("working", "asked", "chosen"),
    [
        (("egl", "osmesa"), None, "egl"),
        (("egl", "osmesa"), "OSMesa", "osmesa"),
        (("osmesa",), None, "osmesa"),
        ((), None, None),
    ],
)
def test_egl_comes_before_osmesa_unless_the_user_says_otherwise(
    choosing, monkeypatch, working, asked, chosen
):
    """Where none works, an error names the packages to install."""
    choosing(*working)
    if asked:
        monkeypatch.setenv("MUJOCO_GL", asked)
    if chosen:
        assert offscreen.backend() == chosen
        return
    with pytest.raises(offscreen.NoGraphicsError, match="egl and osmesa failed; install libegl1"):
        offscreen.backend()


@pytest.mark.parametrize(
    ("renderer", "expected"), [("llvmpipe (LLVM 15.0.6, 256 bits)", True), ("NVIDIA H100", False)]
)
def test_the_driver_says_whether_the_processor_draws(choosing, monkeypatch, renderer, expected):
    monkeypatch.setattr(offscreen, "TRIAL", f"print('{renderer}')")
    assert offscreen.by_processor() == expected


@pytest.mark.parametrize("name", offscreen.BACKENDS)
def test_each_backend_draws_or_is_not_chosen(name):
    """In a process of its own, after mujoco was imported for no display at all."""
    code = (
        "import mujoco, numpy as np, os, sys\n"
        f"os.environ['MUJOCO_GL'] = {name!r}\n"
        "from hybrid_rl.analysis import drawing\n"
        "from hybrid_rl.envs.mujoco import offscreen\n"
        "try: name = offscreen.backend()\n"
        "except offscreen.NoGraphicsError as problem: sys.exit(str(problem))\n"
        f"assert name == {name!r}\n"
        f"pictures = list(drawing.frames('''{FIXED}''', np.zeros((2, 1)), 64, 48))\n"
        "assert (pictures[0] == pictures[1]).all() and pictures[0].std() > 10\n"
    )
    env = {key: value for key, value in os.environ.items() if key != "PYOPENGL_PLATFORM"}
    env["MUJOCO_GL"] = "disable"
    done = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True)
    assert done.stdout == ""
    if done.returncode:
        assert done.stderr.startswith(f"cannot draw without a display: {name} failed; install")
    else:
        assert done.stderr == ""
