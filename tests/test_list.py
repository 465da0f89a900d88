"""The list command."""

import subprocess
import sys
from typing import Any

import pytest
from omegaconf import OmegaConf
from tiny import call_command, demonstrate

from hybrid_rl import list as listed
from hybrid_rl.files.targets import part_class
from hybrid_rl.settings import build as config
from hybrid_rl.settings.groups import files

HAS = {  # method of an environment -> what its task says
    "dynamics": "analytic dynamics",
    "equilibrium": "an equilibrium",
    "reference": "a reference",
    "reward_of": "a known reward",
}
PROGRAM = """
import runpy, sys
sys.argv, sys.modules["jax"] = {}, None  # to import it is an error
runpy.run_module(f"hybrid_rl.{{sys.argv[0]}}", run_name="__main__")
"""


@pytest.fixture
def conf(tmp_path):
    def add(name, text):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    add("task/hopping.yaml", "# @package _global_\n# Hopper: hops.\n# And more.\ntask: hopping\n")
    add("algo/actor.yaml", "algo: actor  # not this\n\n#\n#    Actor and critic.\n")
    add("experiment/thesis/figure_2.yaml", "# Figure 2.\n")
    add("experiment/thesis/deep/table_1.yaml", "a: 1\n")
    add("algo/ring.yaml", "# Around a ring.\n# Needs a task with an equilibrium.\nalgo: ring\n")
    add("model/network.yaml", "# A part.\n")
    return tmp_path


def test_each_name_has_the_first_comment_of_its_file(conf):
    names = {
        group: {name: listed.about(path) for name, path in each.items()}
        for group, each in listed.listing(conf).items()
        if each
    }
    assert names == {
        "task": {"hopping": "Hopper: hops."},
        "algo": {"ring": "Around a ring.", "actor": "Actor and critic."},
        "model": {"network": "A part."},
        "experiment": {"thesis/deep/table_1": "", "thesis/figure_2": "Figure 2."},
    }


def test_every_one_says_what_it_is():
    silent = [
        f"{group}/{name}.yaml"
        for group, names in listed.listing().items()
        for name, path in names.items()
        if not listed.about(path).endswith(".")
    ]
    assert not silent, "begin these with a comment of one line that is a sentence"


def test_the_entries_of_ones_own_are_listed(conf, capsys):
    (conf / "task" / "kettle.yaml").write_text("# Kettle: boils.\nenv: {_target_: kettle.Kettle}\n")
    assert call_command(listed.main, f"config_dir={conf}") == 0
    blocks = capsys.readouterr().out.split("\n\n")
    head = {row.split()[0]: each.splitlines()[0] for each in blocks for row in each.split("\n  ")}
    assert head["kettle"] == head["halfcheetah"] == "Tasks  (task=NAME)"
    assert head["ring"] == "Methods  (algo=NAME)  [needs a task with an equilibrium]"
    assert head["pendulum"].endswith("[has analytic dynamics, an equilibrium and a known reward]")
    assert head["sac"].endswith("[start with these nine]")


def test_names_of_the_thesis_are_listed_by_the_last_line(capsys):
    assert call_command(listed.main) == 0
    printed = capsys.readouterr().out
    assert "thesis/fig" not in printed
    assert call_command(listed.main, printed.split("hybrid_rl.list ")[1].split()[0]) == 0
    assert "  thesis/fig_6_1 " in capsys.readouterr().out


@pytest.mark.parametrize("task", listed.listing()["task"])
def test_a_comment_says_what_the_environment_of_a_task_has(task):
    path = files("task")[task]
    env: Any = OmegaConf.load(path).env
    words = [word for name, word in HAS.items() if hasattr(part_class(env._target_), name)]
    head = ", ".join(words[:-1]) + " and " if len(words) > 1 else ""
    assert listed.mark(path) == (f"has {head}{words[-1]}" if words else "")


@pytest.mark.parametrize(
    ("line", "code"), [(["list"], 0), (["export", "out=x.c"], 2), (["render", "nonsense=1"], 2)]
)
def test_a_command_lists_names_and_refuses_arguments_without_importing_jax(line, code):
    program = PROGRAM.format(line)
    assert subprocess.run([sys.executable, "-c", program], capture_output=True).returncode == code


@pytest.mark.parametrize("algo", ["sac", "bc", "ddpg", "kle3", "kle3_ddpg", "bayesopt", "ou_noise"])
def test_what_needs_an_analytic_task_is_marked(algo, tmp_path):
    """The methods that MuJoCo's half-cheetah refuses, and no other."""
    given = ["task=halfcheetah", f"algo={algo}", "total_steps=100"]
    if algo == "bc":
        given.append(demonstrate(tmp_path, config.load(given)))
    if not listed.mark(files("algo")[algo]):
        config.build(config.load(given))
        return
    with pytest.raises(config.UsageError) as raised:
        config.build(config.load(given))
    line = f"task=halfcheetah: {algo} needs an analytic environment; `python"
    assert str(raised.value).startswith(line)
