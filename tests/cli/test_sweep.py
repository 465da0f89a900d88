"""A sweep: checked first, all of it run, a table at the end."""

import importlib
import json
import os
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress

import pytest
from hydra._internal.core_plugins import basic_sweeper
from hydra.errors import MissingConfigException
from tiny import CONF, TINY, call_train, only_line, refusal, summary_of

from hybrid_rl import train
from hybrid_rl.errors import DivergenceError
from hybrid_rl.settings.compose import explain

SHORT = [*TINY, "algo=sac", "total_steps=200", "eval_every=200", "checkpoint_every=200"]


@pytest.fixture(autouse=True)
def alone(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def given(monkeypatch):
    """The configurations of the jobs, which do nothing else."""
    configs = []
    monkeypatch.setattr(train, "_job", lambda config, typed: configs.append(config))
    return configs


def table(folder):
    """What jobs.json of the only sweep says."""
    (file,) = (folder / "runs" / "sweeps").glob("*/jobs.json")
    return json.loads(file.read_text())


def test_a_failed_job_does_not_end_the_others(tmp_path, monkeypatch, capfd):
    def job(config, typed):
        if config.seed == 0:
            raise DivergenceError("seed 0, step 9: sac/critic_loss is not finite")
        return {"final_eval": [-3.0, -5.0], "final_return": [None]}

    monkeypatch.setattr(train, "_job", job)
    assert call_train("-m", *SHORT, "seed=0,1") == 1
    out, err = capfd.readouterr()
    first, second = table(tmp_path)
    assert (first["code"], second["code"]) == (1, 0)
    assert first["line"] == "seed 0, step 9: sac/critic_loss is not finite"
    assert second["line"] == "evaluation -4.0 (mean of 2 seeds); training return none yet"
    assert err == f"hybrid_rl: job 0: {first['line']}\n"
    *_, head, failed, _, last = out.splitlines()
    assert head.split() == ["job", "overrides", "run", "folder", "result"]
    assert failed.split()[:2] == ["0", "seed=0"]
    assert "failed (1): seed 0" in failed
    assert last == "1 of 2 jobs done; not 0"


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("policy_learner.tau=0.005,3 algo=sac", "tau=3: must lie in (0, 1] (job 1: pol"),
        ("algo=sac policy_learner.tau=0.005,3 hydra/launcher=submitit_local", "(job 1: policy_le"),
        ("algo=sac,scal", "algo=scal: unknown; choose one of those "),
        ("algo=kle3,sac explorer.horizon=3", "explorer.horizon: sac has no such key"),
        ("algo=sac,nn_mppi target=mixture", "Could not override 'target'"),
        ("algo=kle3,fourier_ergodic domain.low=[0,0] seed=-1", "to 4294967295 (job 0: algo=kle3)"),
        ("task=pendulum,halfcheetah algo=kle3", "task=halfcheetah: kle3 needs an analytic envir"),
        ("+sed=0,1 algo=sac", "sed: sac has no such key; did you mean seed? (job 0: sed=0)"),
        ("seed=range(0,0)", "seed=range(0,0): gives no values"),
        ("seed=interval(0,1)", "seed=interval(0,1): gives no values; list them"),
    ],
)
def test_a_job_that_cannot_run_is_found_before_the_first(tmp_path, capfd, given, words):
    assert words in refusal(capfd, "-m", *TINY, *given.split())
    assert list(tmp_path.iterdir()) == []


def test_a_choice_that_the_default_method_lacks(given):
    assert call_train("-m", *TINY, "algo=kle3,kle3_jensen", "target=mixture") == 0
    assert [each.algo for each in given] == ["kle3", "kle3_jensen"]


def test_an_experiment_in_a_folder_is_swept(given):
    """As those of the thesis, each of which has its methods."""
    assert call_train("-m", "experiment=thesis/fig_3_2_pendulum", "algo=sac,nn_mppi") == 0
    assert [(config.task, config.algo) for config in given] == [
        ("pendulum", "sac"),
        ("pendulum", "nn_mppi"),
    ]


