"""A world of one's own that is wrong: one line names its file, and what it must be."""

import re
import sys
from importlib import import_module

import pytest
from tiny import call_train
from worlds import TASKS, make

from hybrid_rl import config
from hybrid_rl.envs import check
from hybrid_rl.errors import UsageError

WORLD = """from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np

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
CRANE = """from dataclasses import dataclass
from pathlib import Path

import jax.numpy as jnp

from hybrid_rl.envs.mujoco.physics import Physics
from hybrid_rl.types import EnvState, Spec

ASSET = str(Path(__file__).with_name("rail.xml"))


@dataclass(frozen=True)
class W:
    physics: str = "auto"
    spec = Spec(obs=2, act=1, dt=0.05)

    def reset(self, key):
        physics = Physics(ASSET, self.physics)
        return self._state(physics.reset(jnp.zeros(1), jnp.zeros(1)))

    def step(self, state, action):
        return self._state(Physics(ASSET, self.physics).step(state.data, action, 10))

    def _state(self, data):
        x, no = jnp.concatenate([data.qpos, data.qvel]), jnp.zeros((), bool)
        return EnvState(data, x, -x[0] ** 2, no, no, {}, {})
"""
RAIL = """<mujoco>
  <option timestep="0.005"><flag autoreset="disable"/></option>
  <worldbody><body><joint name="rail" type="slide"/><geom size="0.1"/></body></worldbody>
  <actuator><motor joint="rail"/></actuator>
