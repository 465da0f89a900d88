"""Environments in processes of their own, with a limit to a step; those that draw themselves."""

import multiprocessing

import imageio.v3 as iio
import numpy as np
import pytest
from tiny import call_command

import hybrid_rl
from hybrid_rl import RunFolder, render
from hybrid_rl.envs.adapters.external import Copies, External
from hybrid_rl.errors import WorldError
from hybrid_rl.tools.report import __main__ as report

SLEEPER = '''
import os
import time

import gymnasium
import numpy as np

FAULTS = {
    "sleep": lambda: time.sleep(3600),
    "raise": lambda: 1 / 0,
    "kill": lambda: os.kill(os.getpid(), 9),
}


class Sleeper(gymnasium.Env):
    """obs = steps so far; the third step does not return, raises or ends."""

    observation_space = gymnasium.spaces.Box(-10, 10, (1,))
    action_space = gymnasium.spaces.Box(-1, 1, (1,))
    metadata = {"render_fps": 10}

    def __init__(self, fault="sleep"):
        self.fault = fault

    def reset(self, seed=None, options=None):
        super().reset(seed=seed)
        self.count = 0
        return np.zeros(1, np.float32), {}

    def step(self, action):
        self.count += 1
        if self.count == 3:
            FAULTS[self.fault]()
        return np.full(1, self.count, np.float32), 1.0, False, False, {}
'''


@pytest.mark.parametrize(
    ("fault", "line"),
    [
        ("sleep", r"sleeper:Sleeper: step: took longer than env\.timeout_s=1\.0"),
        ("raise", r"sleeper:Sleeper: step: ZeroDivisionError"),
        ("kill", r"sleeper:Sleeper: step: its process ended"),
    ],
)
def test_a_step_that_does_not_return_raises_or_ends_is_one_line(
    tmp_path, monkeypatch, recwarn, fault, line
):
    """Gymnasium does not warn of it, too."""
    (tmp_path / "sleeper.py").write_text(SLEEPER)
    monkeypatch.syspath_prepend(str(tmp_path))
    given = {"make": "sleeper:Sleeper", "kwargs": {"fault": fault}}
    copies = Copies(External(**given, timeout_s=1.0), [0, 1], steps=10)
    assert copies.reset().tolist() == [[0], [0]]
    for count in (1, 2):
        assert copies.step(np.zeros((2, 1))).obs.tolist() == [[count], [count]]
    with pytest.raises(WorldError, match=line):
        copies.step(np.zeros((2, 1)))
    copies.close()
    assert not multiprocessing.active_children()
    assert not [each for each in recwarn if "gymnasium" in each.filename]


PAINTER = (
    SLEEPER.replace("Sleeper", "Painter")
    .replace("== 3", "== 1000")
    .replace(
        "def reset",
        """def render(self):
        assert os.environ["MUJOCO_GL"] in ("egl", "osmesa")  # as MuJoCo's and Gymnasium's need
        return np.full((21, 32, 3), 10 * self.count, np.uint8)

    def reset""",
    )
    .replace('"render_fps": 10', '"render_fps": 10, "render_modes": ["rgb_array"]')
    .replace('fault="sleep"', 'render_mode=None, fault="sleep"')
    .replace("self.fault = fault", "self.fault, self.render_mode = fault, render_mode")
)


def test_a_gymnasium_environment_draws_itself(tmp_path, monkeypatch, capsys):
    (tmp_path / "painter.py").write_text(PAINTER)
    monkeypatch.syspath_prepend(str(tmp_path))
    line = ["task=gymnasium", "env.make=painter:Painter", "algo=sac", "policy.hidden=[8]"]
    line += ["critic.hidden=[8]", "policy_learner.batch_size=4", "episode.steps=6", "eval_modes=[]"]
    line += ["total_steps=12", "random_steps=4", "checkpoint_every=12", f"run_dir={tmp_path}/run"]
    hybrid_rl.train(line, progress=False)
    out = tmp_path / "episode.gif"
    monkeypatch.setenv("MUJOCO_GL", "disable")  # as every command begins
    assert call_command(render.main, f"run={tmp_path}/run", f"out={out}") == 0
    assert "6 decisions, return 6.0" in capsys.readouterr().out
    assert call_command(render.main, f"run={tmp_path}/run", "at=0,3", f"out={out}.png") == 0
    assert iio.imread(f"{out}.png").shape == (20, 64, 3)
    page = report.page([RunFolder(tmp_path / "run")])
    assert "the first 6 of 6 decisions of an episode, return so far 6.0" in page
    pictures = iio.imread(out)[:6]
    assert np.all(np.diff(pictures.astype(int).mean((1, 2, 3))) > 0)
