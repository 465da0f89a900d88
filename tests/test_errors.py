"""Wrong usage is one line that names key and value, and nothing on the disk changes."""

import shutil
import subprocess
import sys
from functools import partial
from importlib import import_module

import pytest
from omegaconf import OmegaConf
from tiny import call_command, call_train, contents, only_line, refusal, run

from hybrid_rl import render
from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.errors import UsageError
from hybrid_rl.settings import build as config
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.values import COUNTS

pytestmark = pytest.mark.turns(3)

NO_KEY = "hybrid_stochastic has no such key"
USAGE = [  # overrides of train, after task=pendulum algo=hybrid_stochastic; words of the line
    ("task=pendulm", "task=pendulm: unknown; choose one of ant, "),
    ("task=Hopper-v5", "walker2d; did you mean task=gymnasium env.id=Hopper-v5?"),
    ("algo=SAC", "in `python -m hybrid_rl.list`; did you mean sac?"),
    ("algo=dqn", "your own algo/dqn.yaml needs config_dir=FOLDER"),
    ("env=pendulum", "env=pendulum: must be a group of keys; did you mean task=pendulum?"),
    ("sed=3", f"sed: {NO_KEY}; did you mean seed?"),
    ("++planner.horizn=3", f"planner.horizn: {NO_KEY}; did you mean planner.horizon?"),
    (
        "algo=nn_mppi proposal=mixture",
        "has no proposal; did you mean proposal@model_proposal=mixture?",
    ),
    ("policy.target=1", f"policy.target: {NO_KEY}; policy has hidden, acti"),
    ("xyz=3", f"xyz: {NO_KEY}; `--cfg job` shows every key"),
    ("seed=${seeds}", "seed=${seeds}: hybrid_stochastic has no seeds"),
    ("total_steps 100", "total_steps: write KEY=VALUE, a list in quotes, 'KEY=[A, B]'"),
    ("run_dir=läufe", "run_dir=läufe: cannot be read; write key=value, text as 'key="),
    ("task=pendulum,cartpole", "Ambiguous value for argument 'task=pendulum,cartpole'; 1. To "),
    ("hydra/launcher=submitit_slurm", "submitit_slurm: no srun here; start it where Slurm is"),
    ("seed=4294967290 num_seeds=8", "must be a whole number, from 0 to 4294967288"),
    ("eval_modes=[full,both]", "eval_modes=both: choose one of full, policy, planner"),
    ("physics=bullet", "physics=bullet: choose one of auto, native, mjx, warp"),
    ("task=cartpole physics=warp", "physics=warp: must have an NVIDIA GPU"),
    ("algo=sac replay.capacity=9", "replay.capacity=9: holds less than one batch, policy_learner."),
    ("run_dir=/dev/null/run", "run_dir=/dev/null/run: cannot be written to (Not a directory)"),
    ("task=gymnasium algo=mppi", "mppi plans on the true dynamics, and this task st"),
    ("algo=nn_mppi planner=gradient", "rl: planner=gradient: nn_mppi learns no policy"),
    ("algo=sac planner=gradient", "rl: planner=gradient: sac learns no model"),
    ("algo=ppo planner=gradient", "rl: planner=gradient: ppo has no model\n"),
    ("algo=ppo planner=shooting", "rl: planner=shooting: ppo has no model"),
    ("algo=noise planner=shooting", "rl: planner=shooting: noise has no objective\n"),
    ("algo=sac model=gaussian", "rl: model=gaussian: sac has no model\n"),
    ("algo=kle3 settings=light", "In 'settings/light': Could not override 'proposal'"),
    ("algo=bc", "demonstrations=demonstrations/pendulum.npz: no such file; `python -m hybrid_rl"),
    ("resume=nowhere", "resume=nowhere: no run folder there"),
]
OTHERS = [  # command and its arguments, words of the line
    ("evaluate", "run, policy: give one of them"),
    ("evaluate run={begun}", "holds no checkpoint yet"),
    ("evaluate policy=cheetah", "policy=cheetah: no such file; choose a file, or one of "),
    ("evaluate run={trained} mode=planner", "mode=planner: choose one of full, policy"),
    ("evaluate run={trained} env.gravity=1", "got an unexpected keyword argument 'gravity'"),
    ("demonstrate task=hopper", "task=hopper: has no scripted expert; give expert=babble or run"),
    ("render run={trained} out=film.avi", "out=film.avi: must end in .mp4, .gif, .png"),
    ("list config_dir=nowhere", "config_dir=nowhere: no such folder"),
    ("train resume={trained} algo=nn_mppi", "algo=nn_mppi: with resume only total_steps and preci"),
    ("train resume={trained} total_steps=100", "has 600; it can be raised, not lowered"),
    ("train resume={begun}", "holds no checkpoint yet"),
    ("train run={begun}", "holds no checkpoint yet"),
    ("train run_dir={trained}", "holds a run already; choose another, or resume"),
    ("train run_dir={begun}", "holds a run already; choose another, or resume"),
]


