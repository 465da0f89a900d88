"""Trained policies in files: what the package ships, and what a run writes."""

import json
from functools import partial

import numpy as np
import pytest
from tiny import call_command, refusal

from hybrid_rl import evaluate
from hybrid_rl.data import archive
from hybrid_rl.run.saved import names, read
from hybrid_rl.settings import build as config

pytestmark = pytest.mark.turns(3)

NAMES = names()


@pytest.mark.parametrize("name", NAMES)
def test_a_policy_of_the_package_is_small_and_has_its_origin(name):
    """Command, seed and the returns of an evaluation; and it acts."""
    file = archive.find(f"policies/{name}.npz")
    about = json.loads(str(np.load(file)["about"]))
    assert file.stat().st_size < (3e6 if "model" in about else 1e6)
    program, _, overrides = about["command"].partition(" hybrid_rl.train ")
    assert program == "python -m"
    trained_as = config.load(overrides.split())
    assert (trained_as.task, trained_as.algo) == (name, about["algo"])
    assert np.mean(about["evaluation"]["returns"]) == pytest.approx(about["evaluation"]["mean"])
    assert len(about["evaluation"]["returns"]) >= 10
    trained = read(name)
    assert (trained.task, trained.seeds) == (name, (about["seed"],))
    action = trained.policy()(np.zeros(trained.episode.spec.obs))
    assert np.abs(action).max() <= 1
    assert action.all()


def test_evaluating_it_gives_its_number(capsys):
    """On the lander, whose episodes are short."""
    main = partial(call_command, evaluate.main)
    assert main("policy=lander") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("trained by: python -m hybrid_rl.train task=lander algo=analytic")
    (then,) = [line.split()[2] for line in lines if line.startswith("evaluated then: ")]
    (now,) = [line.split()[3] for line in lines if line.startswith("│    0 │")]
    assert float(now.replace(",", "")) == pytest.approx(float(then.replace(",", "")), rel=1e-3)


def test_a_file_without_a_description_is_one_line(tmp_path, capfd):
    """As earlier versions wrote it."""
    with np.load(archive.find("policies/lander.npz")) as file:
        np.savez(tmp_path / "old.npz", **{name: file[name] for name in file if name != "about"})
    given = f"policy={tmp_path / 'old.npz'}"
    assert "its description lacks env, " in refusal(capfd, given, of=evaluate.main)


def test_what_was_read_prints_its_parts_and_not_its_weights():
    assert len(repr(read("halfcheetah"))) < 2000
