"""Numbers on README.md, docs/results and the paper agree with their files; commands exist.

python tests/test_pages.py    writes the numbers of the files onto the pages
"""

from importlib import import_module

import pytest
import small
import test_conf
from pages import cited, commands
from pages.cited import ROOT
from rotation import share

from hybrid_rl import config, figures
from hybrid_rl.cli.arguments import HELP

# Modules of `pages`.
PAGES = [
    "readme",
    "results",
    "chapter3",
    "chapter4",
    "chapter5",
    "chapter6",
    "chapter7",
    "lookahead",
    "paper",
    "robots",
    "speed",
    "walker",
]
OTHERS = {"README.md", "paper/paper.md"}  # pages that cite results


def text(page):
    return (ROOT / page).read_text(encoding="utf-8")


@pytest.fixture(params=PAGES)
def page(request):
    """A page's module; imported here, since it reads the files."""
    return import_module(f"pages.{request.param}")


def test_every_page_of_results_is_checked():
    pages = {str(path.relative_to(ROOT)) for path in (ROOT / "docs" / "results").glob("*.md")}
    assert {import_module(f"pages.{name}").PAGE for name in PAGES} == {*pages, *OTHERS}


def test_cited_numbers_are_those_of_the_files(page):
    citations = cited.citations(text(page.PAGE), page.CITED)
    assert citations
    wrong = [f"{one.shown} should be {one.right}" for one in citations if one.shown != one.right]
    assert not wrong, "`python tests/test_pages.py` writes the numbers of the files"


def test_no_number_is_without_a_source(page):
    assert not cited.uncited(text(page.PAGE), page.CITED, page.PLAIN)


def test_a_changed_and_an_added_number_are_noticed():
    """By the functions of these tests, on a table and a sentence made for it."""
    cell = cited.Table("seed | a", lambda label, column: [1234.5, -0.4])
    sentence = cited.Text("half is # of it", [0.5])
    page = "| seed | a |\n|---|---|\n| 7 | **1,234** [-0] |\n\nhalf is 0.50 of it in 3 runs\n"
    citations = cited.citations(page, [cell, sentence])
    assert [(one.shown, one.right) for one in citations] == [
        ("1,234", "1,234"),
        ("-0", "0"),
        ("0.50", "0.50"),
    ]
    changed = cited.citations(page.replace("1,234", "1,235"), [cell, sentence])
    assert (changed[0].shown, changed[0].right) == ("1,235", "1,234")
    (left,) = cited.uncited(page, [cell, sentence], [])
    assert left.startswith("3:")
    assert not cited.uncited(page, [cell, sentence], ["in 3 runs"])
    with pytest.raises(AssertionError, match="0 times"):
        cited.citations(page.replace("half is", "half was"), [cell, sentence])


@pytest.mark.parametrize("page", commands.PAGES)
def test_training_commands_compose(page):
    for job in commands.training(page):
        commands.composed(job)


RUN_ELSEWHERE = test_conf.EXECUTED | {  # by test_commands.py
    ("cartpole", "hybrid_stochastic"),
    ("pendulum", "nn_mppi"),
    ("pendulum", "sac"),
}
OWN = (  # what a small run has of its own
    *("settings=", "num_envs=", "num_seeds=", "run_dir=", "resume=", "hydra/", "hydra."),
    *("random_steps=", "total_steps=", "policy_learner.updates=", "map=", "map.file="),
)


def test_training_commands_learn_in_a_small_size(tmp_path):
    """One command for each pair of task and method; a twentieth of the pairs for each commit."""
    found = {}
    for job in [job for page in commands.PAGES for job in commands.training(page)]:
        if not sweeps_methods(job):
            whole = commands.composed(job)
            found.setdefault((whole.task, whole.algo), job)
    for task, algo in share(sorted(found.keys() - RUN_ELSEWHERE), 20):
        given = [word for word in found[task, algo] if not word.startswith(OWN)]
        print(task, algo, *given)  # which one failed
        composed = small.with_demonstrations(small.load(algo, *given), tmp_path)
        small.learn(config.build(composed))


def sweeps_methods(job):
    """Whether an experiment names the methods of a job, which test_conf.py builds."""
    given = dict(word.split("=", 1) for word in job)
    if "algo" in given or "experiment" not in given:
        return False
    return test_conf.methods_of(given["experiment"]) != [[]]


@pytest.mark.parametrize("page", commands.PAGES)
def test_other_commands_have_the_arguments_of_the_page(page):
    for name, words in commands.commands(page):
        if name in ("train", "list"):
            continue
        if any(f"`{word.removeprefix('study=')}.py`" in text(page) for word in words):
            continue  # a study that the page itself defines
        module = commands.module(name)
        known = {one.name for one in declared(name, words)}
        for word in words:
            key = word.partition("=")[0]
            section, dot, _ = key.partition(".")
            in_group = dot and section in getattr(module, "GROUPS", {})
            assert in_group or key in known | set(HELP), f"{name}: {word}"


def declared(name, words):
    """Arguments of a command; of `figures` also those of the study that the words name."""
    if name != "figures":
        return commands.module(name).ARGUMENTS
    (study,) = [w.removeprefix("study=") for w in words if "study=" in w] or [figures.DEFAULT]
    if study in ("list", "NAME"):
        return figures.ARGUMENTS
    assert study in figures.studies()
    return [
        *figures.ARGUMENTS,
        *figures.arguments(figures.study_of(study)),
    ]


def write(page):
    """Write each number of the page as its file has it."""
    old = new = text(page.PAGE)
    for one in reversed(cited.citations(old, page.CITED)):
        new = new[: one.start] + one.right + new[one.end :]
    (ROOT / page.PAGE).write_text(new, encoding="utf-8")


if __name__ == "__main__":
    for name in PAGES:
        write(import_module(f"pages.{name}"))
