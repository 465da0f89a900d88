"""The list command."""

import sys

import pytest

from hybrid_rl import command
from hybrid_rl import list as listed
from hybrid_rl.config import CONF


def call(monkeypatch, *arguments):
    """Exit code of the command."""
    monkeypatch.setattr(sys, "argv", ["list", *arguments])
    try:
        command.guarded(listed.main)
    except SystemExit as end:
        return end.code
    return 0


@pytest.fixture
def conf(tmp_path):
    def add(name, text):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    add("task/hopper.yaml", "# @package _global_\n# Hopper: hops.\n# And more.\ntask: hopper\n")
    add("algo/sac.yaml", "algo: sac  # not this\n\n#\n#    Actor and critic.\n")
    add("experiment/thesis/figure_2.yaml", "# Figure 2.\n")
    add("experiment/thesis/deep/table_1.yaml", "a: 1\n")
    add("model/network.yaml", "# A part.\n")
    return tmp_path


def test_each_name_has_the_first_comment_of_its_file(conf):
    assert listed.listing(conf) == {
        "task": {"hopper": "Hopper: hops."},
        "algo": {"sac": "Actor and critic."},
        "experiment": {"thesis/deep/table_1": "", "thesis/figure_2": "Figure 2."},
    }


def test_the_command_prints_one_line_each(monkeypatch, capsys):
    assert call(monkeypatch) == 0
    said = capsys.readouterr().out.splitlines()
    for group in listed.GROUPS:
        for path in (CONF / group).rglob("*.yaml"):
            name = path.relative_to(CONF / group).with_suffix("").as_posix()
            assert [line for line in said if line.split()[:1] == [name]], f"{group}={name}"


def test_every_one_says_what_it_is():
    silent = [
        f"{group}/{name}.yaml"
        for group, names in listed.listing().items()
        for name, text in names.items()
        if not text
    ]
    assert not silent, "begin these with a comment line"


def test_arguments_are_refused(monkeypatch, capsys):
    assert call(monkeypatch, "task=hopper") == 2
    assert capsys.readouterr().err == "hybrid_rl: task=hopper: the list takes no argument\n"
