"""Drawing without a display, and the render command."""

import os
import subprocess
import sys
import time
from dataclasses import dataclass
from types import SimpleNamespace

import imageio.v3 as iio
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl import render
from hybrid_rl.cli import command
from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.run import drawing
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import EnvState, Spec

SPEC = Spec(obs=1, act=1, dt=0.1)
SCENE = """
<mujoco>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <worldbody>
    <camera name="{camera}" pos="0 0 4" fovy="60"/>
    <body>
      <joint type="slide" axis="1 0 0"/>
      <geom type="box" size=".2 .2 .2" rgba="1 0 0 1"/>
    </body>
    <geom type="box" pos="0 1 0" size=".2 .2 .2" rgba="0 0 1 1"/>
  </worldbody>
</mujoco>
"""
FIXED, FREE = SCENE.format(camera="track"), SCENE.format(camera="other")


@dataclass(frozen=True)
class Slider:
    """A box that is pushed to the right, and falls off after `end` decisions."""

    end: int = 5
    spec: Spec = SPEC

    def reset(self, key):
        no = jnp.zeros((), bool)
        return EnvState(jnp.zeros(1), jnp.zeros(1), jnp.float32(0), no, no, {}, {})

    def step(self, state, action):
        x = state.data + 0.1 * action
        fell = x[0] > 0.1 * self.end - 0.05
        return state.replace(data=x, obs=x, reward=action[0], terminated=fell)

    def scene(self):
        return FIXED

    def pose(self, state):
        return state.data


@dataclass(frozen=True)
class Push:
    """u = params."""

    def init(self, spec):
        return ()

    def act(self, params, state, obs, key):
        return params, state, {}


@pytest.fixture
def trained(monkeypatch):
    """A run of two learners, of which the second does not push."""
    run = SimpleNamespace(
        episode=Episode(Slider(), steps=20),
        controllers={"full": Push()},
        params=jnp.array([[1.0], [0.0]]),
        seeds=(3, 4),
        step=7000,
    )
    module = SimpleNamespace(load=lambda path: run)
    monkeypatch.setitem(sys.modules, "hybrid_rl.evaluate", module)
    return run


@pytest.fixture
def can_draw():
    """Whether this machine draws; where not, it has to say what to install."""
    try:
        offscreen.backend()
    except offscreen.NoGraphicsError:
        with pytest.raises(offscreen.NoGraphicsError, match="install libegl1 or libosmesa6"):
            offscreen.backend()
        return False
    return True


def call(monkeypatch, *arguments):
    """Exit code of the command."""
    monkeypatch.setattr(sys, "argv", ["render", *map(str, arguments)])
    try:
        command.guarded(render.main)
    except SystemExit as end:
        return end.code
    return 0


def centre(picture, channel):
    """Mean (row, column) of the pixels of one pure colour, as shares of the picture."""
    rest = [c for c in range(3) if c != channel]
    found = (picture[..., channel] > 150) & (picture[..., rest] < 90).all(-1)
    assert found.any()
    return np.argwhere(found).mean(0) / picture.shape[:2]


def positions(number=6):
    return np.linspace(-1, 1, number)[:, None]


def test_pictures_show_the_positions(can_draw):
    if not can_draw:
        return
    pictures = list(drawing.frames(FIXED, positions(3), 64, 48))
    assert all(picture.shape == (48, 64, 3) for picture in pictures)
    red = np.array([centre(picture, 0) for picture in pictures])
    np.testing.assert_allclose(red[:, 0], 0.5, atol=0.05)
    assert (np.diff(red[:, 1]) > 0.1).all()  # to the right
    assert centre(pictures[1], 2)[0] < 0.4  # y is up


def test_without_a_camera_of_its_own_the_robot_is_followed(can_draw):
    if not can_draw:
        return
    near, far = drawing.frames(FREE, np.array([[0.0], [5.0]]), 64, 48)
    np.testing.assert_allclose(centre(near, 0), centre(far, 0), atol=0.05)
    assert len(list(drawing.frames("<mujoco/>", np.zeros((1, 0)), 64, 48))) == 1


def test_an_mp4_plays_everywhere(tmp_path, can_draw):
    if not can_draw:
        return
    out = drawing.draw(FIXED, positions(), tmp_path / "new" / "a.mp4", 25, 64, 48)
    said = iio.immeta(out, plugin="pyav")
    assert (said["codec"], said["video_format"], said["fps"]) == ("h264", "yuv420p", 25)
    film = iio.imread(out, plugin="pyav")
    assert film.shape == (6, 48, 64, 3)
    assert centre(film[5], 0)[1] > centre(film[0], 0)[1] + 0.2
    assert [path.name for path in out.parent.iterdir()] == ["a.mp4"]