def test_a_sweep_may_be_imported_before_hydra_searches_for_plugins(given):
    """Hydra then executes the modules of its own sweepers again: there are two of each class."""
    importlib.import_module("hybrid_rl.cli.sweep")
    importlib.reload(basic_sweeper)
    assert call_train("-m", CONF, "algo=sac", "seed=0,1") == 0
    assert [each.seed for each in given] == [0, 1]


def test_jobs_with_one_run_dir_have_folders_in_it(given):
    assert call_train("-m", *SHORT, "seed=0,2", 'run_dir="it\'s"') == 0
    assert [each.run_dir for each in given] == ["it's/0", "it's/1"]


def test_jobs_in_one_of_many_worlds_have_folders_of_its_name(given):
    line = ["task=gymnasium", "env.id=Pendulum-v1", "algo=sac", "seed=0,1"]
    assert call_train("-m", CONF, *line) == 0
    assert [each.run_dir.split("/")[:3] for each in given] == 2 * [["runs", "Pendulum-v1", "sac"]]


def test_the_same_command_continues_a_sweep_that_was_stopped(tmp_path, capfd, monkeypatch):
    line = ["-m", *SHORT, "seed=0,1,2", "run_dir=both"]
    job, called = train._job, []

    def stopped(config, typed):
        called.append(config.seed)
        if len(called) == 2:
            raise KeyboardInterrupt
        return job(config, typed)

    monkeypatch.setattr(train, "_job", stopped)
    with suppress(KeyboardInterrupt):
        call_train(*line)
    assert called == [0, 1]
    before = (tmp_path / "both/0/metrics.jsonl").read_text()
    assert call_train(*line) == 0
    assert "3 of 3 jobs done" in capfd.readouterr().out
    assert (tmp_path / "both/0/metrics.jsonl").read_text() == before
    assert {*map(str, (tmp_path / "both").glob("*/summary.json"))} == {
        str(tmp_path / f"both/{number}/summary.json") for number in range(3)
    }
    assert call_train(*line, "policy_learner.tau=0.1") == 2
    assert "policy_learner.tau=0.1: with resume only total_steps" in capfd.readouterr().err


def test_the_same_command_continues_runs_that_share_a_program(tmp_path, capfd):
    line = ["-m", *SHORT, "run_dir=both"]
    key = "sweep.policy_learner.discount"
    assert call_train(*line, f"{key}=[0.9,0.5]") == 0
    before = (tmp_path / "both/1/metrics.jsonl").read_text()
    assert call_train(*line, f"{key}=[0.9,0.5]") == 0
    assert capfd.readouterr().out.count("1 of 1 jobs done") == 2
    assert (tmp_path / "both/1/metrics.jsonl").read_text() == before
    assert call_train(*line, f"{key}=[0.9,0.7]") == 2
    assert "policy_learner.discount=[0.9,0.7]: with resume only" in capfd.readouterr().err