@pytest.mark.parametrize(("given", "words"), USAGE, ids=[given for given, _ in USAGE])
def test_train_refuses(tmp_path, monkeypatch, capfd, given, words):
    monkeypatch.chdir(tmp_path)
    assert words in refusal(capfd, "task=pendulum", "algo=hybrid_stochastic", *given.split())
    assert contents(tmp_path) == {}


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


@pytest.mark.parametrize(("given", "words"), OTHERS, ids=[given for given, _ in OTHERS])
def test_runs_and_other_commands_refuse(nothing_lost, folders, monkeypatch, capfd, given, words):
    """Before anything is compiled or printed."""
    monkeypatch.setattr(offscreen, "backend", lambda: "egl")
    name, *arguments = given.format(**folders).split()
    ended = call_train
    if name != "train":
        ended = partial(call_command, import_module(f"hybrid_rl.{name}").main)
    assert ended(*arguments) == 2
    out, err = capfd.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert words in err


def test_a_process_says_one_line(nothing_lost):
    whole = [sys.executable, "-m", "hybrid_rl.train", "num_envs=2.5"]
    done = subprocess.run(whole, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("hybrid_rl: num_envs=2.5: ")
    assert done.stderr.count("\n") == 1


def test_render_says_what_to_install(nothing_lost, folders, monkeypatch, capfd):
    monkeypatch.setattr(offscreen, "TRIAL", "raise SystemExit(1)")
    monkeypatch.setattr(sys, "platform", "linux")
    offscreen.chosen.cache_clear()
    assert call_command(render.main, f"run={folders['trained']}") == 1
    assert "install libegl1 or libosmesa6" in only_line(capfd)


@pytest.mark.parametrize("value", [0, 2.5, "many"])
def test_counts_are_whole_numbers(value):
    """Every count of a run, and of the replay memory and an episode."""
    composed = config.load(["task=pendulum", "algo=sac"])
    for key in (*COUNTS, "replay.capacity", "episode.steps", "episode.action_repeat"):
        changed = composed.copy()
        OmegaConf.update(changed, key, value)
        with pytest.raises(UsageError, match=rf"{key.rpartition('.')[2]}={value}: must be a whole"):
            config.build(changed)


def test_memory_that_runs_out_is_one_line(capfd):
    """Where XLA itself finds out."""

    def fail():
        raise RuntimeError("RESOURCE_EXHAUSTED: Out of memory allocating 12 bytes.\nand more")

    assert call_command(fail) == 1
    assert "allocating 12 bytes.; fewer num_seeds or num_envs" in only_line(capfd)


def test_an_error_in_the_code_of_a_user_is_one_line_that_names_it(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text("def broken():\n    return {}['goal']\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert call_command(import_module("mine").broken) == 1
    assert only_line(capfd) == "hybrid_rl: mine.py:2: KeyError: 'goal'\n"


def test_a_fault_of_ours_is_a_traceback_without_frames_of_hydra(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(config, "resolve", lambda *_: None)
    assert call_train("task=pendulum", "algo=sac") == 1
    printed = capfd.readouterr().err
    assert printed.startswith("Traceback (most recent call last):")
    assert "run/launch.py" in printed
    assert "/hydra/" not in printed


@pytest.mark.parametrize("value", ["a", "it's", "[8,8]", "a\\", 'a\\"b', "007", "null", "a b", ""])
def test_a_value_in_quotes_is_read_as_it_was(value):
    (read,) = overrides.parse([f"run_dir={overrides.quoted(value)}"])
    assert read.value() == value