def test_a_gif_goes_round_at_no_more_than_its_speed(tmp_path, can_draw):
    if not can_draw:
        return
    out = drawing.draw(FIXED, positions(), tmp_path / "a.gif", 40, 64, 48)
    said = iio.immeta(out)
    assert (said["duration"], said["loop"]) == (50, 0)  # [ms]: every second of 40 a second
    film = iio.imread(out)
    assert film.shape == (3, 48, 64, 3)
    assert centre(film[2], 0)[1] > centre(film[0], 0)[1] + 0.2


def test_what_fails_halfway_leaves_nothing(tmp_path, monkeypatch, can_draw):
    if not can_draw:
        return

    def broken(*_):
        yield np.zeros((48, 64, 3), np.uint8)
        raise RuntimeError("broken")

    monkeypatch.setattr(drawing, "frames", broken)
    with pytest.raises(RuntimeError, match="broken"):
        drawing.draw(FIXED, positions(), tmp_path / "a.mp4", 25, 64, 48)
    assert list(tmp_path.iterdir()) == []


def test_a_png_is_the_picture_halfway(tmp_path, can_draw):
    if not can_draw:
        return
    out = drawing.draw(FIXED, positions(5), tmp_path / "a.png", 25, 64, 48)
    film = list(drawing.frames(FIXED, positions(5), 64, 48))
    np.testing.assert_array_equal(iio.imread(out), film[2])


def test_a_canvas_that_is_not_closed_ends_without_noise(can_draw):
    """And another may be drawn on between two of its pictures."""
    code = (
        "import numpy as np, weakref\n"
        "weakref.finalize(np, print, end='')  # from here on, finalizers run after EGL's end\n"
        "from hybrid_rl.envs.mujoco.offscreen import Canvas\n"
        f"one, two = Canvas({FIXED!r}, 64, 48), Canvas({FIXED!r}, 32, 24)\n"
        "first, small = one.draw(np.zeros(1)), two.draw(np.zeros(1))\n"
        "assert (first == one.draw(np.zeros(1))).all() and small.shape == (24, 32, 3)\n"
        "two.close()\n"
        "assert (first == one.draw(np.zeros(1))).all()\n"
    )
    if can_draw:
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_drawing_is_counted_in_pictures(monkeypatch, capsys):
    now = iter(range(0, 10_000, 20))
    monkeypatch.setattr(time, "monotonic", lambda: float(next(now)))
    assert list(drawing._counted(range(3), 3)) == [0, 1, 2]
    assert "pictures/s" in capsys.readouterr().out


def test_positions_of_another_scene_are_refused(can_draw):
    if can_draw:
        with pytest.raises(ValueError, match=r"qpos is \(3,\); the scene takes \[1\]"):
            next(drawing.frames(FIXED, np.zeros((2, 3))))
    with pytest.raises(ValueError, match=r"a\.avi: must end in \.mp4, \.gif, \.png"):
        drawing.draw(FIXED, positions(), "a.avi", 25)


@pytest.fixture
def choosing(monkeypatch):
    """Decrees which backends work."""
    offscreen.backend.cache_clear()
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr(sys, "platform", "linux")

    def works(*names):
        code = f"import sys; sys.exit('{{backend}}' not in {names})"
        monkeypatch.setattr(offscreen, "TRIAL", code)

    yield works
    offscreen.backend.cache_clear()


def test_egl_comes_before_osmesa_unless_the_user_says_otherwise(choosing, monkeypatch):
    choosing("egl", "osmesa")
    assert offscreen.backend() == "egl"
    offscreen.backend.cache_clear()
    monkeypatch.setenv("MUJOCO_GL", "OSMesa")
    assert offscreen.backend() == "osmesa"


def test_osmesa_is_taken_where_egl_fails(choosing):
    choosing("osmesa")
    assert offscreen.backend() == "osmesa"


def test_a_machine_that_cannot_draw_says_what_to_install(choosing, monkeypatch, capsys, tmp_path):
    choosing()
    assert call(monkeypatch, f"run={tmp_path}") == 1
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "egl and osmesa failed; install libegl1 or libosmesa6" in said


@pytest.mark.parametrize("name", offscreen.BACKENDS)
def test_each_backend_draws_or_is_not_chosen(name):
    """In a process of its own, after mujoco was imported for no display at all."""
    code = (
        "import mujoco, numpy as np, sys\n"
        "from hybrid_rl.run import drawing\n"
        "from hybrid_rl.envs.mujoco import offscreen\n"
        "try: name = offscreen.backend()\n"
        "except offscreen.NoGraphicsError as problem: sys.exit(str(problem))\n"
        f"assert name == {name!r}\n"
        f"pictures = list(drawing.frames('''{FIXED}''', np.zeros((2, 1)), 64, 48))\n"
        "assert (pictures[0] == pictures[1]).all() and pictures[0].std() > 10\n"
    )
    env = {**os.environ, "MUJOCO_GL": name}
    done = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True)
    assert done.stdout == ""
    if done.returncode:
        assert done.stderr.startswith(f"cannot draw without a display: {name} failed; install")
    else:
        assert done.stderr == ""


