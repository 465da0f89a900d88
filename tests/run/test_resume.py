"""A run that was stopped and resumed is the run that was never stopped, bit for bit."""

import json
import shutil
import time

import numpy as np
import pytest
from omegaconf import OmegaConf
from tiny import TINY, call_train, contents, finished, run, summary_of

from hybrid_rl import __version__
from hybrid_rl.run import launch
from hybrid_rl.run.checkpoints import checkpoint
from hybrid_rl.settings import build as config
from scripts import interrupt

pytestmark = pytest.mark.turns(4)

HYBRID = ["algo=hybrid_stochastic", "eval_modes=[full,policy]", "replay.capacity=1000000"]
NATIVE = ["task=cartpole", "algo=sac", "physics=native", "episode.steps=40"]


whole = finished(*HYBRID)  # a run that was never stopped


@pytest.fixture(scope="module")
def halves(tmp_path_factory):
    """Runs of half its length; the first is of the same seed."""
    folders = [tmp_path_factory.mktemp("half") / str(seed) for seed in range(3)]
    for seed, folder in enumerate(folders):
        run(folder, *HYBRID, "total_steps=300", "eval_every=300", f"seed={seed}")
    return folders


def test_a_stopped_run_goes_on_bit_for_bit(whole, tmp_path):
    """By two signals at once, after its first checkpoint."""
    folder = tmp_path / "run"
    process = interrupt.start([*TINY, *HYBRID, f"run_dir={folder}"])
    while interrupt.newest(folder) is None and process.poll() is None:
        time.sleep(0.002)
    both = interrupt.FAULTS["SIGINT and SIGTERM"]
    assert interrupt.stop(process, both, folder) in (130, 143)
    reached, summary = interrupt.newest(folder), summary_of(folder)
    assert not summary["finished"]
    assert 0 < summary["total_steps"] == reached == interrupt.rows(folder)[-1]["step"] < 600
    assert call_train(f"resume={folder}") == 0
    assert interrupt.difference(folder, whole) == ""
    summary = summary_of(folder)
    assert summary["finished"]
    assert summary["total_steps"] == 600


def test_native_physics_goes_on_bit_for_bit(tmp_path):
    """Killed anywhere, also before there is a checkpoint."""
    run(tmp_path / "whole", *NATIVE)
    folders, kill = (tmp_path / "whole", tmp_path / "run"), interrupt.FAULTS["SIGKILL"]
    done = interrupt.trial([*TINY, *NATIVE], *folders, stops=1, within=2.0, faults={"kill": kill})
    assert done.difference == ""
    assert interrupt.line(1, done).startswith("    1  same  ")


def test_a_difference_is_found(whole, tmp_path):
    edited = shutil.copytree(whole, tmp_path / "edited")
    newest, before = (edited / "checkpoints" / step for step in ("600", "500"))
    shutil.rmtree(newest)
    assert interrupt.difference(edited, whole) == "checkpoint 500 and 600"
    before.rename(newest)  # what had been learned then
    assert interrupt.difference(edited, whole).endswith(" at step 600")
    shutil.rmtree(newest)
    shutil.copytree(whole / "checkpoints" / "600", newest)
    rows = (whole / "metrics.jsonl").read_text().splitlines(keepends=True)
    (edited / "metrics.jsonl").write_text("".join(rows[:-1]))
    assert interrupt.difference(edited, whole) == f"{len(rows) - 1} and {len(rows)} rows"
    (edited / "metrics.jsonl").write_text("".join(rows).replace('"step": 50,', '"step": 51,'))
    assert interrupt.difference(edited, whole).startswith("row {'step': 51,")


def test_a_run_made_longer_is_the_longer_run(whole, halves, tmp_path):
    folder = tmp_path / "run"
    shutil.copytree(halves[0], folder)
    assert call_train(f"resume={folder}", "total_steps=600") == 0
    assert interrupt.difference(folder, whole) == ""
    config = OmegaConf.load(folder / "config.yaml")
    assert (config.total_steps, config.resume, config.version) == (600, None, __version__)


@pytest.mark.parametrize("given", [[], [*TINY, *HYBRID]])
def test_a_finished_run_stays_as_it_is(whole, capsys, given):
    """Also if the whole command line is repeated."""
    before = contents(whole)
    assert call_train(f"resume={whole}", *given) == 0
    assert "already finished (600 steps); raise total_steps to continue" in capsys.readouterr().out
    assert contents(whole) == before


def test_a_short_run_is_made_longer_with_its_settings_repeated():
    """Its random decisions were half of it."""
    short, longer = (config.load(["algo=sac", f"total_steps={n}"]) for n in (1500, 90000))
    assert short.random_steps == 750
    assert not launch._changes(launch.written(short), launch.written(longer))


def test_without_replay_it_goes_on_and_says_so(whole, tmp_path, capsys):
    folder = tmp_path / "run"
    run(folder, *HYBRID, "checkpoint_replay=false", "total_steps=300", "eval_every=300")
    listed = json.loads((folder / "checkpoints" / "300" / "leaves.json").read_text())
    assert not [name for name in listed if name.startswith("memory")]
    assert call_train(f"resume={folder}", "total_steps=600") == 0
    assert "no replay memory in checkpoints" in capsys.readouterr().out
    rows = interrupt.rows(folder)
    assert [r["step"] for r in rows if "train/return" in r] == [200, 400, 600]
    assert [r["step"] for r in rows if "eval/return" in r] == [300, 600]
    learned = [r["step"] for r in rows if "sac/q" in r and r["step"] > 300]
    assert learned == list(range(350, 601, 50))
    assert checkpoint.steps(folder / "checkpoints")[-1] == 600


def test_seeds_side_by_side_are_the_seeds_alone(halves, tmp_path):
    """To rounding, which grows with every decision: 2e-5 after 100, 2e-4 to 5e-4 after 300.

    The agreement signal is a small difference of predicted returns: in units of those. The means of
    observations and actions are small sums of entries of about 1: in units of 1. An evaluation with
    the planner is a whole episode more, from parameters that differ already: by 1e-2, not compared.
    """
    run(tmp_path / "run", *HYBRID, "total_steps=300", "eval_every=300", "num_seeds=3")
    together = interrupt.rows(tmp_path / "run")
    for seed, alone in enumerate(halves):
        ours, theirs = [r for r in together if r["seed"] == seed], interrupt.rows(alone)
        assert [r.keys() for r in ours] == [r.keys() for r in theirs]
        for one, two in zip(ours, theirs, strict=True):
            tolerance = 1e-4 if one["step"] <= 100 else 1e-2
            of_signal = abs(two.get("planner/planned_return", 0.0))
            for key, wanted in two.items():
                if key == "eval/return":
                    continue
                of_world = 1.0 if key in ("world/obs", "world/action") else 1e-3
                atol = tolerance * (of_signal if "insertion" in key else of_world)
                np.testing.assert_allclose(one[key], wanted, rtol=tolerance, atol=atol, err_msg=key)
