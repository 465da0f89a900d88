"""Jobs: what trains their runs."""

from pathlib import Path
from types import SimpleNamespace

from hybrid_rl.run import launch


def test_a_call_has_no_more_rows_than_its_run(monkeypatch):
    monkeypatch.setattr(launch, "loop_of", lambda agent, seeds, stride, *rest: stride)
    config = SimpleNamespace(log_every=2**32, total_steps=20, num_envs=3)
    run = SimpleNamespace(config=config, seeds=(0,), agent=None)
    assert launch.Job([run], [Path()]).loop() == 7