def test_an_episode_ends_where_the_world_ends(trained):
    poses, total, success = render.episode(trained)
    np.testing.assert_allclose(poses[:, 0], 0.1 * np.arange(6), atol=1e-6)
    assert (total, success) == (5, None)
    poses, total, _ = render.episode(trained, seed=4)
    assert (poses.shape, total) == ((21, 1), 0)
    poses, total, _ = render.episode(trained, steps=3)
    assert (len(poses), total) == (4, 3)


def test_the_command_writes_a_video_in_real_time(trained, tmp_path, monkeypatch, capsys, can_draw):
    if not can_draw:
        return
    assert call(monkeypatch, f"run={tmp_path}", "width=64", "height=48") == 0
    out = tmp_path / "video.mp4"
    assert iio.immeta(out, plugin="pyav")["fps"] == pytest.approx(10)
    assert len(iio.imread(out, plugin="pyav")) == 6
    said = capsys.readouterr().out.splitlines()[-1]
    assert said == f"{out}: 5 decisions, return 5.0, step 7,000"


def test_the_expert_of_a_task_is_drawn_too(tmp_path, monkeypatch, capsys, can_draw):
    """Two decisions of Sawyer's."""
    if not can_draw:
        return
    small = ["width=64", "height=48", "episode_steps=2"]
    assert call(monkeypatch, "task=sawyer_push", f"out={tmp_path}/a.mp4", *small) == 0
    assert len(iio.imread(tmp_path / "a.mp4", plugin="pyav")) == 3
    assert capsys.readouterr().out.splitlines()[-1].endswith(", no success, scripted expert")


@dataclass(frozen=True)
class Goal(Slider):
    """A slider that succeeds at `goal`."""

    goal: float = 0.5

    def _judged(self, state):
        return state.replace(metrics={"success": 1.0 * (state.data[0] > self.goal - 0.05)})

    def reset(self, key):
        return self._judged(super().reset(key))

    def step(self, state, action):
        return self._judged(super().step(state, action))


def test_success_is_that_of_the_end(trained):
    trained.episode = Episode(Goal(), steps=20)
    assert [render.episode(trained, seed=seed).success for seed in (3, 4)] == [True, False]


def test_a_world_that_cannot_be_drawn_is_one_line(trained, monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(offscreen, "backend", lambda: "egl")
    world = SimpleNamespace(spec=SPEC, reset=Slider().reset, step=Slider().step)
    trained.episode = Episode(world, steps=20)
    assert call(monkeypatch, f"run={tmp_path}") == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "has no `scene` and no `pose`: the world cannot be drawn" in said


def test_a_picture_is_no_larger_than_the_framebuffer(trained, monkeypatch, capsys, can_draw):
    """OpenGL has a longest side."""
    if not can_draw:
        return
    assert call(monkeypatch, "run=x", "width=1000000") == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    most = int(said.split("must be at most ")[1].split(",")[0])
    assert said.startswith("hybrid_rl: width=1000000: ")
    offscreen.check_size(most, 2)
    with pytest.raises(ValueError, match=f"height={most + 2}: must be at most {most}"):
        offscreen.check_size(2, most + 2)


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ([], "run, task: give one of them"),
        (["run=x", "task=sawyer_push"], "run, task: give one of them"),
        (["run=x", "env.reward=thesis"], "env, episode, expert: a run has its own"),
        (["task=sawyer_push", "mode=full"], "mode: a scripted expert has none"),
        (["task=pendulum"], "task=pendulum: has no scripted expert"),
        (["run=x", "out=a.avi"], "out=a.avi: must end in .mp4, .gif, .png"),
        (["run=x", "width=63"], "width=63: must be an even number, 2 or more"),
        (["run=x", "episode_steps=0"], "episode_steps=0: must be a whole number, 1 or more"),
        (["run=x", "seed=five"], "seed=five: must be a whole number, 0 or more"),
        (["run=x", "colour=red"], "colour=red: unknown argument"),
        (["run=x", "seed=5"], "seed=5: the run has 3, 4"),
        (["run=x", "mode=planner"], "mode=planner: the run has full"),
    ],
)
def test_bad_usage_is_one_line_and_code_2(trained, monkeypatch, capsys, arguments, line):
    monkeypatch.setattr(offscreen, "backend", lambda: "egl")
    assert call(monkeypatch, *arguments) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert line in said


def test_a_fast_world_skips_pictures(trained, tmp_path, monkeypatch, can_draw):
    """200 decisions a second: every fourth is drawn, at 50 a second."""
    fast = Slider(end=9, spec=SPEC._replace(dt=0.005))
    trained.episode = Episode(fast, steps=20)
    if can_draw:
        assert call(monkeypatch, "run=x", f"out={tmp_path}/a.mp4", "width=64", "height=48") == 0
        assert iio.immeta(tmp_path / "a.mp4", plugin="pyav")["fps"] == pytest.approx(50)
        assert len(iio.imread(tmp_path / "a.mp4", plugin="pyav")) == 3
