"""Names of code in files from anybody: whatever key they stand under, they are judged first."""

import json
from pathlib import Path

import pytest
from foreign import METRIC, changed, made, refused
from tiny import call_command, contents, refusal

from hybrid_rl import (
    OnlineLearner,
    __version__,
    demonstrate,
    evaluate,
    export,
    figures,
    render,
    robot,
)
from hybrid_rl.envs.adapters.external import External
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.errors import UsageError
from hybrid_rl.files import targets as parts
from hybrid_rl.run import folder as run_folder
from hybrid_rl.settings import build as config
from hybrid_rl.tools.doctor import __main__ as doctor
from hybrid_rl.tools.report import __main__ as report
from hybrid_rl.tools.view import __main__ as view

ADAPTERS = "hybrid_rl.envs.adapters"
EXTERNAL = {"_target_": f"{ADAPTERS}.external.External"}
PLAYGROUND = {"_target_": f"{ADAPTERS}.playground.Playground"}
ROBOT = {"_target_": f"{ADAPTERS}.robot.Robot"}
WANTED = {"cmd": "touch ran", "command": "touch ran", "file": "ran", "path": "ran"}
GETOUTPUT = EXTERNAL | {"make": "subprocess:getoutput", "kwargs": {"cmd": "touch ran"}}
MINE = """
import subprocess as hidden
from os import system
from pickle import *
from subprocess import getoutput as run
try:
    from subprocess import check_output
except ImportError:
    def check_output(cmd): pass
open("ran", "w")
import gymnasium
class Env(gymnasium.Env):
    def popen(self): pass
def make(): return Env()
"""
NAMES = [
    *("subprocess:getoutput", "os:system", "builtins:exec", "pickle:loads", "runpy:run_path"),
    *("antigravity:webbrowser", "numpy:load", "pytest:main", "__main__:main"),
    *("hydra.utils:instantiate", "gymnasium:make", "gymnasium.envs.registration:make"),
    *("hybrid_rl.robot:main", "hybrid_rl.data.trained:save", "hybrid_rl.files.targets:imported"),
    *("hybrid_rl.envs.adapters.external:gymnasium", "hybrid_rl.envs.adapters.gymnasium:make"),
    *("scripts.bootstrap:main", "tests.tiny:call", "envs.gym:_register"),
    *("theirs.run.zz_evil:World", "theirs.zz_evil:World", "theirs:zz_evil"),
    *("zz_mine:system", "zz_mine:hidden", "zz_mine:run", "zz_mine:loads", "zz_mine:check_output"),
    *("zz_mine:popen", "zz_mine:Nowhere", "zz_mine:gymnasium"),
]
IDS = [
    *("antigravity:Pendulum-v1", "subprocess:lab/A-v0", "pip:A-v0", "theirs.zz_evil:lab/A-v0"),
    *("scripts.bootstrap:A-v0", "hybrid_rl.robot:A-v0", "zz_mine.sub:A-v0", "__main__:A-v0"),
]
SYSTEM = {"_target_": "os.system", "command": "true"}
TARGETS = [  # no parts
    *("os.system", "builtins.exec", "pydoc.pipepager", "subprocess.run", "this.s", "numpy.save"),
    *("antigravity.webbrowser", "yaml.unsafe_load", "__main__.x", "site.main", "pytest.main"),
    *("hybrid_rl.files.atomic.write_text", "hybrid_rl.analysis.results.RunFolder"),
    *("hybrid_rl.settings.build.Path", "hybrid_rl.settings.build.Run", "hybrid_rl.types.Spec"),
    *("hybrid_rl.data.trained.Path", "hybrid_rl.data.trained.save", "hybrid_rl.envs..os"),
    *("hybrid_rl..os.system", "hybrid_rl.run.machine.provenance.subprocess.run"),
    "hybrid_rl.envs.analytic.pendulum.jax.numpy.save",
    *("hybrid_rl.envs.analytic.pendulum.dataclass", "hybrid_rl.envs.analytic", "hybrid_rl"),
    *("hybrid_rl.envs.analytic.pendulum.Pendulum.reset", "hybrid_rl.scripts.bootstrap.main"),
    "h\u0443brid_rl.envs.analytic.pendulum.Pendulum",  # a Cyrillic letter
    *("hybrid_rl.theirs.run.zz_evil.World", "theirs.run.zz_evil.World", "theirs.zz_evil.World"),
    *("os\uff0esystem", " os.system", "os.system\n", "os/system", "../os.system", ""),
    *(None, 5, ["os.system"], SYSTEM),
]
NAMED = [  # what env has, and how the line about it begins
    *(({"_target_": name}, "_target_=") for name in TARGETS),
    *((EXTERNAL | {"make": name, "kwargs": WANTED}, f"make={name}: ") for name in NAMES),
    *((EXTERNAL | {"id": name, "kwargs": WANTED}, f"id={name}: ") for name in IDS),
]
EVERYWHERE = [  # what config.yaml has, and where in it a name stands
    ({"extra": SYSTEM}, "extra._target_=os.system"),
    ({"_target_": "os.system"}, "_target_=os.system"),
    ({"extra": [1, SYSTEM]}, "extra.1._target_=os.system"),
    ({"extra": [[[SYSTEM]]]}, "extra.0.0.0._target_=os.system"),
    ({"extra": {"_args_": [SYSTEM]}}, "extra._args_.0._target_=os.system"),
    ({"extra": {"_partial_": True, "a": SYSTEM}}, "extra.a._target_=os.system"),
    ({"extra": {"_recursive_": False, "a": SYSTEM}}, "extra.a._target_=os.system"),
    ({"hydra": {"launcher": SYSTEM}}, "hydra.launcher._target_=os.system"),
    ({"expert": SYSTEM}, "expert._target_=os.system"),
    ({"env": EXTERNAL | {"kwargs": {"a": [1, {"b": ["os:x"]}]}}}, "env.kwargs.a.1.b.0=os:x"),
    ({"env": EXTERNAL | {"kwargs": {"env_id": "os:A-v0"}}}, "env.kwargs.env_id=os:A-v0"),
    ({"env": PLAYGROUND | {"name": "os:system"}}, "env.name=os:system"),
    ({"env": ROBOT | {"make": "os:system", "kwargs": WANTED}}, "env.make=os:system"),
    *(({key: "os:system"}, f"{key}=os:system") for key in ("query", "logger", "new")),
    ({"recipe": ["task=x", "env.make=os:system"]}, "recipe=['task=x', 'env.make=os:system']"),
    ({"recipe": ["env={_target_:x,make:os:system}"]}, "recipe=['env={_target_:x,make:os:system}']"),
    ({"extra": [[["os:system"]]]}, "extra.0.0.0=os:system"),
    ({"extra": "see os:system"}, "extra=see os:system"),
    ({"learners": {"policy": {"make": "os:system"}}}, "learners.policy.make=os:system"),
]
COMMANDS = {  # what reads the run {}; None: train
    "evaluate run={}": evaluate.main,
    "export run={} out=a.stablehlo": export.main,
    "render run={}": render.main,
    "demonstrate run={}": demonstrate.main,
    "doctor run={}": doctor.main,
    "view run={}": view.main,
    "robot run={} learning=true": robot.main,
    "robot run={} mode=full": robot.main,
    "train resume={} total_steps=200": None,
    "train run={} total_steps=9 run_dir=mine": None,
}


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """A run folder in the current one, with a module of the user beside its parent."""
    path = made(tmp_path, monkeypatch)
    Path("zz_mine.py").write_text(MINE)
    (path / "checkpoints" / "5").mkdir(parents=True)
    (path / "robot").mkdir()
    return path


