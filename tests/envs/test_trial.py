"""Worlds and tasks of one's own: what is wrong is one line that names the file."""

import re
import sys
from importlib import import_module

import jax
import pytest
from worlds import TASKS, make

from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.envs import check
from hybrid_rl.errors import UsageError
from hybrid_rl.settings import build as config
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Params

WORLD = """from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.envs.mujoco.physics import Physics
from hybrid_rl.types import EnvState, Spec


@dataclass(frozen=True)
class W:
    gain: float = 1.0
    spec = Spec(obs=2, act=1, dt=0.05)

    def reset(self, key):
        x = jax.random.uniform(key, (2,))
        return self._state(x, jnp.zeros(()))

    def step(self, state, action):
        x = jnp.stack([state.data[1], action[0]])
        return self._state(x, -(x**2).sum())

    def _state(self, x, reward):
        no = jnp.zeros((), bool)
        return EnvState(x, x, reward, no, no, {}, {})
"""
TASK = """# @package _global_
# A broken world.
task: broken
env: {_target_: w.W, gain: 2.0}
episode: {steps: 20, action_repeat: 1}
random_steps: 10
total_steps: 50
eval_every: 50
eval_episodes: 1
checkpoint_every: 50
"""
STATE = "EnvState(x, x, reward, no, no, {}, {})"
LINE = "x = jnp.stack([state.data[1], action[0]])"  # of step
PAID = "-(x**2).sum()"
IF = "x = state.data if state.data[0] > 0 else -state.data"
EQUILIBRIUM = "    def equilibrium(self):\n        return jnp.zeros(2)\n\n    def step(self"
ABSENT = 'Physics("/rial.xml").reset(jnp.zeros(1), jnp.zeros(1))'
WORLDS = [  # of WORLD: replaced, by what, the line after "w.py:LINE: W"
    ("obs=2", "obs=4", r"\.reset: returned obs float32\[2\]; it must be float32\[4\], .* is 4"),
    (PAID, "-(x[:1] ** 2)", r"\.step: returned reward float32\[1\]; it must be float32\[\]"),
    (STATE, "EnvState(x, x, reward, 0.0, no, {}, {})", r"\.reset: returned terminated float32.*"),
    (f"self._state(x, {PAID})", "x, 0.0, False, {}", r"\.step: returned a tuple of 4; it must .*"),
    ("    spec = Spec(obs=2, act=1, dt=0.05)\n", "", r": spec is None; it must be Spec\(obs=.*"),
    ("def reset", "def restart", r" has no reset; see protocols\.Env"),
    (LINE, IF, r"\.step: TracerBoolConversionError: .*; write jnp\.where or .* of `if`"),
    ("    def step(self", EQUILIBRIUM, r"\.equilibrium: returned float32\[2\]; .* \(obs, action\)"),
    ("x = jax.random.uniform(key, (2,))", ABSENT, r"\.reset: ValueError: /rial\.xml: no such file"),
]
FILE = r"my_conf/task/broken\.yaml"
GYM = "_target_: gymnasium.make, id: Pendulum-v1"
TASK_FILES = [  # of both: replaced, by what, the whole line
    ("gain: 2.0", "gian: 2.0", r"env: W\.__init__\(\) got an unexpected keyword argument 'gian'"),
    ("w.W", "w.V", r"env\._target_=w\.V: w\.py has no class V"),
    ("state, action):", "state, action:", r"env\._target_=w\.W: w\.py:20: '\(' was never closed"),
    ("# @package _global_\n", "", rf"{FILE}: its first line must be # @package.*"),
    ("eval_episodes: 1\n", "", rf"{FILE}: lacks eval_episodes; .*"),
    ("_target_: w.W, gain: 2.0", GYM, r"env\._target_=gymnasium\.make: makes a gymnasium\.Env, .*"),
]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A working folder for w.py and its task file."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    (tmp_path / "my_conf" / "task").mkdir(parents=True)
    (tmp_path / "my_conf" / "algo").mkdir()
    yield tmp_path
    sys.modules.pop("w", None)


