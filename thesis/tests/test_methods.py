"""Methods by the thesis' names and experiments: each builds, and learns."""

from pathlib import Path
from typing import Any, get_args, get_type_hints

import pytest
import small
from hydra.utils import get_class
from omegaconf import DictConfig, OmegaConf

from hybrid_rl import list as listed
from hybrid_rl.fields import Must
from hybrid_rl.settings import build as config
from hybrid_rl.settings.groups import THESIS, files, options

OF_TASK = {  # methods that need another task
    **dict.fromkeys(("computed_torque", "joint_pd"), "sawyer_torque"),
    **dict.fromkeys(("nie", "minie", "kle3_imitation"), "lander"),
    "koopman_track": "two_link",
}
RUN = {  # methods that learn here; tests/test_conf.py and test_learning.py run others
    *("hybrid_bc_deterministic", "kle3_imitation", "analytic", "disagreement", "kle3_bayesopt"),
    *("kle3_model_learning", "gp_active", "koopman_embedding", "koopman_track", "koopman_printed"),
    *("computed_torque", "ergodic_mapping", "information_localisation", "residual_dagger"),
}
SAME = {  # a name of the thesis -> the library's method and its values
    "dail": ("dagger", "query=information", "target.criterion=inverse"),
    "disagreement_dagger": ("dagger", "query=disagreement"),
    "residual_dagger": ("dagger", "query=residual"),
    "rq_dagger": ("dagger", "query=random"),
    **{f"{kind}_noise": ("noise", f"noisy.kind={kind}") for kind in ("normal", "ou", "uniform")},
    **{
        f"{name}_{what}": (what, f"search={search}")
        for what in ("mapping", "localisation")
        for name, search in (
            *(("kle3", "kl"), ("ergodic", "fourier"), ("entropy", "entropy")),
            ("information", "paths"),
        )
    },
    "noise_mapping": ("mapping", "search=noise"),
}


def of_task(algo: str) -> str:
    """A task that the method fits."""
    if algo.endswith(("mapping", "localisation")):
        return "contact_plane"
    return "lander" if "dagger" in algo or algo == "dail" else OF_TASK.get(algo, "pendulum")


NEEDS = {  # what a part needs of its world, the most demanding first -> comment of its method
    "reference": "needs a task with a reference",
    "dynamics": "needs an analytic task",
    "equilibrium": "needs a task with an equilibrium",
    "reward_of": "needs a task with a known reward",
}


def needs(composed: DictConfig) -> str:
    """What the parts of a method need of their environment: what their field `world` must have."""
    kinds: set[str] = set()

    def visit(node: Any) -> None:
        if "goal" in node and node.goal is None:  # of a known reward
            kinds.add("reward_of")
        if node.get("world") == composed.env:
            kind = get_type_hints(get_class(node._target_), include_extras=True)["world"]
            kinds.update(each.has for each in get_args(kind)[1:] if isinstance(each, Must))
        for value in node.values():
            if isinstance(value, DictConfig):
                visit(value)

    for section in (composed.controllers, composed.learners):
        visit(section)
    return next((comment for kind, comment in NEEDS.items() if kind in kinds), "")


@pytest.mark.parametrize("algo", options("algo"))
def test_a_comment_says_which_tasks_the_parts_of_a_method_need(algo: str) -> None:
    composed = config.load([f"task={of_task(algo)}", f"algo={algo}"])
    assert listed.mark(files("algo")[algo]) == needs(composed)


@pytest.mark.turns(2)
@pytest.mark.parametrize("algo", sorted({*RUN, *listed.listing(THESIS)["algo"]}))
def test_every_method_learns(algo: str, tmp_path: Path) -> None:
    """Eight decisions of two learners, with learning, all finite; of some only shapes of one."""
    composed = small.load(algo, f"task={of_task(algo)}")
    run = config.build(small.with_demonstrations(composed, tmp_path))
    if algo in RUN:
        small.learn(run)
    else:
        small.trace(run.agent)


@pytest.mark.parametrize("name", SAME)
def test_a_name_of_the_thesis_is_a_method_of_the_library_with_a_value(name: str) -> None:
    algo, *values = SAME[name]
    task = f"task={of_task(name)}"
    theirs, ours = (
        config.load([task, *line]) for line in ([f"algo={name}"], [f"algo={algo}", *values])
    )
    ours.algo, ours.recipe = name, theirs.recipe
    assert theirs == ours


def methods_of(experiment: str) -> list[list[str]]:
    """The overrides for each method that an experiment compares; else for its own method."""
    node = OmegaConf.load(files("experiment")[experiment])
    inherited = {str(k): v for default in node.defaults for k, v in _pairs(default)}
    nodes = [node]
    if "/settings@_global_" in inherited:
        name = inherited["/settings@_global_"]
        nodes.append(OmegaConf.load(files("settings")[name]))
    lists = [OmegaConf.select(each, "hydra.sweeper.params.algo") for each in nodes]
    names = next(filter(None, lists), "")
    return [[f"algo={name}"] for name in names.split(",")] if names else [[]]


def _pairs(default: Any) -> Any:
    return default.items() if isinstance(default, DictConfig) else ()


@pytest.mark.parametrize("experiment", options("experiment"))
def test_every_experiment_builds(experiment: str, tmp_path: Path) -> None:
    """The parts of an experiment accept its values, for every method that it compares."""
    for line in methods_of(experiment):
        composed = config.load([f"experiment={experiment}", *line])
        config.build(small.with_demonstrations(composed, tmp_path))


def test_thesis_parameters() -> None:
    """Table B.1, with its swapped columns corrected."""
    robots = {  # figure -> task, H, T, K, lambda, policy; other values are in test_printed.py
        "fig_3_2_pendulum": ("pendulum", 5, 200, 20, 0.1, [128]),
        "fig_3_2_cartpole": ("cartpole", 5, 200, 20, 0.1, [128]),
        "fig_3_2_hopper": ("hopper", 5, 1000, 20, 0.1, [128]),
        "fig_3_2_halfcheetah": ("halfcheetah", 10, 1000, 20, 0.2, [128]),
        "fig_3_3": ("sawyer_push", 10, 100, 10, 0.01, [128, 128]),
        "fig_3_5": ("ant", 20, 400, 40, 1.0, [128, 64]),
        "fig_3_6": ("panda_stack", 40, 200, 40, 1.0, [32, 24]),
    }
    for figure, row in robots.items():
        c = config.load([f"experiment=thesis/{figure}"])
        p = c.planner
        got = (c.task, p.horizon, c.episode.steps, p.samples, p.temperature, c.policy.hidden)
        assert got == row
