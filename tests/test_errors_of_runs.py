"""Wrong usage of the commands that read a run is one line, and nothing on the disk changes."""

import shutil
import subprocess
import sys

import pytest
from tiny import TINY, call, call_train, contents, only_line, run

from hybrid_rl import demonstrate, evaluate, figures, render
from hybrid_rl import list as listed
from hybrid_rl.cli import command
from hybrid_rl.envs.mujoco import offscreen

pytestmark = pytest.mark.turns(3)

MAINS = {
    "demonstrate": demonstrate.main,
    "evaluate": evaluate.main,
    "render": render.main,
    "figures": figures.main,
    "list": listed.main,
}


COUNT = "must be a whole number, 1 or more"


OTHERS = [  # command and its arguments, exit code, words of the line
    ("evaluate", 2, "run, policy: give one of them"),
    ("evaluate policy=cheetah", 2, "policy=cheetah: no such file; choose a file, or one of "),
    ("evaluate policy={trained}", 2, "trained: no such file; choose a file, or one of "),
    ("evaluate run=nowhere", 2, "run=nowhere: no run folder there"),
    ("evaluate run={begun}", 2, "holds no checkpoint yet"),
    ("evaluate run=nowhere mode=both", 2, "mode=both: choose one of full, policy, planner"),
    ("evaluate run={trained} mode=planner", 2, "mode=planner: the run has full, policy"),
    ("evaluate run={trained} episodes=0", 2, f"episodes=0: {COUNT}"),
    ("evaluate run={trained} episode.late=1", 2, "episode.late: Episode has steps, "),
    ("evaluate run={trained} env.gravity=1", 2, "env.gravity: Pendulum has no fields"),
    ("evaluate policy=cartpole env.reward=up", 2, "env.reward=up: choose one of cos"),
    ("evaluate run={trained} episodes=2.5", 2, f"episodes=2.5: {COUNT}"),
    ("evaluate run={trained} episode=3", 2, "episode=3: unknown argument; give key=value with run"),
    ("evaluate {trained}", 2, "trained: write run=/"),
    ("demonstrate", 2, "task, run: give one of them"),
    (
        "demonstrate task=hopper",
        2,
        "task=hopper: has no scripted expert; give expert=babble or run=DIR",
    ),
    ("demonstrate task=aunt", 2, "task=aunt: unknown; choose one of"),
    ("demonstrate run=nowhere mode=both", 2, "mode=both: choose one of full, policy, planner"),
    ("demonstrate run={trained} out=file.csv", 2, "out=file.csv: must end in .npz"),
    ("render run=nowhere", 2, "run=nowhere: no run folder there"),
    ("render run={trained} out=film.avi", 2, "out=film.avi: must end in .mp4, .gif, .png"),
    ("render run=nowhere mode=plicy", 2, "mode=plicy: choose one of full, policy, planner, train"),
    ("render run={trained} mode=planner", 2, "mode=planner: the run has full, policy"),
    ("render run={trained} mode=training", 2, "learns no belief over two coordinates, which"),
    ("figures runs=nowhere/*", 2, "runs=nowhere/*: no run there"),
    ("figures runs={trained} metric=train/reward", 2, "metric=train/reward: not in these runs"),
    ("figures runs={trained} out=curve.txt", 2, "out=curve.txt: must end in .png"),
    (
        "figures runs={trained} out=/dev/null/a.png",
        2,
        "out=/dev/null/a.png: there is no folder /dev/null",
    ),
    ("figures runs={trained} out={trained}", 2, "must end in .png"),
    ("figures {trained}", 2, 'unknown argument; quote the pattern: runs="GLOB"'),
    ("figures rums={trained}", 2, "threshold, others (did you mean runs?)"),
    ("figures --runs {trained}", 2, "--runs: write runs="),
    (
        "render task=panda_stack out=/dev/null/a.mp4",
        2,
        "a.mp4: there is no folder /dev/null",
    ),
    ("demonstrate task=panda_stack out=/dev/null/a.npz", 2, "a.npz: there is no folder /dev/null"),
    ("evaluate run = {trained}", 2, "run: write run="),
    ("evaluate run={trained} --config-dir mine", 2, "--config-dir: write config_dir=mine"),
    ("list tasks", 2, "tasks: unknown argument; give key=value with config_dir"),
    ("list config_dir=nowhere", 2, "config_dir=nowhere: no such folder"),
]


