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
PLAIN = "@dataclass(frozen=True)\nclass W:\n    gain: float = 1.0"
EXTRA = "gain: float\n    mass: float"
GYM = "_target_: gymnasium.make, id: Pendulum-v1"
YAML = r"my_conf/task/broken\.yaml:"
FILES = [  # of Python and YAML: replaced, by what, the whole line
    (PLAIN, "class W:", r"env: W\(\) takes no arguments"),
    ("gain: 2.0", "gian: 2.0", r"env: W\.__init__\(\) got an unexpected keyword argument 'gian'"),
    ("gain: float = 1.0", EXTRA, r"env: W\.__init__\(\) missing 1 required .*: 'mass'"),
    ("w.W", '"w:W"', r"env\._target_=w:W: write w\.W"),
    ("w.W", "w.V", r"env\._target_=w\.V: w\.py has no class V"),
    ("w.W", "theirs.W", r"env\._target_=theirs\.W: is no part of hybrid_rl; put its folder on .*"),
    ("state, action):", "state, action:", r"env\._target_=w\.W: w\.py:19: '\(' was never closed"),
    ("import numpy", "import torchh", r"env\._target_=w\.W: w\.py:5: ModuleNotFoundError: .*"),
    ("# @package _global_\n", "", rf"{YAML} its first line must be # @package _global_"),
    ("env: {_target_: w.W, gain: 2.0}\n", "", rf"{YAML} lacks env; .*"),
    ("eval_every: 50\neval_episodes: 1\n", "", rf"{YAML} lacks eval_every, eval_episodes; .*"),
    ("episode: {steps: 20, action_repeat: 1}", "episode:\n\tsteps: 2", rf"{YAML}\d: is no YAML.*"),
    ("{steps:", "{step:", r"episode: Episode\.__init__\(\) got an unexpected .* 'step'"),
    ("_target_: w.W, ", "", r"env={'gain': 2\.0}: must be a part, a group of keys with _target_"),
    ("_target_: w.W, gain: 2.0", GYM, r"env\._target_=gymnasium\.make: makes " + HOWTO),
    (WORLD, GYMNASIUM, r"w\.py:4: W is " + HOWTO),
]


@pytest.mark.parametrize(("old", "new", "line"), FILES)
def test_files_that_make_no_run_are_refused_in_a_line(folder, old, new, line):
    texts = [text.replace(old, new) for text in (WORLD, TASK)]
    assert texts != [WORLD, TASK]
    write(folder, *texts)
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


def test_a_task_file_may_set_keys_of_any_method_and_its_own_where_they_are_read(folder):
    own = (
        changed(TASK, "gain: 2.0", 'gain: "${strength}"') + "strength: 3.0\nplanner: {samples: 9}\n"
    )
    write(folder, task=own)
    assert config.load(["task=broken", "algo=sac"], "my_conf").env.gain == 3.0
