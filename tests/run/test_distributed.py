"""Two processes that share the learners of one run."""

import os
import socket
import subprocess
import sys

import pytest
from tiny import TINY, call_train, rows_of, run, summary_of

pytestmark = pytest.mark.turns(3)

LINE = [*TINY, "algo=sac", "total_steps=100"]
TIMES = {"wall_s", "perf/env_steps_per_s", "perf/compile_s"}


def together(*overrides):
    """Exit codes and error lines of two processes that were started with the same overrides."""
    with socket.socket() as free:
        free.bind(("localhost", 0))
        address = f"localhost:{free.getsockname()[1]}"
    names = {"JAX_COORDINATOR_ADDRESS": address, "JAX_NUM_PROCESSES": "2"}
    line = [sys.executable, "-m", "hybrid_rl.train", "distributed=true", *overrides]
    several = [
        subprocess.Popen(
            line, env=os.environ | names | {"JAX_PROCESS_ID": str(i)}, stderr=subprocess.PIPE
        )
        for i in range(2)
    ]
    return [(process.communicate()[1].decode(), process.returncode) for process in several]


def rows(folder, seed):
    """What was measured of a learner, without times."""
    result = rows_of(folder)
    return [
        {name: value for name, value in row.items() if name not in TIMES}
        for row in result
        if row["seed"] == seed
    ]


def test_each_process_trains_its_share_and_goes_on_with_it(tmp_path, monkeypatch):
    """Three learners over two processes: the last is, bit for bit, the one that learns alone."""
    folder = tmp_path / "run"
    ends = together(*LINE, "num_seeds=3", f"run_dir={folder}")
    assert [code for _, code in ends] == [0, 0], ends
    shares = [folder / f"process_{i}" for i in range(2)]
    summaries = [summary_of(share) for share in shares]
    assert [summary["seeds"] for summary in summaries] == [[0, 1], [2]]
    run(tmp_path / "alone", *LINE, "seed=2")
    assert rows(shares[1], 2) == rows(tmp_path / "alone", 2)
    monkeypatch.setattr("hybrid_rl.run.machine.distributed.processes", lambda: (1, 2))
    assert call_train(f"resume={folder}", "distributed=true", "total_steps=150") == 0
    assert [rows(shares[0], 0)[-1]["step"], rows(shares[1], 2)[-1]["step"]] == [100, 150]


def test_what_makes_no_distributed_run_is_one_line(tmp_path, monkeypatch, capfd):
    assert call_train(*LINE, "distributed=true") == 2
    assert "run_dir=null: distributed=true needs one folder" in capfd.readouterr().err
    monkeypatch.setattr("hybrid_rl.run.machine.distributed.processes", lambda: (1, 2))
    assert call_train(*LINE, "distributed=true", f"run_dir={tmp_path}") == 2
    assert "num_seeds=1: must be 2 or more, one a process" in capfd.readouterr().err
    assert call_train(f"resume={tmp_path}", "distributed=true") == 2
    assert "holds 0 shares, and there are 2 processes" in capfd.readouterr().err


def test_the_processes_of_a_sweep_are_counted_before_anything_is_built(monkeypatch, capfd):
    """JAX counts none after its first computation."""
    monkeypatch.setattr("hybrid_rl.cli.sweep.build_new_run", None)
    assert call_train("-m", *LINE, "seed=0,1", "distributed=true") == 2
    assert "run_dir=null: distributed=true needs one folder" in capfd.readouterr().err


def test_without_a_cluster_it_is_one_line(tmp_path):
    line = [sys.executable, "-m", "hybrid_rl.train", *LINE, "distributed=true", "num_seeds=2"]
    done = subprocess.run([*line, f"run_dir={tmp_path}"], capture_output=True, text=True)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    assert "distributed=true: no processes found" in done.stderr
    assert "JAX_COORDINATOR_ADDRESS" in done.stderr