</mujoco>
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
CODE = [  # of the world: what is wrong, replaced, by what, the whole line
    (
        "reward not a number",
        "-(x**2).sum()",
        "jnp.nan * x.sum()",
        r"w\.py:19: W\.step: reward is nan at decision 1, after obs \[0\..*\] and action \[.*\]",
    ),
    (
        "state explodes",
        LINE,
        "x = 1e6 * (state.data + 1) ** 3",
        r"w\.py:19: W\.step: reward is -inf at decision 2, after obs \[6\.\d+e\+06, .*",
    ),
    (
        "obs smaller than the spec",
        "obs=2",
        "obs=4",
        r"w\.py:15: W\.reset: returned obs float32\[2\]; it must be float32\[4\], as spec\.obs "
        r"is 4: return 4 numbers, or write Spec\(obs=2, \.\.\.\)",
    ),
    (
        "obs with an axis too many",
        STATE,
        "EnvState(x, x[None], reward, no, no, {}, {})",
        r"w\.py:15: W\.reset: returned obs float32\[1, 2\]; it must be float32\[2\], as .*",
    ),
    (
        "reward with an axis",
        "-(x**2).sum()",
        "-(x[:1] ** 2)",
        r"w\.py:19: W\.step: returned reward float32\[1\]; it must be float32\[\]: sum it, .*",
    ),
    (
        "terminated a number",
        STATE,
        "EnvState(x, x, reward, 0.0, no, {}, {})",
        r"w\.py:15: W\.reset: returned terminated 0\.0 of Python \(float\); it must be bool\[\]: "
        r"write a comparison, or jnp\.zeros\(\(\), bool\)",
    ),
    (
        "another dtype in reset",
        "self._state(x, jnp.zeros(()))",
        "self._state(x, jnp.zeros(())).replace(data=jnp.zeros(2, int))",
        r"w\.py:19: W\.step: returned data float32\[2\], and W\.reset data int32\[2\]; both .*",
    ),
    (
        "a list in reset, a tuple in step",
        "self._state(x, jnp.zeros(()))",
        "self._state(x, jnp.zeros(())).replace(data=[x[0], x[1]])",
        r"w\.py:19: W\.step: returned .*",
    ),
    (
        "metrics in step alone",
        "self._state(x, -(x**2).sum())",
        "self._state(x, -(x**2).sum()).replace(metrics={'speed': x[0]})",
        r"w\.py:19: W\.step: returned metrics\.speed float32\[\], and W\.reset no metrics\.speed; "
        r"both must be equal",
    ),
    (
        "step returns nothing",
        "return self._state(x, -(x**2).sum())",
        "self._state(x, -(x**2).sum())",
        r"w\.py:19: W\.step: returned None; it must be an EnvState",
    ),
    (
        "step returns a tuple",
        "return self._state(x, -(x**2).sum())",
        "return x, 0.0, False, False, {}",
        r"w\.py:19: W\.step: returned a tuple of 5, as Gymnasium's do; it must be an EnvState",
    ),
    (
        "no spec",
        "    spec = Spec(obs=2, act=1, dt=0.05)\n",
        "",
        r"w\.py:10: W has no spec; write spec = Spec\(obs=\.\.\., act=\.\.\., dt=\.\.\.\)",
    ),
    (
        "step without an action",
        "def step(self, state, action):",
        "def step(self, state):",
        r"w\.py:19: W\.step\(state\): must be step\(self, state, action\)",
    ),
    (
        "no reset",
        "def reset",
        "def restart",
        r"w\.py:10: W has no reset; write def reset\(self, key\)",
    ),
    ("dt of zero", "dt=0.05", "dt=0.0", r"w\.py:10: W: spec\.dt is 0\.0; it must be .* above 0"),
    (
        "raise in reset",
        "x = jax.random.uniform(key, (2,))",
        'raise ValueError("my table is empty")',
        r"w\.py:16: W\.reset: ValueError: my table is empty",
    ),
    (
        "a key that is missing",
        "x = jnp.stack([state.data[1], action[0]])",
        "x = state.info['goal']",
        r"w\.py:20: W\.step: KeyError: 'goal'",
    ),
    (
        "an if on a traced value",
        LINE,
        "x = state.data if state.data[0] > 0 else -state.data",
        r"w\.py:20: W\.step: TracerBoolConversionError: .*; write jnp\.where or .* of `if`",
    ),
    (
        "NumPy on a traced value",
        LINE,
        "x = np.sin(state.data)",
        r"w\.py:20: W\.step: TracerArrayConversionError: .*; write jnp in place of np",
    ),
    (
        "an attribute that changes",
        LINE,
        "self.gain = 2.0",
        r"w\.py:20: W\.step: FrozenInstanceError: cannot assign to field 'gain'; what changes .*",
    ),
    (
        "three values of two",
        LINE,
        "x, y, z = state.data",
        r"w\.py:20: W\.step: ValueError: not enough values to unpack \(expected 3, got 2\)",
    ),
    (
        "a random number of NumPy",
        LINE,
        "x = state.data + np.random.normal(size=2).astype(np.float32)",
        r"w\.py:19: W\.step: gives other numbers when it is traced again: what NumPy .*",
    ),
    (
        "a random number of Python",
        "x = jax.random.uniform(key, (2,))",
        "import random; x = random.random() * jnp.ones(2)",
        r"w\.py:15: W\.reset: gives other numbers when it is traced again: .* use jax\.random.*",
    ),
]
SIMULATED = [  # the same of a world in MuJoCo; None: of its model
    (
        "two actions for one actuator",
        "act=1",
        "act=2",
        r"w\.py:21: W\.step: gives the physics 2 controls, and its model has 1 actuators; .* is 2",
    ),
    (
        "no such file",
        '"rail.xml"',
        '"rial.xml"',
        r"w\.py:\d+: W\.reset: ValueError: .*/rial\.xml: no such file",
    ),
    (
        "two joints of one",
        "reset(jnp.zeros(1),",
        "reset(jnp.zeros(2),",
        r"w\.py:19: W\.reset: ValueError: qpos has the shape \(2,\); the model's has \(1,\)",
    ),
    (
        "an unknown sensor",
        "-x[0] ** 2",
        'Physics(ASSET).sensor(data, "hand")[0]',
        r"""w\.py:26: W\.reset: KeyError: "Invalid name 'hand'\. Valid names: \[\]\"""",
    ),
    (
        "a motor of a joint that is not there",
        None,
        ('<motor joint="', '<motor joint="un'),
        r"w\.py:19: W\.reset: ValueError: .*/rail\.xml: Error: unknown transmission target 'un.*",
    ),
    (
        "a model that resets itself",
        None,
        ('<flag autoreset="disable"/>', ""),
        r"w\.py:19: W\.reset: ValueError: .*/rail\.xml: write <option><flag autoreset=.*",
    ),
    (
        "a model that is no MJCF",
        None,
        ('type="slide"', 'kind="slide"'),
        r"w\.py:19: W\.reset: ValueError: .*/rail\.xml: XML Error: .*, line 3",
    ),
]
GYMNASIUM = """import gymnasium


class W(gymnasium.Env):
    def __init__(self, gain): ...

    def reset(self, seed=None, options=None): ...

    def step(self, action): ...
"""
HOWTO = (
    r"a gymnasium\.Env, and this must be a class with JAX functions; task=gymnasium env\.make=.*"
)
FILES = [  # of Python and YAML: what is wrong, file, replaced, by what, the whole line
    (
        "a plain class",
        "py",
        "@dataclass(frozen=True)\nclass W:\n    gain: float = 1.0",
        "class W:",
        r"env\.gain: W in w\.py is no dataclass \(@dataclass\(frozen=True\)\), and has no fields",
    ),
    (
        "an unknown field",
        "yaml",
        "gain:",
        "gian:",
        r"env\.gian: W in w\.py has gain; did you mean gain\?",
    ),
    ("no such class", "yaml", "w.W", "w.V", r"env\._target_=w\.V: w\.py has no class V"),
    (
        "no such module",
        "yaml",
        "w.W",
        "theirs.W",
        r"env\._target_=theirs\.W: is no part of hybrid_rl; put its folder on PYTHONPATH .*",
    ),
    (
        "a syntax error",
        "py",
        "def step(self, state, action):",
        "def step(self, state, action:",
        r"env\._target_=w\.W: w\.py:19: '\(' was never closed",
    ),
    (
        "an import of what is not there",
        "py",
        "import numpy",
        "import torchh",
        r"env\._target_=w\.W: w\.py:5: ModuleNotFoundError: No module named 'torchh'",
    ),
    (
        "keys at the wrong level",
        "yaml",
        "# @package _global_\n",
        "",
        r"my_conf/task/broken\.yaml: its first line must be # @package _global_",
    ),
    ("no task", "yaml", "task: broken\n", "", r"my_conf/task/broken\.yaml: lacks task; set .*"),
    (
        "no env",
        "yaml",
        "env: {_target_: w.W, gain: 2.0}\n",
        "",
        r"my_conf/task/broken\.yaml: lacks env; .*",
    ),
    (
        "no intervals",
        "yaml",
        "eval_every: 50\neval_episodes: 1\n",
        "",
        r"my_conf/task/broken\.yaml: lacks eval_every, eval_episodes; set them, or begin with .*",
    ),
    (
        "an unknown key",
        "yaml",
        "eval_every",
        "rewrad_scale: 3\neval_every",
        r"my_conf/task/broken\.yaml: rewrad_scale: unknown key, which nothing reads.*",
    ),
    (
        "a tab",
        "yaml",
        "episode: {steps: 20, action_repeat: 1}",
        "episode:\n\tsteps: 20",
        r"my_conf/task/broken\.yaml:\d: is no YAML: .*",
    ),
    (
        "an unknown key of episode",
        "yaml",
        "{steps:",
        "{step:",
        r"my_conf/task/broken\.yaml: episode\.step: .*mean steps\?",
    ),
    (
        "no class of env",
        "yaml",
        "_target_: w.W, ",
        "",
        r"my_conf/task/broken\.yaml: env lacks _target_; write .*",
    ),
    (
        "an environment of Gymnasium",
        "yaml",
        "_target_: w.W, gain: 2.0",
        "_target_: gymnasium.make, id: Pendulum-v1",
        r"env\._target_=gymnasium\.make: makes " + HOWTO,
    ),
    ("a class of Gymnasium", "py", WORLD, GYMNASIUM, r"w\.py:4: W is " + HOWTO),
]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A working folder with a world, its task file and a model."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    (tmp_path / "my_conf" / "task").mkdir(parents=True)
    yield tmp_path
    sys.modules.pop("w", None)


