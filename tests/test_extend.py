"""A method is one YAML; a part is one Python file and one YAML; nothing else is edited."""

import json
import os
import subprocess
import sys

import pytest
from omegaconf import OmegaConf
from tiny import TINY, call, call_train

from hybrid_rl import command, config, evaluate

pytestmark = pytest.mark.xdist_group("extend")
METHOD = """\
# @package _global_
# Planning around the plan, no policy.
defaults:
  - override /proposal: noise
algo: toy
planner:
  policy: null  # none is learned
controllers:
  full: ${planner}
learners:
  model: ${model_learner}
"""
PART = '''\
"""Candidates anywhere."""

from dataclasses import dataclass

import jax.numpy as jnp
from jax.scipy.stats import norm


@dataclass(frozen=True)
class Anywhere:
    """v ~ U(-reach, reach)."""

    reach: float = 1.0

    def init(self, spec, place):
        return ()

    def __call__(self, params, carry, x, plan, noise):
        v = self.reach * (2 * norm.cdf(noise) - 1)
        return v, -jnp.log(2 * self.reach) * plan.size, carry
'''
PART_YAML = """\
# Anywhere.
_target_: my_part.Anywhere
reach: 0.5
"""


@pytest.fixture
def conf(tmp_path):
    folder = tmp_path / "my_conf"
    (folder / "algo").mkdir(parents=True)
    (folder / "algo" / "toy.yaml").write_text(METHOD)
    return folder


@pytest.fixture
def part(conf, tmp_path, monkeypatch):
    """Beside the method, a part of its own."""
    (tmp_path / "my_part.py").write_text(PART)
    (conf / "proposal").mkdir()
    (conf / "proposal" / "toy.yaml").write_text(PART_YAML)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    yield
    sys.modules.pop("my_part", None)


def test_a_method_is_one_yaml(conf, tmp_path, capfd):
    folder = tmp_path / "run"
    line = ["--config-dir", conf, *TINY, "algo=toy", "total_steps=200", f"run_dir={folder}"]
    assert call_train(*line) == 0
    assert capfd.readouterr().err == ""
    kept = OmegaConf.load(folder / "config.yaml")
    assert kept.controllers.full.proposal._target_.endswith("NoiseProposal")
    assert list(kept.learners) == ["model"]
    said = json.loads((folder / "summary.json").read_text())
    assert (said["algo"], said["finished"]) == ("toy", True)


def test_python_takes_the_same_folder(conf):
    made = config.load(["task=pendulum", "algo=toy"], config_dir=conf)
    assert list(made.learners) == ["model"]
    with pytest.raises(config.UsageError, match="config_dir=nowhere: no such folder"):
        config.load(config_dir="nowhere")


def test_a_part_is_one_file_and_one_yaml(conf, part, tmp_path):
    folder = tmp_path / "run"
    line = [*TINY, "algo=toy", "proposal=toy", "total_steps=200", f"run_dir={folder}"]
    whole = [sys.executable, "-m", "hybrid_rl.train", "--config-dir", str(conf), *line]
    done = subprocess.run(whole, cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    kept = OmegaConf.load(folder / "config.yaml")
    assert kept.controllers.full.proposal == {"_target_": "my_part.Anywhere", "reach": 0.5}
    assert call(lambda: command.guarded(evaluate.main), f"run={folder}", "episodes=1") == 0


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (["proposal=toys"], "proposal=toys: unknown; choose one of mixture, noise, policy, toy"),
        (["proposal=toy", "proposal.reach=far"], "proposal.reach=far: must be a number"),
        (
            ["proposal=toy", "proposal.reech=1"],
            "proposal.reech: unknown key; did you mean proposal.reach?",
        ),
        (["proposal=toy", "proposal._target_=my_part.Any"], "proposal._target_=my_part.Any: "),
        (
            ["proposal=toy", "proposal._target_=their.Any"],
            "(No module named 'their'); is its folder on PYTH",
        ),
        (
            ["algo=nn_mppi", "proposal=toy"],
            "proposal: nn_mppi does not use it; it uses model_planner",
        ),
    ],
    ids=lambda given: given[-1] if isinstance(given, list) else "",
)
def test_what_is_wrong_with_a_part_is_one_line(conf, part, tmp_path, capfd, given, words):
    line = ["--config-dir", conf, *TINY, "algo=toy", f"run_dir={tmp_path / 'run'}", *given]
    assert call_train(*line) == 2
    said = capfd.readouterr().err
    assert said.count("\n") == 1
    assert words in said
    assert not (tmp_path / "run").exists()
