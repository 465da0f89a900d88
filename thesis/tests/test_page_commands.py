"""Commands on the pages compose; those that do not train run in a small size."""

import re
from functools import partial
from pathlib import Path

import page_commands as commands
import pytest
import small
import test_methods
from tiny import call, run

from hybrid_rl.cli import command
from hybrid_rl.settings import build as config

SMALL = {  # command -> arguments that make it small
    "demonstrate": {"episodes": "1"},
    "evaluate": {"episodes": "1", "episode.steps": "20"},
    "render": {"episode_steps": "2", "width": "64", "height": "48"},
}
IN_ITS_WORLD = {"constraint": "speed", "constraint.most": "1"}  # a pendulum has no pitch
FILE_OR_NUMBER = re.compile(r"[\w/]+(?=\.\w+$)|[\d.,]+$")
PAGES = [*commands.LIBRARY, *commands.RESULTS]
over_pages = pytest.mark.parametrize("page", PAGES)
METRICS = {"train/return", "eval/return", "eval/policy_return"}  # of the small run


@over_pages
def test_training_commands_compose(page):
    commands.compose([page])


@over_pages
def test_other_commands_have_the_arguments_of_the_page(page):
    commands.check_arguments(page)


def programs():
    """(command, its arguments) of the pages, in their order, each as often as it differs.

    A number or a name of a file makes no difference, but the file's suffix does.
    """
    found = {}
    for page in PAGES:
        for name, words in commands.commands(page):
            given = dict(word.split("=", 1) for word in words if "=" in word)
            if not runs_here(name, given):
                continue
            given = {key: "run" if key in ("run", "runs") else each for key, each in given.items()}
            if name == "evaluate":  # the small run is one of another task
                given = {key: each for key, each in given.items() if not key.startswith("env.")}
            given |= SMALL.get(name, {})
            given |= IN_ITS_WORLD if given.get("constraint") == "pitch" else {}
            kind = {key: FILE_OR_NUMBER.sub("", each) for key, each in given.items()}
            found.setdefault((name, *sorted(kind.items())), (name, given))
    return list(found.values())


def runs_here(name, given):
    """Whether a command needs no more than a run of hybrid learning."""
    if name == "figures":  # thesis/tests draw the others
        metrics = set(given.get("metric", "train/return").split(","))
        return "study" not in given and "x" not in given and metrics <= METRICS
    elsewhere = ("train", "benchmark", "stand_in", "robot")  # test_benchmark.py, test_robot_run.py
    elsewhere += ("view", "demo", "identify", "suite")  # tests/tools
    elsewhere += ("thesis.studies.belief_video",)  # test_belief_frames.py
    return name not in elsewhere and "..." not in given.values()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The folder in which the commands run, with the run."""
    folder = tmp_path_factory.mktemp("pages")
    size = ["policy.hidden=[256,256]", "episode.steps=20", "total_steps=100", "eval_every=50"]
    (folder / "policies").mkdir()  # in which the commands of the pages write
    (folder / "thesis").symlink_to(Path(__file__).parents[1])  # which they read
    run(folder / "run", "algo=hybrid_stochastic", *size, "eval_modes=[full,policy]")
    head = "exp_name,env_name,seed,metric,env_step,value"  # of another library's curve
    (folder / "sb3.csv").write_text(f"{head}\nSAC,pendulum,0,avg_return,50,-300\n")
    return folder


def test_commands_run(folder, monkeypatch, can_draw, capfd):
    """In the order of the pages, since some read what others wrote."""
    monkeypatch.chdir(folder)
    failed = []
    for name, given in programs():
        if name == "render" and not can_draw:
            continue
        words = [f"{key}={value}" for key, value in given.items()]
        if call(partial(command.run, commands.module(name).main), *words) != 0:
            failed.append((name, *words, capfd.readouterr().err))
    assert not failed


def test_the_commands_are_those_of_the_pages():
    """Of each command one at least."""
    names = {name for name, _ in programs()}
    known = {"demonstrate", "doctor", "evaluate", "export", "figures", "list", "render", "report"}
    assert names == known


RUN_ELSEWHERE = {(test_methods.of_task(algo), algo) for algo in test_methods.RUN} | {
    ("cartpole", "hybrid_stochastic"),  # by test_commands.py
    ("pendulum", "nn_mppi"),
    ("pendulum", "sac"),
}
OWN = (  # what a small run has of its own
    *("algo=", "settings=", "num_envs=", "num_seeds=", "run_dir=", "resume=", "hydra/", "hydra."),
    *("random_steps=", "total_steps=", "policy_learner.updates=", "map=", "map.file="),
)


@pytest.fixture(scope="module")
def pairs():
    """One command for each pair of task and method: task, method, words."""
    found = {}
    for job, *_ in commands.combinations([*commands.LIBRARY, *commands.RESULTS]):
        elsewhere = {"task=playground", "task=robot"} & set(job)  # not installed; test_robot_run.py
        others = ("env.make=", "env.id=shimmy:")  # a reader's; shimmy is not installed
        elsewhere = elsewhere or any(word.startswith(others) for word in job)
        if not sweeps_methods(job) and not elsewhere:
            whole = commands.composed(job)
            found.setdefault((whole.task, whole.algo), job)
    return [(*pair, found[pair]) for pair in sorted(found.keys() - RUN_ELSEWHERE)]


@pytest.mark.turns(20)
@pytest.mark.parametrize("turn", range(20))
def test_training_commands_learn_in_a_small_size(turn, pairs, tmp_path):
    for task, algo, job in pairs[turn::20]:
        given = [word for word in job if not word.startswith(OWN)]
        print(task, algo, *given)  # which one failed
        composed = small.with_demonstrations(small.load(algo, *given), tmp_path)
        small.learn(config.build(composed))


def sweeps_methods(job):
    """Whether an experiment names the methods of a job, which test_methods.py builds."""
    given = dict(word.split("=", 1) for word in job)
    if "algo" in given or "experiment" not in given:
        return False
    return test_methods.methods_of(given["experiment"]) != [[]]
