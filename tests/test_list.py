"""The list command."""

import sys

import pytest
from tiny import demonstrate

from hybrid_rl import config
from hybrid_rl import list as listed
from hybrid_rl.cli import command
from hybrid_rl.composition import CONF, file


def call(monkeypatch, *arguments):
    """Exit code of the command."""
    monkeypatch.setattr(sys, "argv", ["list", *arguments])
    try:
        command.run(listed.main)
    except SystemExit as end:
        return end.code
    return 0


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
    assert listed.listing(conf) == {
        "task": {"hopping": "Hopper: hops."},
        "algo": {"ring": "Around a ring.", "actor": "Actor and critic."},
        "experiment": {"thesis/deep/table_1": "", "thesis/figure_2": "Figure 2."},
    }


def test_the_command_prints_one_line_each(monkeypatch, capsys):
    assert call(monkeypatch) == 0
    printed = capsys.readouterr().out.splitlines()
    for group in listed.GROUPS:
        for path in (CONF / group).rglob("*.yaml"):
            name = path.relative_to(CONF / group).with_suffix("").as_posix()
            assert [line for line in printed if line.split()[:1] == [name]], f"{group}={name}"


def test_every_one_says_what_it_is():
    silent = [
        f"{group}/{name}.yaml"
        for group, names in listed.listing().items()
        for name, text in names.items()
        if not text.endswith(".")
    ]
    assert not silent, "begin these with a comment of one line that is a sentence"


def test_arguments_are_refused(monkeypatch, capsys):
    assert call(monkeypatch, "task=hopper") == 2
    printed = capsys.readouterr().err
    line = "task=hopper: unknown argument; give key=value with config_dir"
    assert printed == f"hybrid_rl: {line}\n"


@pytest.mark.parametrize("given", [["config_dir={}"], ["--config-dir", "{}"]])
def test_the_entries_of_ones_own_are_listed(conf, monkeypatch, capsys, given):
    (conf / "task" / "kettle.yaml").write_text(
        "# Kettle: boils.\nenv:\n  _target_: kettle.Kettle\n"
    )
    assert call(monkeypatch, *(text.format(conf) for text in given)) == 0
    printed = capsys.readouterr().out
    assert "  kettle " in printed
    assert "Kettle: boils." in printed
    assert "Around a ring. [needs a task with an equilibrium]\n" in printed
    (ours,) = [line for line in printed.splitlines() if line.startswith("  pendulum ")]
    assert ours.endswith("[analytic, equilibrium, known reward]")
    assert "  halfcheetah " in printed


@pytest.mark.parametrize("algo", ["sac", "bc", "ddpg", "kle3", "kle3_ddpg", "bayesopt", "ou_noise"])
def test_what_needs_an_analytic_task_is_marked(algo, tmp_path):
    """The methods that MuJoCo's half-cheetah refuses, and no other."""
    given = ["task=halfcheetah", f"algo={algo}", "total_steps=100"]
    if algo == "bc":
        given.append(demonstrate(tmp_path, config.load(given)))
    if not listed.needs(file("algo", algo)):
        config.build(config.load(given))
        return
    with pytest.raises(config.UsageError) as raised:
        config.build(config.load(given))
    line = f"task=halfcheetah: {algo} needs an analytic environment; choose one of cart"
    assert str(raised.value).startswith(line)
