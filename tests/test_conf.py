"""The configuration: every choice composes, and every file lists the fields of its part."""

import dataclasses
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import pytest
import small
from hydra.utils import get_class, instantiate
from omegaconf import DictConfig, OmegaConf
from tiny import SMALL

from hybrid_rl.controllers.gradient import GradientController
from hybrid_rl.files import targets as parts
from hybrid_rl.settings import build as config
from hybrid_rl.settings.groups import choices, files, options

PARTS = {  # every class that a choice of a group, or a file of conf/, names
    *(kind for names in choices(config.CONF).values() for kind in names.values()),
    *re.findall(
        r"_target_: (hybrid_rl\.\S+)",
        "\n".join(path.read_text(encoding="utf-8") for path in config.CONF.rglob("*.yaml")),
    ),
}


@pytest.mark.parametrize("name", sorted(PARTS))
def test_a_part_with_ranges_checks_them(name: str) -> None:
    """A class whose fields declare a range is made by `fields.part`, not by `dataclass`."""
    kind = get_class(name)
    if "Must(" in str([field.type for field in dataclasses.fields(kind)]):
        assert kind.__post_init__.__qualname__.startswith("part.")


TASKS = {  # methods that need another task than the pendulum
    **dict.fromkeys(("mapping", "localisation"), "contact_plane"),
    **dict.fromkeys(("computed_torque", "joint_pd"), "sawyer_torque"),
    "dagger": "lander",
    "koopman_track": "two_link",
}
METHODS = [path.stem for path in sorted((config.CONF / "algo").glob("*.yaml"))]
NOT_HERE = ("pendulum", "gymnasium", "playground")  # with all methods, on the host, not installed
NOT_HERE += ("robot", "online")  # of the user
EACH = [  # every method on one task, the default on the default task, one on every task
    *((TASKS.get(algo, "pendulum"), algo) for algo in METHODS),
    ("halfcheetah", "hybrid_stochastic"),
    *((task, "nn_mppi") for task in options("task") if task not in NOT_HERE),
]
RUN = {  # methods that run here, one of a kind; test_learning.py runs four, thesis/tests more
    *("hybrid_deterministic", "hybrid_bc", "fisher", "kle3", "kle3_ddpg", "dagger"),
    "koopman_active",
}


def composed_parts(composed: DictConfig) -> set[str]:
    """The classes that a configuration names, without the expert, which `demonstrate` asks."""
    values = OmegaConf.to_container(composed)
    return {name for _, name in parts.targets({**values, "expert": None, "recipe": None})}


def held(node: Any) -> set[str]:
    """The classes of the parts in what was built."""
    found = set()
    if dataclasses.is_dataclass(node) and not isinstance(node, type):
        found = {f"{type(node).__module__}.{type(node).__name__}"}
        node = {field.name: getattr(node, field.name) for field in dataclasses.fields(node)}
    if isinstance(node, dict):
        node = node.values()
    return (
        found.union(*map(held, node))
        if isinstance(node, Iterable) and not isinstance(node, str)
        else found
    )


EVERYWHERE = {"hybrid_rl.training.agent.Agent", "hybrid_rl.training.episode.Episode"}


