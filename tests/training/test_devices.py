"""Learners on several devices equal those on one device."""

import os
import subprocess
import sys

import jax
import numpy as np
from tiny import TINY, finished, rows_of, run, summary_of

SHORT = ["algo=sac", "num_seeds=2", "total_steps=200"]


def rows(folder):
    """The metrics of each seed at each step, without times."""
    logged = rows_of(folder)
    names = ("sac/q", "sac/alpha", "train/return", "eval/return")
    return {
        (row["step"], row["seed"], name): row[name]
        for row in logged
        for name in names
        if row.get(name) is not None
    }


def on_two_devices(*runs):
    """The output of runs of these overrides, one after another on a host with two devices."""
    flags = os.environ["XLA_FLAGS"] + " --xla_force_host_platform_device_count=2"
    code = f"import hybrid_rl\nfor each in {runs}: hybrid_rl.train(each)"
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"XLA_FLAGS": flags},
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


single = finished(*SHORT)  # a run on one device


def test_learners_on_two_devices_equal_those_on_one(single, tmp_path):
    """And a run on one device continues on two."""
    whole = [*TINY, *SHORT, f"run_dir={tmp_path / 'two'}"]
    output = on_two_devices(whole, [f"resume={single}", "total_steps=300"])
    assert "devices only" not in output
    longer, got = rows(single), rows(tmp_path / "two")
    assert summary_of(single)["total_steps"] == 300
    wanted = {key: value for key, value in longer.items() if key[0] <= 200}
    assert len(longer) > len(wanted) > 0
    assert wanted.keys() == got.keys()
    assert len({seed for _, seed, _ in got}) == 2
    for key, value in wanted.items():
        np.testing.assert_allclose(got[key], value, rtol=1e-3, atol=1e-3, err_msg=str(key))


def test_learners_that_do_not_divide_are_reported(tmp_path, monkeypatch, capsys):
    """Three learners stay on one of two devices, and the log has a note."""
    monkeypatch.setattr(jax, "local_device_count", lambda: 2)
    run(tmp_path / "three", *SHORT, "num_seeds=3", "total_steps=100")
    output = capsys.readouterr().out
    assert "3 learners divide evenly over 1 of its 2 devices only" in output
