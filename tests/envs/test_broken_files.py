"""Python and YAML files of a task of one's own that make no run: one line names the file."""

import pytest
from faulty import TASK, WORLD, changed, refused, write

from hybrid_rl.settings import build as config

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
        r"env: W\(\) takes no arguments",
    ),
    (
        "an unknown field",
        "yaml",
        "gain:",
        "gian:",
        r"env: W\.__init__\(\) got an unexpected keyword argument 'gian'",
    ),
    (
        "a field without a default",
        "py",
        "gain: float = 1.0",
        "gain: float\n    mass: float",
        r"env: W\.__init__\(\) missing 1 required positional argument: 'mass'",
    ),
    ("a colon, as in env.make", "yaml", "w.W", '"w:W"', r"env\._target_=w:W: write w\.W"),
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
        r"episode: Episode\.__init__\(\) got an unexpected keyword argument 'step'",
    ),
    (
        "no class of env",
        "yaml",
        "_target_: w.W, ",
        "",
        r"env={'gain': 2\.0}: must be a part, a group of keys with _target_",
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


@pytest.mark.parametrize(
    ("file", "old", "new", "line"), [c[1:] for c in FILES], ids=[c[0] for c in FILES]
)
def test_files_that_make_no_run_are_refused_in_a_line(folder, file, old, new, line):
    texts = {"py": WORLD, "yaml": TASK}
    texts[file] = changed(texts[file], old, new)
    write(folder, texts["py"], texts["yaml"])
    refused(line, lambda: config.build(config.load(["task=broken", "algo=sac"], "my_conf")))


def test_runs_of_a_task_or_a_method_without_a_name_have_that_of_its_file(folder):
    """They would lie among those of what it begins with, and share their curve."""
    inherits = "defaults: [/task@_global_: pendulum, _self_]\n"
    write(folder, task=changed(TASK, "task: broken\n", inherits))
    assert config.load(["task=broken", "algo=sac"], "my_conf").task == "broken"
    (folder / "my_conf" / "algo").mkdir()
    method = "# @package _global_\ndefaults: [/algo@_global_: sac, _self_]\n"
    for text in (method, method.replace("algo@_global_: sac", "family@_global_: hybrid")):
        (folder / "my_conf" / "algo" / "own.yaml").write_text(text)
        if "family" in text:  # of which none says who acts
            text += "controllers: {full: '${actor}'}\n"
            (folder / "my_conf" / "algo" / "own.yaml").write_text(text)
        assert config.load(["task=pendulum", "algo=own"], "my_conf").algo == "own"


def test_a_method_that_loads_a_part_of_its_family_again_is_refused(folder):
    (folder / "my_conf" / "algo").mkdir()
    twice = "[/family@_global_: hybrid, /controller@noisy: noisy, _self_]"
    text = f"# @package _global_\ndefaults: {twice}\nalgo: own\n"
    (folder / "my_conf" / "algo" / "own.yaml").write_text(text)
    line = r".*controller@noisy\.controller appears more than once.*"
    refused(line, lambda: config.load(["task=pendulum", "algo=own"], "my_conf"))


def test_a_field_with_a_default_need_not_be_in_the_file_of_a_task(folder):
    write(folder, task=changed(TASK, ", gain: 2.0", ""))
    assert config.load(["task=broken", "algo=sac"], "my_conf").env.gain == 1.0
    assert config.load(["task=broken", "algo=sac", "env.gain=3"], "my_conf").env.gain == 3


def test_what_is_seldom_meant_is_a_note_of_the_run(folder):
    ends = changed(WORLD, "EnvState(x, x, reward, no,", "EnvState(x, x, reward, ~no,")
    write(folder, ends, changed(TASK, "episode: {steps: 20, action_repeat: 1}\n", ""))
    run = config.build(config.load(["task=broken", "algo=sac"], "my_conf"))
    line = "w.py:19: W.step: every episode ended after one decision, of 10 tried"
    assert run.notes == (line,)


def test_a_task_file_may_set_keys_of_any_method_and_its_own_where_they_are_read(folder):
    own = (
        changed(TASK, "gain: 2.0", 'gain: "${strength}"') + "strength: 3.0\nplanner: {samples: 9}\n"
    )
    write(folder, task=own)
    assert config.load(["task=broken", "algo=sac"], "my_conf").env.gain == 3.0