def judged(folder: Path, **keys: object) -> str:
    """What is refused in a short config.yaml with these keys; nothing is imported."""
    (folder.parent / "__init__.py").write_text("")
    (folder / "config.yaml").write_text(json.dumps({"version": __version__} | keys))
    return refused(folder).removeprefix(f"{folder}/config.yaml: ")


@pytest.mark.parametrize(("env", "begins"), NAMED, ids=[begins for _, begins in NAMED])
def test_a_name_that_is_no_part_is_refused(folder, env, begins):
    assert judged(folder, env=env).startswith(f"env.{begins}")


@pytest.mark.parametrize(("keys", "at"), EVERYWHERE, ids=[at for _, at in EVERYWHERE])
def test_it_is_refused_wherever_it_stands(folder, keys, at):
    assert judged(folder, **keys).startswith(f"{at}: is no part of hybrid_rl")


@pytest.mark.parametrize("line", COMMANDS)
def test_every_command_refuses_it(folder, capfd, line):
    changed(folder, env=GETOUTPUT)
    before, given = contents(Path()), line.format(folder).split()[1:]
    assert "env.make=subprocess:getoutput: is no part" in refusal(capfd, *given, of=COMMANDS[line])
    assert contents(Path()) == before


def test_no_learner_goes_on_with_it(folder):
    changed(folder, env=ROBOT | {"make": "os:system"})
    with pytest.raises(UsageError, match=r"env\.make=os:system: is no part"):
        OnlineLearner.load(folder)


@pytest.mark.parametrize("key", ["task", "algo"])
@pytest.mark.parametrize("name", ["../../theirs/evil", "sac,ddpg", "a b", ".."])
def test_a_run_chooses_no_file_of_others(folder, capfd, key, name):
    """For `train run=DIR` a word of it becomes an override."""
    (folder.parent / "evil.yaml").write_text("# @package _global_\nalgo: ${oc.env:HOME}\n")
    changed(folder, **{key: name})
    line = refusal(capfd, f"run={folder}", "total_steps=9", "run_dir=mine")
    assert f"{key}={name}: must be letters, digits" in line