@pytest.mark.turns(len(EACH) // 8)
@pytest.mark.parametrize(("task", "algo"), EACH, ids=["-".join(pair) for pair in EACH])
def test_every_method_and_every_task_learn(task: str, algo: str, tmp_path: Path) -> None:
    """Eight decisions of two learners, with learning, all finite; of some only shapes of one."""
    composed = small.with_demonstrations(small.load(algo, f"task={task}"), tmp_path)
    run = config.build(composed)
    built = held([run.agent, run.controllers]) - EVERYWHERE
    assert composed_parts(composed) - EVERYWHERE <= built  # a file may describe more
    if algo in RUN:
        small.learn(run)
    else:
        small.trace(run.agent)


def test_settings_can_be_overridden_on_the_command_line() -> None:
    """They apply after the method and before other overrides; one key for one thing."""
    c = config.load(["settings=light", "total_steps=10", "algo=hybrid_stochastic"])
    learner = c.learners.policy
    assert (learner.updates, learner.batch_size, c.total_steps) == (2, 64, 10)
    assert (learner.critic.hidden, learner.model.members) == ([128, 128], 3)
    c = config.load(["settings=light", "policy_learner.updates=3"])
    assert c.learners.policy.updates == 3
    for algo in ("sac", "nn_mppi", "hybrid_deterministic", "hybrid_disagreement"):
        config.build(config.load(["settings=light", f"algo={algo}"]))
    one = config.load(["settings=light", "model=gaussian", "reward_model.hidden=[8]"])
    assert one.learners.model.model.hidden == [200]
    config.build(one)


@pytest.mark.parametrize(
    ("given", "random", "every"),
    [
        (["total_steps=3001"], 1501, 301),
        (["total_steps=3001", "algo=sac"], 1501, 301),  # of its own 10,000
        (["total_steps=20000"], 5000, 2000),
        (["total_steps=3000", "random_steps=4000"], 4000, 300),
        (["total_steps=3000", "model_random_steps=2000"], 2000, 300),
        (["total_steps=3000", "eval_every=3000"], 1500, 3000),
        (["settings=light"], 5000, 3000),
    ],
)
def test_a_short_run_learns_for_half_of_it_and_has_ten_evaluations(given, random, every) -> None:
    """What the task, the settings and the method say holds for their own total_steps."""
    c = config.load(["task=halfcheetah", *given])
    assert (c.random_steps, c.eval_every) == (random, every)


def test_how_a_hybrid_method_learns_is_one_override() -> None:
    for algo in ("hybrid_stochastic", "hybrid_disagreement"):
        c = config.load(["learning=mbpo", f"algo={algo}"])
        assert (c.learners.policy.learner.updates, c.random_steps) == (10, 1000)
        config.build(c)
        config.build(config.load(["learning=replay", f"algo={algo}"]))
    config.build(config.load(["settings=fast"]))


def test_settings_quick_makes_as_many_updates_a_round_in_any_number_of_worlds() -> None:
    for algo, worlds, count in (("hybrid_stochastic", 8, 4), ("sac", 64, 8), ("flash_sac", 64, 8)):
        words = ["settings=quick", f"algo={algo}"]
        assert config.load(words).num_envs == worlds
        c = config.load([*words, "num_envs=512"])
        each = [one for one in config.build(c).agent.learners.values() if one.data == "uniform"]
        assert {one.updates * c.num_envs for one in each} == {count}


def test_settings_annealed_lengthens_branches_and_lowers_rates_at_the_end() -> None:
    c = config.load(["settings=annealed"])
    learners = config.build(c).agent.learners
    policy = learners["policy"]
    assert (policy.branch_steps, policy.branch_margin, c.total_steps) == (40, 3, 100_000)
    for learner in learners.values():  # of the models, too
        assert [float(learner.schedule.factor(k)) for k in (0, 85_000, 100_000)] == [1.0, 0.5, 0.0]


PLANNERS = [  # methods that have mode=planner
    name
    for name in options("algo")
    if "\n  planner: " in files("algo")[name].read_text(encoding="utf-8")
]


@pytest.mark.parametrize("algo", PLANNERS)
def test_the_planner_of_a_method_has_neither_policy_nor_critic(algo: str) -> None:
    """Nor does its objective; if that of the full method has a critic, its horizon is longer."""
    composed = config.load([f"algo={algo}"])
    used = "objective" if "_target_" in composed.get("objective", {}) else "model_objective"
    planner, full = (
        instantiate(node, _convert_="all")
        for node in (composed.controllers.planner, composed[used])
    )
    inside = planner, planner.objective, getattr(planner, "proposal", None)
    assert [getattr(each, "policy", None) for each in inside] == [None] * 3
    assert planner.objective == dataclasses.replace(full, critic=None, policy=None)
    assert planner.horizon >= (20 if full.critic else 5)
    thesis = config.load(["experiment=thesis/fig_3_2_hopper", f"algo={algo}"]).controllers.planner
    assert thesis.horizon == 5
    if "proposal" in thesis:
        assert (thesis.samples, thesis.proposal.std) == (20, 0.3)


@pytest.mark.parametrize("algo", ["hybrid_stochastic", "hybrid_deterministic"])
def test_the_planner_of_a_method_does_not_depend_on_the_critic(algo: str) -> None:
    """Its action is the same with other parameters of critic and policy; that of `full` is not."""
    overrides = ["task=pendulum", f"algo={algo}", *SMALL, "model=gaussian", "model.hidden=[8]"]
    if algo == "hybrid_stochastic":
        overrides += ["model_planner.horizon=2", "model_planner.samples=3"]
    else:
        overrides += ["shooting_planner.horizon=2"]
    run = config.build(config.load(overrides))
    obs, init = (
        jnp.array([1.0, 0.0, 0.1]),
        jax.jit(lambda key: run.agent.params(run.agent.init(key))),
    )
    first, second = (init(jax.random.key(seed)) for seed in range(2))
    others = first._replace(critic=second.critic, policy=second.policy)

    def actions(mode: str) -> tuple[jax.Array, ...]:
        controller, key = run.controllers[mode], jax.random.key(2)
        act, start = jax.jit(controller.act), controller.init(run.agent.spec)
        return tuple(act(params, start, obs, key)[0] for params in (first, others))

    same, other = actions("planner")
    assert (same == other).all()
    same, other = actions("full")
    assert (same != other).all()


def test_the_root_has_few_slots() -> None:
    """The root has only those of every method; a family adds its own."""
    root = OmegaConf.load(config.CONF / "train.yaml")
    slots = [d for d in root.defaults if d != "_self_" and "override" not in str(next(iter(d)))]
    assert len(slots) <= 18


def test_a_planner_acts_without_a_file_of_a_method():
    given = ["task=pendulum", "+controller@mine=gradient", "controllers.full=${mine}"]
    run = config.build(config.load([*given, "mine.horizon=7"]))
    assert isinstance(run.controllers["full"], GradientController)
    assert run.controllers["full"].horizon == 7
