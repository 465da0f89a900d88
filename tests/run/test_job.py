"""Jobs: what trains their runs."""

from pathlib import Path
from types import SimpleNamespace

from hybrid_rl.run import job


def test_a_call_has_no_more_rows_than_its_run(monkeypatch):
    monkeypatch.setattr(job, "loop_of", lambda agent, seeds, stride, *rest: stride)
    config = SimpleNamespace(log_every=2**32, total_steps=20, num_envs=3)
    run = SimpleNamespace(config=config, seeds=(0,), agent=None)
    assert job.Job([run], [Path()]).loop() == 7