def test_an_id_of_ours_makes_parts_only(monkeypatch, tmp_path):
    """Its keywords are fields of an environment of the package, not another class."""
    monkeypatch.chdir(tmp_path)
    kwargs = {"world": "subprocess.getoutput", "cmd": "touch ran"}
    with pytest.raises(UsageError, match="is no part of hybrid_rl"):
        External(id="hybrid_rl.envs.gym:hybrid_rl/Pendulum", kwargs=kwargs)
    assert not Path("ran").exists()
    External(id="hybrid_rl.envs.gym:hybrid_rl/Pendulum")


@pytest.mark.parametrize(
    "env",
    [
        EXTERNAL | {"make": "zz_mine:Env"},
        EXTERNAL | {"make": "zz_mine:make"},
        EXTERNAL | {"make": "zz_both:Env"},  # a package, whose module has it
        EXTERNAL | {"make": "zz_both.deep:Env"},
        EXTERNAL | {"make": "gymnasium.envs.classic_control.pendulum:PendulumEnv"},
        EXTERNAL | {"make": "gymnasium.envs.classic_control:PendulumEnv"},
        EXTERNAL | {"make": "zz_absent:Env"},  # which cannot be imported
        EXTERNAL | {"id": "zz_mine:lab/A-v0"},
        EXTERNAL | {"id": "Hopper-v5", "kwargs": {"device": "cuda:0", "at": "10:30", "a": "b: c"}},
        EXTERNAL | {"id": "zz_robots:Reach-v4"},  # an installed package that depends on Gymnasium
        EXTERNAL | {"id": "hybrid_rl.envs.gym:hybrid_rl/Pendulum"},
        ROBOT | {"make": "hybrid_rl.envs.adapters.stand_in:HalfCheetah"},
    ],
    ids=lambda env: env.get("make") or env["id"],
)
def test_a_name_of_ones_own_is_one_without_importing_it(folder, env, monkeypatch):
    installed = Path("site-packages").absolute()
    for path in ("zz_both", "site-packages/zz_robots", "site-packages/zz_robots-4.dist-info"):
        Path(path).mkdir(parents=True)
    Path("zz_both/__init__.py").write_text("from zz_both.deep import *\nfrom .deep import Env\n")
    Path("zz_both/deep.py").write_text(MINE)
    (installed / "zz_robots" / "__init__.py").write_text(MINE)
    metadata = "Name: zz_robots\nVersion: 4\nRequires-Dist: gymnasium>=1.0\n"
    (installed / "zz_robots-4.dist-info" / "METADATA").write_text(metadata)
    monkeypatch.syspath_prepend(str(installed))
    changed(folder, env=env)
    assert run_folder.read(folder, "run").env == env
    assert not Path("ran").exists()
    changed(folder, env=EXTERNAL | {"make": "zz_robots:Env"})
    assert "env.make=zz_robots:Env: is no part" in refused(folder)


def test_a_name_that_a_user_types_or_passes_is_the_users(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for line in ("env.make=json:loads", "env.id=antigravity:A-v0"):
        given = config.load(["task=gymnasium", "algo=sac", line])
        parts.check({"env": dict(given.env)})
    with pytest.raises(UsageError, match=r"env\.make=json:loads: TypeError"):
        External(make="json:loads")
    assert Robot(make="hybrid_rl.envs.adapters.stand_in:Cartpole").spec.act == 1


def test_a_class_of_the_user_is_a_part_and_a_function_is_none(folder):
    """Without importing the module; one that lies with the run is not the user's."""
    Path("zz_mine.py").write_text("open('ran', 'w')\nclass World:\n    pass\ndef made(): pass\n")
    changed(folder, env={"_target_": "zz_mine.World"})
    assert run_folder.read(folder, "run").env._target_ == "zz_mine.World"
    assert not Path("ran").exists()
    changed(folder, env={"_target_": "zz_mine.made"})
    assert "zz_mine.py has no class made" in refused(folder)
    changed(folder, env={"_target_": "theirs.zz_evil.World"})
    assert f"move {folder} out of {folder.parent}" in refused(folder)


def test_words_that_a_terminal_or_matplotlib_obeys_are_shown_as_they_are(folder, capfd):
    """In a line of ours, and in a picture."""
    (folder / "checkpoints" / "5").rmdir()
    changed(folder, task="$\\undefined{x}$", algo="$y_{$")
    for main, out in ((report.main, "a.html"), (figures.main, "a.svg")):
        line = [f"run={folder}"] if main is report.main else [f"runs={folder}", METRIC]
        line.append(f"out={out}")
        assert call_command(main, *line) == 0
    assert "$\\undefined{x}$" in Path("a.svg").read_text()
    capfd.readouterr()
    changed(folder, env={"_target_": "a\x1b]0;title\x07\nhybrid_rl: done"})
    line = refusal(capfd, f"run={folder}", of=evaluate.main)
    assert "\\x1b]0;title\\x07\\nhybrid_rl: done" in line
    assert line.strip().isprintable()


def test_a_folder_does_not_say_where_programs_are_kept(folder, tmp_path):
    changed(folder, compile_cache=str(tmp_path / "precious"))
    default = config.load([]).compile_cache
    assert run_folder.read(folder, "run").compile_cache == default
