"""A share of the training commands on the pages learns."""

import page_commands as commands
import pytest
import small
import test_methods

from hybrid_rl.settings import build as config

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
