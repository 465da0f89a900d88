"""A method is one YAML; a part is one Python file and one YAML; nothing else is edited."""

import json
import os
import re
import sys
from pathlib import Path

import pytest
from omegaconf import OmegaConf
from tiny import TINY, call, call_train

from hybrid_rl import config, evaluate, render
from hybrid_rl.cli import command
from hybrid_rl.envs.mujoco import offscreen

pytestmark = pytest.mark.xdist_group("extend")
ROOT = Path(__file__).resolve().parents[1]
METHOD = """\
# @package _global_
# Planning around the plan, no policy.
defaults:
  - /family@_global_: hybrid
  - override /proposal: noise
  - _self_
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
class NoDynamics:
    """v ~ U(-reach, reach)."""

    reach: float = 1.0

    def init(self, spec, place):
        return ()

    def __call__(self, params, carry, x, plan, noise):
        v = self.reach * (2 * norm.cdf(noise) - 1)
        return v, -jnp.log(2 * self.reach) * plan.size, carry
'''
PART_YAML = """\
# NoDynamics.
_target_: my_part.NoDynamics
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


def test_a_part_is_one_file_and_one_yaml(conf, part, tmp_path, capfd):
    folder = tmp_path / "run"
    line = [*TINY, "algo=toy", "proposal=toy", "total_steps=200", f"run_dir={folder}"]
    assert call_train("--config-dir", conf, *line) == 0
    assert capfd.readouterr().err == ""
    kept = OmegaConf.load(folder / "config.yaml")
    assert kept.controllers.full.proposal == {"_target_": "my_part.NoDynamics", "reach": 0.5}
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
            "proposal: nn_mppi does not use it; it uses model_proposal",
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


@pytest.fixture
def world(tmp_path, monkeypatch):
    """The configuration folder of the analytic world of CONTRIBUTING.md, outside the repository."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    section = text.split("## An analytic world\n")[1].split("\n## ")[0]
    code, yaml = re.findall(r"```(?:python|yaml)\n(.*?)```", section, re.S)
    (tmp_path / "kettle.py").write_text(code)
    (tmp_path / "my_conf" / "task").mkdir(parents=True)
    (tmp_path / "my_conf" / "task" / "kettle.yaml").write_text(yaml)
    monkeypatch.syspath_prepend(tmp_path)
    yield tmp_path / "my_conf"
    sys.modules.pop("kettle", None)


def test_the_analytic_world_of_the_how_to_runs(world, tmp_path, monkeypatch, capfd):
    """Trained, read back from another folder, and drawn as far as it can be."""
    folder = tmp_path / "run"
    tiny = [text for text in TINY if text not in ("task=pendulum", "total_steps=600")]
    given = ["task=kettle", "algo=sac", "total_steps=100", "episode.steps=20", f"run_dir={folder}"]
    assert call_train("--config-dir", world, *tiny, *given, "env.power=4") == 0
    assert capfd.readouterr().err == ""
    said = json.loads((folder / "summary.json").read_text())
    assert (said["task"], said["finished"]) == ("kettle", True)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    trained = evaluate.load(folder)
    assert trained.episode.env.power == 4
    assert (evaluate.evaluate(trained, episodes=2)["return"] < 0).all()
    monkeypatch.setattr(offscreen, "backend", lambda: "egl")
    assert call(lambda: command.guarded(render.main), f"run={folder}") == 2
    line = capfd.readouterr().err
    assert line.count("\n") == 1
    assert "Kettle has no `scene` and no `pose`: the world cannot be drawn" in line