RESUMED = [  # overrides given with resume, words of the line
    ("task=cartpole", "task=cartpole: with resume only total_steps and precision"),
    ("algo=nn_mppi", "algo=nn_mppi: with resume only total_steps and precision"),
    ("seed=7", "has 0"),
    ("policy.hidden=[8,8]", "policy.hidden=[8,8]: with resume only total_steps and precision"),
    ("experiment=thesis/fig_3_2_pendulum", "with resume only total_steps and precision"),
    ("total_steps=100", "has 600; it can be raised, not lowered"),
    ("precision=half", "hybrid_rl: precision=half: choose one of auto, mixed, bf16"),
    ("total_steps=1e9", f"total_steps=1e9: {COUNT}"),
    ("total_steps=3000000000", "total_steps=3000000000: must be at most 2147483647: "),
]


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """A run that is done, and one that never reached a checkpoint."""
    folder = tmp_path_factory.mktemp("folders")
    run(folder / "trained", "algo=sac")
    (folder / "begun").mkdir()
    shutil.copy(folder / "trained" / "config.yaml", folder / "begun")
    return {"trained": folder / "trained", "begun": folder / "begun"}


@pytest.fixture
def nothing_lost(folders, tmp_path, monkeypatch):
    """No file is made, changed or gone."""
    monkeypatch.chdir(tmp_path)
    folder = folders["trained"].parent
    before = contents(folder)
    yield
    assert contents(folder) == before
    assert contents(tmp_path) == {}


@pytest.mark.parametrize(("given", "code", "words"), OTHERS, ids=[given for given, *_ in OTHERS])
def test_the_other_commands_refuse(nothing_lost, folders, monkeypatch, capfd, given, code, words):
    monkeypatch.setattr(offscreen, "backend", lambda: "egl")
    name, *arguments = given.format(**folders).split()
    assert call(lambda: command.run(MAINS[name]), *arguments) == code
    out, err = capfd.readouterr()
    assert (out, err.count("\n")) == ("", 1)  # nothing was compiled before
    assert words in err


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("train num_envs=2.5", "num_envs=2.5: must be"),
        ("train config_dir=nowhere", "config_dir=nowhere: no such folder"),
        ("evaluate run=nowhere", "run=nowhere: no run folder"),
    ],
)
def test_a_process_says_one_line(nothing_lost, line, words):
    name, *arguments = line.split()
    whole = [sys.executable, "-m", f"hybrid_rl.{name}", *arguments]
    done = subprocess.run(whole, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert words in done.stderr


@pytest.mark.parametrize(("given", "words"), RESUMED, ids=[given for given, _ in RESUMED])
def test_resume_refuses_other_settings(nothing_lost, folders, capfd, given, words):
    assert call_train(f"resume={folders['trained']}", given) == 2
    assert words in only_line(capfd)


def test_resume_needs_a_checkpoint(nothing_lost, folders, capfd):
    assert call_train(f"resume={folders['begun']}") == 2
    assert "holds no checkpoint yet" in only_line(capfd)


def test_a_run_is_never_written_over(nothing_lost, folders, capfd):
    assert call_train(*TINY, "algo=sac", f"run_dir={folders['trained']}") == 2
    printed = only_line(capfd)
    assert "holds a run already; choose another, or resume=" in printed
    assert call_train(*TINY, "algo=sac", f"run_dir={folders['begun']}") == 2
    assert "holds a run without a checkpoint; delete it, or choose another" in only_line(capfd)


def test_render_says_what_to_install(nothing_lost, folders, monkeypatch, capfd):
    monkeypatch.setattr(offscreen, "TRIAL", "raise SystemExit(1)")
    monkeypatch.setattr(sys, "platform", "linux")
    offscreen.chosen.cache_clear()
    code = call(lambda: command.run(render.main), f"run={folders['trained']}")
    assert code == 1
    assert "install libegl1 or libosmesa6" in only_line(capfd)