def world(folder, code, model=RAIL):
    """An instance of the class in w.py."""
    (folder / "w.py").write_text(code)
    (folder / "rail.xml").write_text(model)
    return import_module("w").W()


def changed(text, old, new):
    assert old in text
    return text.replace(old, new)


def refused(line, check, *arguments):
    with pytest.raises(UsageError) as refusal:
        check(*arguments)
    assert re.fullmatch(line, str(refusal.value)), str(refusal.value)


@pytest.mark.parametrize(("old", "new", "line"), [c[1:] for c in CODE], ids=[c[0] for c in CODE])
def test_a_world_is_refused_in_a_line_with_its_file(folder, old, new, line):
    refused(line, check, world(folder, changed(WORLD, old, new)))


@pytest.mark.parametrize(
    ("old", "new", "line"), [c[1:] for c in SIMULATED], ids=[c[0] for c in SIMULATED]
)
def test_a_world_in_mujoco_is_refused_in_a_line_with_its_file(folder, old, new, line):
    code, model = (CRANE, changed(RAIL, *new)) if old is None else (changed(CRANE, old, new), RAIL)
    refused(line, check, world(folder, code, model))


@pytest.mark.parametrize(
    ("file", "old", "new", "line"), [c[1:] for c in FILES], ids=[c[0] for c in FILES]
)
def test_files_that_make_no_run_are_refused_in_a_line(folder, file, old, new, line):
    texts = {"py": WORLD, "yaml": TASK}
    texts[file] = changed(texts[file], old, new)
    write(folder, texts["py"], texts["yaml"])
    refused(line, lambda: config.build(config.load(["task=broken", "algo=sac"], "my_conf")))