def world(folder, *changes):
    """An instance of the class in w.py, with these changes of its text."""
    code = WORLD
    for old, new in changes:
        assert old in code
        code = code.replace(old, new)
    (folder / "w.py").write_text(code)
    return import_module("w").W()


def write(folder, code=WORLD, task=TASK, algo=""):
    """A world, its task file, and a method."""
    (folder / "w.py").write_text(code)
    (folder / "my_conf" / "task" / "broken.yaml").write_text(task)
    (folder / "my_conf" / "algo" / "own.yaml").write_text(f"# @package _global_\n{algo}")


@pytest.mark.parametrize(("old", "new", "line"), WORLDS)
def test_a_world_is_refused_in_a_line_with_its_file(folder, old, new, line):
    with pytest.raises(UsageError) as refusal:
        check(world(folder, (old, new)))
    assert re.fullmatch(rf"w\.py:\d+: W{line}", str(refusal.value))


@pytest.mark.parametrize(("old", "new", "line"), TASK_FILES)
def test_files_that_make_no_run_are_refused_in_a_line(folder, old, new, line):
    texts = [text.replace(old, new) for text in (WORLD, TASK)]
    assert texts != [WORLD, TASK]
    write(folder, *texts)
    with pytest.raises(UsageError) as refusal:
        config.build(config.load(["task=broken", "algo=sac"], "my_conf"))
    assert re.fullmatch(line, str(refusal.value))


def test_a_world_may_keep_keys_flags_of_numpy_and_information_of_its_own(folder):
    """`info` that step leaves out stays; a state needs neither metrics nor info."""
    check(world(folder, (STATE, "EnvState(x, x, reward)")))
    sys.modules.pop("w")
    changes = [
        ("no = jnp.zeros((), bool)", "no = np.zeros((), bool)"),
        ("self._state(x, jnp.zeros(()))", "self._state(x, 0.0).replace(info={'goal': x})"),
        (LINE, "x = state.info['goal'] + jax.random.normal(KEY, (2,))"),
        ("@dataclass", "KEY = jax.random.key(3)\n\n\n@dataclass"),
    ]
    check(world(folder, *changes))


@pytest.mark.parametrize("value", ["3", "True", "x[0] > 0"])
def test_a_metric_may_be_any_one_number(folder, value):
    """Also where no `vmap` makes arrays of Python's numbers, as in demonstrations."""
    made = world(folder, (STATE, f"EnvState(x, x, reward, no, no, {{'count': {value}}})"))
    check(made)
    episode, key = Episode(made, steps=3), jax.random.key(0)
    states = rollout_with_actions(episode, ConstantController(), Params(), key, 3)[1]
    assert states.metrics["count"].shape == (4,)


@pytest.mark.parametrize("task", TASKS)
def test_the_worlds_of_the_library_pass(task):
    check(make(task, "native"))


def test_a_task_file_takes_defaults_of_its_world_and_sets_keys_of_any_method(folder):
    own = TASK.replace(", gain: 2.0", ', gain: "${strength}"')
    write(folder, task=f"{own}strength: 3.0\nplanner: {{samples: 9}}\n")
    assert config.load(["task=broken", "algo=sac"], "my_conf").env.gain == 3.0
    write(folder, task=TASK.replace(", gain: 2.0", ""))
    assert config.load(["task=broken", "algo=sac"], "my_conf").env.gain == 1.0
    assert config.load(["task=broken", "algo=sac", "env.gain=3"], "my_conf").env.gain == 3


@pytest.mark.parametrize("begins", ["algo@_global_: sac", "family@_global_: hybrid"])
def test_a_task_or_a_method_without_a_name_has_that_of_its_file(folder, begins):
    """Its runs would lie among those of what it begins with, and share their curve."""
    inherits = "defaults: [/task@_global_: pendulum, _self_]\n"
    acts = "" if "sac" in begins else "controllers: {full: '${actor}'}\n"
    task = TASK.replace("task: broken\n", inherits)
    write(folder, task=task, algo=f"defaults: [/{begins}, _self_]\n{acts}")
    assert config.load(["task=broken", "algo=sac"], "my_conf").task == "broken"
    assert config.load(["task=pendulum", "algo=own"], "my_conf").algo == "own"