def test_a_folder_that_cannot_be_made_is_one_line(tmp_path, capfd):
    (tmp_path / "file").touch()
    assert call_train("-m", *SHORT, "seed=0,1", "hydra.sweep.dir=file") == 1
    assert only_line(capfd) == "hybrid_rl: [Errno 17] File exists: 'file'\n"
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_jobs_in_other_processes_are_shown_as_they_go(tmp_path):
    """One of them ends without a result, as where the system kills it.

    Submitit's local executor stands for Slurm: a process each, the same run folders.
    """
    (tmp_path / "fatal.py").write_text(
        "import os, signal\n"
        "from hybrid_rl.envs.analytic.pendulum import Pendulum\n"
        "class Fatal(Pendulum):\n"
        "    def reset(self, key):\n"
        "        if 'SUBMITIT_EXECUTOR' in os.environ:\n"
        "            os.kill(os.getpid(), signal.SIGKILL)\n"
        "        return super().reset(key)\n"
    )
    world = "env._target_=hybrid_rl.envs.analytic.pendulum.Pendulum,fatal.Fatal"
    line = [*SHORT, world, "hydra/launcher=submitit_local", "hydra.launcher.timeout_min=5"]
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    whole = [sys.executable, "-m", "hybrid_rl.train", "-m", *line]
    done = subprocess.run(whole, env=env, capture_output=True, text=True)
    assert done.returncode == 1, done.stderr
    for number in (0, 1):
        assert re.search(rf"job {number} sent: local \d+.*, log runs/sweeps/", done.stdout)
    assert "job 0 ends: training return" in done.stdout or "job 0 ends: eval" in done.stdout
    assert "job 1 ends: lost: " in done.stdout
    first, second = table(tmp_path)
    assert (first["code"], second["code"]) == (0, 1)
    assert summary_of(tmp_path / first["run_dir"])["finished"]


SLURM = ["-m", *TINY, "algo=sac,nn_mppi", "hydra/launcher=submitit_slurm"]


def test_what_slurm_gets_and_refuses(tmp_path):
    """An array of the jobs, with the settings of hydra.launcher; its refusal is one line."""
    kept = tmp_path / "batch.sh"
    refuse = "echo 'sbatch: error: invalid partition specified: big' >&2; exit 1"
    for name, script in {
        "srun": "exit 1",
        "sbatch": f'for file; do :; done; cp "$file" {kept}; {refuse}',
    }.items():
        (tmp_path / name).write_text(f"#!/bin/sh\n{script}\n")
        (tmp_path / name).chmod(0o755)
    launcher = {"gpus_per_node": 1, "partition": "big", "timeout_min": 600}
    line = [*SLURM, *(f"hydra.launcher.{key}={value}" for key, value in launcher.items())]
    env = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}"}
    whole = [sys.executable, "-m", "hybrid_rl.train", *line]
    done = subprocess.run(whole, env=env, capture_output=True, text=True)
    assert done.returncode == 2, done.stderr
    given = dict(re.findall(r"^#SBATCH --([\w-]+)=(.*)$", kept.read_text(), re.MULTILINE))
    wanted = {"array": "0-1%2", "gpus-per-node": "1", "partition": "big", "time": "600"}
    assert (wanted | {"job-name": "hybrid_rl"}).items() <= given.items()
    theirs, ours = done.stderr.splitlines()  # Submitit prints what sbatch wrote
    assert theirs == "sbatch: error: invalid partition specified: big"
    sent = "hybrid_rl: hydra/launcher=submitit_slurm: the jobs could not be sent: "
    assert ours == sent + theirs
    assert done.stdout.splitlines()[-1] == "0 of 2 jobs done; not 0, 1"


def test_a_launcher_that_is_not_installed_names_its_extra():
    error = MissingConfigException("", "hydra/launcher/submitit_slurm", ["basic"])
    line = explain(error)
    assert line.startswith("hydra/launcher=submitit_slurm: unknown; choose one of basic; ")
    assert line.endswith('need pip install "hybrid_rl[slurm]"')


def test_an_interrupt_ends_all_of_a_sweep(tmp_path):
    line = [*TINY, "algo=sac", "total_steps=100000000", "seed=0,1"]
    whole = [sys.executable, "-m", "hybrid_rl.train", "-m", *line]
    process = subprocess.Popen(whole, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        until = time.monotonic() + 120
        while not list(tmp_path.glob("runs/pendulum/sac/*/checkpoints/*")):
            assert time.monotonic() < until
            time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
    finally:
        process.kill()
    assert process.returncode == 130, err
    assert "0 of 2 jobs done; not 0, 1" in out
    assert "not run" in out
    assert [row["code"] for row in table(tmp_path)] == [130, None]
    assert len(list((tmp_path / "runs" / "pendulum" / "sac").iterdir())) == 1