def write(folder, code=WORLD, task=TASK):
    """A world and its task file."""
    (folder / "w.py").write_text(code)
    (folder / "my_conf" / "task" / "broken.yaml").write_text(task)


def test_what_is_seldom_meant_is_a_note_of_the_run(folder):
    ends = changed(WORLD, "EnvState(x, x, reward, no,", "EnvState(x, x, reward, ~no,")
    write(folder, ends, changed(TASK, "episode: {steps: 20, action_repeat: 1}\n", ""))
    run = config.build(config.load(["task=broken", "algo=sac"], "my_conf"))
    assert run.notes == (
        "w.py:19: W.step: every episode ended after one decision, of 10 tried",
        "episode.steps is not set by the task: 1,000 decisions an episode",
    )


def test_settings_do_not_change_a_task_silently(folder, capfd):
    """What is typed is not listed; nothing is, if nothing changes."""
    write(folder)
    line = (
        "settings=light changes what my_conf/task/broken.yaml says: random_steps 10 -> 5000, "
        "eval_every 50 -> 3000, eval_episodes 1 -> 5, checkpoint_every 50 -> 10000; to keep that, "
        "add random_steps=10 eval_every=50 eval_episodes=1 checkpoint_every=50"
    )
    given = ["task=broken", "settings=light", "total_steps=50"]
    with pytest.warns(UserWarning, match=f"^{re.escape(line)}$"):
        config.load(given, "my_conf")
    assert call_train("--config-dir", "my_conf", *given, "seed=-1") == 2
    assert capfd.readouterr().out == f"{line}\n"
    config.load(["task=broken"], "my_conf")
    config.load(["task=pendulum", "settings=light"], "my_conf")


def test_a_task_file_may_set_keys_of_any_method_and_its_own_where_they_are_read(folder):
    own = (
        changed(TASK, "gain: 2.0", 'gain: "${strength}"') + "strength: 3.0\nplanner: {samples: 9}\n"
    )
    write(folder, task=own)
    assert config.load(["task=broken", "algo=sac"], "my_conf").env.gain == 3.0


def test_a_world_may_keep_keys_flags_of_numpy_and_information_of_its_own(folder):
    """`info` that step leaves out stays."""
    odd = changed(WORLD, "no = jnp.zeros((), bool)", "no = np.zeros((), bool)")
    odd = changed(
        odd, "self._state(x, jnp.zeros(()))", "self._state(x, 0.0).replace(info={'goal': x})"
    )
    odd = changed(odd, LINE, "x = state.info['goal'] + jax.random.normal(KEY, (2,))")
    odd = changed(odd, "@dataclass", "KEY = jax.random.key(3)\n\n\n@dataclass")
    assert check(world(folder, odd)) == ()


@pytest.mark.parametrize(
    ("step", "sure"),
    [
        ("Physics(ASSET, self.physics).step(state.data, action, 4)", True),
        ("jax.lax.fori_loop(0, 4, lambda i, x: PHYSICS.step(x, action, 1), state.data)", False),
    ],
)
def test_physics_of_another_time_than_a_decision_is_one_line(folder, step, sure):
    """Where it is certain: a loop hides how often it steps."""
    text = changed(CRANE, "Physics(ASSET, self.physics).step(state.data, action, 10)", step)
    text = changed(text, "import jax.numpy", "import jax\nimport jax.numpy")
    notes = check(world(folder, changed(text, "\n\n\n@", "\nPHYSICS = Physics(ASSET)\n\n\n@")))
    says = "makes 4 physics steps of 0.005 s, 0.02 s in all, and spec.dt is 0.05 s; write dt=0.02"
    assert [says in note for note in notes] == ([True] if sure else [])


def test_a_state_needs_no_metrics_and_no_info(folder):
    assert check(world(folder, changed(WORLD, STATE, "EnvState(x, x, reward, no, no)"))) == ()


@pytest.mark.parametrize("task", TASKS)
def test_the_worlds_of_the_library_pass(task):
    """Their numbers are tested in test_worlds.py."""
    assert check(make(task, "native"), decisions=0) == ()
