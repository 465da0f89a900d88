"""The render command."""

from dataclasses import dataclass
from functools import partial
from types import SimpleNamespace

import imageio.v3 as iio
import jax.numpy as jnp
import numpy as np
import pytest
from scenes import FIXED
from tiny import call_command, refusal

from hybrid_rl import render
from hybrid_rl.analysis import drawing
from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.run.saved import Trained
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import EnvState, Params, Spec

pytestmark = pytest.mark.turns(3)

SPEC = Spec(obs=1, act=1, dt=0.1)


@dataclass(frozen=True)
class Slider:
    """A box that is pushed to the right, and falls off after `end` decisions."""

    end: int = 5
    spec: Spec = SPEC

    def reset(self, key):
        return EnvState(jnp.zeros(1), jnp.zeros(1), jnp.float32(0))

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
    """u = the policy's parameters."""

    def init(self, spec):
        return ()

    def act(self, params, state, obs, key):
        return params.policy, state, {}


@pytest.fixture
def trained(monkeypatch):
    """A run of two learners, of which the second does not push."""
    run = SimpleNamespace(
        episode=Episode(Slider(), steps=20),
        controllers={"full": Push()},
        params=Params(policy=jnp.array([[1.0], [0.0]])),
        seeds=(3, 4),
        step=7000,
        notes=("of two learners",),
    )
    run.learner = partial(Trained.learner, run)
    monkeypatch.setattr("hybrid_rl.run.retarget.load_named", lambda given: run)
    return run


draw = partial(call_command, render.main, "width=64", "height=48")


def test_an_episode_ends_where_the_world_ends(trained):
    poses, total, success = drawing.episode(trained)
    np.testing.assert_allclose(poses[:, 0], 0.1 * np.arange(6), atol=1e-6)
    assert (total, success) == (5, None)
    poses, total, _ = drawing.episode(trained, seed=4)
    assert (poses.shape, total) == ((21, 1), 0)
    poses, total, _ = drawing.episode(trained, steps=3)
    assert (len(poses), total) == (4, 3)


def test_the_command_writes_a_video_in_real_time(trained, tmp_path, capsys, draws):
    assert draw(f"run={tmp_path}") == 0
    out = tmp_path / "video.mp4"
    assert iio.immeta(out, plugin="pyav")["fps"] == pytest.approx(10)
    assert len(iio.imread(out, plugin="pyav")) == 6
    first, *_, last = capsys.readouterr().out.splitlines()
    assert first == "of two learners"
    assert last == f"{out}: 5 decisions, return 5.0, step 7,000"


def test_the_expert_of_a_task_is_drawn_too(tmp_path, capsys, draws):
    """Two decisions of Sawyer's."""
    assert draw("task=sawyer_push", f"out={tmp_path}/a.mp4", "episode_steps=2") == 0
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
    assert [drawing.episode(trained, seed=seed).success for seed in (3, 4)] == [True, False]


def test_pictures_side_by_side(trained, tmp_path, capsys, draws):
    """After the decisions that are asked for; the last one again after the end, with a line."""
    assert draw("run=x", "at=0,5,20", f"out={tmp_path / 'a.png'}") == 0
    printed = capsys.readouterr().out
    assert "at=20: the episode ends after 5 decisions, shown instead" in printed
    first, middle, last = np.split(iio.imread(tmp_path / "a.png"), 3, axis=1)
    np.testing.assert_array_equal(middle, last)
    assert (first != last).any()


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["run=x", "task=sawyer_push"], "run, policy, task: give one of them"),
        (["run=x", "expert.gain=1"], "expert: is not for x; give it with task=T"),
        (["task=panda_stack", "reward=speed"], "reward: is not for panda_stack; give it"),
        (["run=x", "width=63"], "width=63: must be an even number, 2 or more"),
        (["run=x", "at=0,5"], "at=0,5: needs out=FILE.png"),
    ],
)
def test_bad_usage_is_one_line_and_code_2(trained, monkeypatch, capfd, arguments, line):
    monkeypatch.setattr(offscreen, "backend", lambda: "egl")
    assert line in refusal(capfd, *arguments, of=render.main)


@pytest.mark.parametrize(
    ("by_processor", "more", "pictures"),
    [
        (True, [], 4),
        (True, ["episode_steps=20"], 6),
        (True, ["episode_steps=2"], 3),
        (False, [], 6),
    ],
    ids=["beginning", "all", "fewer", "card"],
)
def test_a_processor_draws_the_beginning_unless_asked_for_more(
    trained, tmp_path, monkeypatch, capsys, draws, by_processor, more, pictures
):
    """The box falls off after 5 decisions; three pictures after the first are the default."""
    monkeypatch.setattr(offscreen, "by_processor", lambda: by_processor)
    monkeypatch.setattr(drawing, "FIRST", 3)
    assert draw("run=x", f"out={tmp_path / 'a.mp4'}", *more) == 0
    assert len(iio.imread(tmp_path / "a.mp4", plugin="pyav")) == pictures
    line = "the beginning, as there is no graphics card; all: episode_steps=20"
    assert (line in capsys.readouterr().out.splitlines()) == (by_processor and not more)


def test_a_still_is_of_the_whole_episode(trained, tmp_path, monkeypatch, draws):
    monkeypatch.setattr(drawing, "FIRST", 1)
    assert draw("run=x", f"out={tmp_path / 'a.png'}") == 0
    poses = drawing.episode(trained).poses
    middle = next(drawing.frames(FIXED, poses[len(poses) // 2][None], 64, 48))
    np.testing.assert_array_equal(iio.imread(tmp_path / "a.png"), middle)


def test_a_fast_world_skips_pictures(trained, tmp_path, can_draw):
    """200 decisions a second: every fourth is drawn, at 50 a second."""
    fast = Slider(end=9, spec=SPEC._replace(dt=0.005))
    trained.episode = Episode(fast, steps=20)
    if can_draw:
        assert draw("run=x", f"out={tmp_path}/a.mp4") == 0
        assert iio.immeta(tmp_path / "a.mp4", plugin="pyav")["fps"] == pytest.approx(50)
        assert len(iio.imread(tmp_path / "a.mp4", plugin="pyav")) == 3
