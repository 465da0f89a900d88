"""The how-tos of the pages, run as they are printed, from a folder outside the repository."""

import os
import re
import sys
from importlib import import_module
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from omegaconf import OmegaConf
from tiny import TINY, call_command, call_train, refusal, summary_of

from hybrid_rl import evaluate, render
from hybrid_rl.analysis import drawing
from hybrid_rl.envs.mujoco import offscreen
from hybrid_rl.errors import SourceOf, UsageError
from hybrid_rl.outside.actor import Actor
from hybrid_rl.outside.row_log import RowLog
from hybrid_rl.run.saved import load
from hybrid_rl.settings import build as config

pytestmark = pytest.mark.turns(3)

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
HOWTO = (ROOT / "docs" / "howto.md").read_text(encoding="utf-8")
DEPLOY = (ROOT / "docs" / "howto_deploy.md").read_text(encoding="utf-8")


def section(title: str, page: str = PAGE) -> str:
    """The text of a section of the page."""
    return page.split(f"## {title}\n")[1].split("\n## ")[0]


def blocks(title: str, page: str = PAGE) -> list[str]:
    """The code blocks of a section, in order."""
    return re.findall(r"```(?:python|xml|yaml)\n(.*?)```", section(title, page), re.S)


@pytest.fixture
def conf(tmp_path, monkeypatch):
    """An empty configuration folder; modules are imported from the folder around it."""
    modules = set(sys.modules)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    for group in ("algo", "target", "task"):
        (tmp_path / "my_conf" / group).mkdir(parents=True)
    yield tmp_path / "my_conf"
    for name in {*sys.modules} - modules:
        if str(tmp_path) in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


@pytest.fixture
def ring(conf, tmp_path):
    """The files of "A part"."""
    (tmp_path / "ring.py").write_text(blocks("A part")[0])
    lines = re.search(r"with two lines, `(.*?)` and `(.*?)`", section("A part")).groups()
    (conf / "target" / "ring.yaml").write_text("\n".join(lines) + "\n")
    return conf


def train(conf, folder, *overrides):
    """The configuration of a tiny run that ended well, without a warning."""
    line = [*TINY, "total_steps=100", "eval_modes=[]", f"run_dir={folder}", *overrides]
    assert call_train("--config-dir", conf, *line) == 0
    return OmegaConf.load(folder / "config.yaml")


def test_a_method_is_one_yaml_and_a_recursive_learner_one_file(conf, tmp_path, capfd):
    """The method composes as printed, also from Python; with the learner added, it trains."""
    method = conf / "algo" / "planned_sac.yaml"
    method.write_text(blocks("A method")[0])
    composed = config.load(["algo=planned_sac"], config_dir=conf)
    assert list(composed.learners) == ["model", "policy"]
    (tmp_path / "reward_average.py").write_text(blocks("A recursive learner")[0])
    entry = re.search(r"`(average: \{.*?\})`", section("A recursive learner"))[1]
    method.write_text(f"{method.read_text()}  {entry}\n")
    written = train(conf, tmp_path / "run", "algo=planned_sac")
    assert capfd.readouterr().err == ""
    assert list(written.learners) == ["model", "policy", "average"]
    trained = load(tmp_path / "run")
    total, count = np.asarray(trained.params.scale[0])
    assert count == 100
    assert total < 0  # rewards of the pendulum


def test_a_part_is_one_file_and_one_yaml(ring, tmp_path, capfd):
    """Trained with the command of the page."""
    arguments = re.search(r"config_dir=my_conf (task=point_mass .*?)`", section("A part"))[1]
    written = train(ring, tmp_path / "run", *arguments.split(), "explorer.horizon=3")
    assert capfd.readouterr().err == ""
    objective = written.controllers.full.controller.objective
    assert objective.target == {"_target_": "ring.Ring", "radius": 0.4}
    summary = summary_of(tmp_path / "run")
    assert (summary["algo"], summary["finished"]) == ("kle3", True)
    folder = f"run={tmp_path / 'run'}"  # of a method that learns nothing
    assert call_command(evaluate.main, folder, "episodes=1") == 0


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (["target=rings"], "policy_residual, ring, upper_confidence_bound; did you mean ring?"),
        (["target=ring", "target.radius=far"], "target.radius=far: must be a number"),
        (["target=ring", "target._target_=ring.Any"], "target._target_=ring.Any: "),
        (
            ["target=ring", "target._target_=their.Any"],
            "_target_=their.Any: is no part of hybrid_rl; put its folder on PYTHONPATH",
        ),
        (["domain.coordinates=[0,9]"], "coordinates=[0, 9]: must be entries of a state with 4"),
    ],
    ids=["name", "value", "class", "module", "traced"],
)
def test_an_error_about_a_part_is_one_line(ring, tmp_path, capfd, overrides, words):
    line = [*TINY, "task=point_mass", "algo=kle3", f"run_dir={tmp_path / 'run'}", *overrides]
    assert words in refusal(capfd, "--config-dir", ring, *line)
    assert not (tmp_path / "run").exists()


def test_an_analytic_environment_is_one_file_and_one_yaml(conf, tmp_path, monkeypatch, capfd):
    """It is trained and loaded from another folder; it cannot be drawn, which is one line."""
    code, yaml = blocks("An analytic world")
    (tmp_path / "kettle.py").write_text(code)
    (conf / "task" / "kettle.yaml").write_text(yaml)
    folder = tmp_path / "run"
    train(conf, folder, "task=kettle", "algo=sac", "episode.steps=20", "env.power=4")
    assert capfd.readouterr().err == ""
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    trained = load(folder)
    assert trained.episode.env.power == 4
    assert (evaluate.evaluate(trained, episodes=2)["return"] < 0).all()
    monkeypatch.setattr(offscreen, "backend", lambda: "egl")
    assert "Kettle has no `scene` and no `pose`" in refusal(capfd, f"run={folder}", of=render.main)


def test_a_mujoco_environment_is_two_files_and_one_yaml(conf, tmp_path, capfd, can_draw):
    """It is trained, evaluated and drawn."""
    code, xml, yaml = blocks("A MuJoCo world")
    (tmp_path / "crane.py").write_text(code)
    (tmp_path / "crane.xml").write_text(xml)
    (conf / "task" / "crane.yaml").write_text(yaml)
    train(conf, tmp_path / "run", "task=crane", "algo=sac", "episode.steps=10", "env.mass=1.5")
    assert capfd.readouterr().err == ""
    trained = load(tmp_path / "run")
    assert (evaluate.evaluate(trained, episodes=1)["return"] < 0).all()
    shown = drawing.episode(trained, steps=3)
    assert shown.poses.shape == (4, 2)
    if can_draw:
        picture = tmp_path / "crane.gif"
        drawing.draw_film(trained.episode, shown, picture, 64, 48)
        assert picture.stat().st_size > 0


def test_each_episode_of_a_crane_can_have_another_body(conf, tmp_path):
    """By a reset that replaces the crane's own."""
    code, xml, yaml = blocks("A MuJoCo world")
    (drawn,) = blocks("Another body in each episode", HOWTO)
    own = re.compile(r"    def reset.*?\n\n", re.S)
    (tmp_path / "crane.py").write_text(own.sub(lambda _: drawn + "\n", code))
    (tmp_path / "crane.xml").write_text(xml)
    (conf / "task" / "crane.yaml").write_text(yaml)
    train(conf, tmp_path / "run", "task=crane", "algo=sac", "episode.steps=10")
    episode = load(tmp_path / "run").episode
    keys = jax.random.split(jax.random.key(0), 3)
    start = jax.vmap(episode.reset)(keys)
    after = jax.jit(jax.vmap(episode.step))(start, jnp.ones((3, 1)))
    mass = after.data.fields["body_mass"].sum(1)
    assert ((mass > 0.7 * 1.5) & (mass < 1.3 * 1.5)).all()
    assert jnp.ptp(mass) > 0.05
    np.testing.assert_array_equal(jnp.argsort(after.data.qvel[:, 0]), jnp.argsort(-mass))


def test_a_planner_is_one_file(conf, tmp_path):
    """It trains by the files of the page and logs its metric; on the simulator it decides, too."""
    code, fields, method = blocks("A planner of your own", HOWTO)
    (tmp_path / "refit.py").write_text(code)
    (conf / "planner").mkdir()
    (conf / "planner" / "mine.yaml").write_text(fields)
    (conf / "algo" / "mine.yaml").write_text(method)
    train(conf, tmp_path / "run", "task=pendulum", "mine.horizon=3", "algo=mine")
    assert '"planner/std"' in (tmp_path / "run" / "metrics.jsonl").read_text()
    words = ["planner=mine", "planner.horizon=3", "task=pendulum"]
    swapped = config.load(words, config_dir=conf)
    full = swapped.controllers.full
    assert full.horizon == 3
    assert "temperature" not in full  # of the method's own planner
    run = config.build(swapped)
    assert {type(run.controllers[mode]).__name__ for mode in ("full", "planner")} == {"Refit"}
    agent = config.build(config.load([*words, "algo=mppi"], config_dir=conf)).agent
    metrics = jax.jit(lambda: agent.step(agent.init(jax.random.key(0)), jnp.int32(0))[1])()
    assert 0 < metrics["planner/std"] < 0.1  # 0.02; 0.3 to 0.4 where all plans are as good


def test_a_reward_is_one_file_that_the_environment_pays(conf, tmp_path, capsys):
    """In training, and on another run when it is evaluated."""
    code, fields = blocks("A reward of your own", HOWTO)
    (tmp_path / "upright.py").write_text(code)
    (conf / "reward").mkdir()
    (conf / "reward" / "upright.yaml").write_text(fields)
    words = section("A reward of your own", HOWTO).split("my_conf ")[1].split("\n")[0].split()
    train(conf, tmp_path / "run", *words, "episode.steps=5")
    trained = load(tmp_path / "run")
    assert trained.episode.reward.effort == 0.2
    got = evaluate.evaluate(trained, "full", 2)["return"]
    assert (np.abs(got) <= 5 * 1.2).all()
    train(conf, tmp_path / "other", "task=pendulum", "algo=nn_mppi", "episode.steps=5")
    words = f"run={tmp_path / 'other'}", "reward=upright", f"config_dir={conf}", "episodes=2"
    assert call_command(evaluate.main, *words) == 0
    assert "reward=upright" in capsys.readouterr().out


@pytest.mark.filterwarnings("ignore:.*Box observation space (min|max)imum value is:UserWarning")
def test_a_gymnasium_environment_trains_as_it_is(conf, tmp_path, monkeypatch):
    """The class of the how-tos passes Gymnasium's own check, and trains."""
    monkeypatch.chdir(tmp_path)
    (code,) = blocks("A Gymnasium environment", HOWTO)
    (tmp_path / "reach.py").write_text(code)
    check_env(import_module("reach").Reach(), skip_render_check=True)
    run = tmp_path / "run"
    words = "task=gymnasium", "env.make=reach:Reach", "algo=sac", "episode.steps=4"
    composed = train(conf, run, *words)
    assert (composed.task, composed.env.id, composed.episode.steps) == ("reach_Reach", "", 4)
    assert evaluate.evaluate(load(run), episodes=2)["return"].shape == (1, 2)


def test_a_robot_is_one_class(conf, tmp_path):
    """It begins where `reset` leads, is paid by its own rule, and is at rest in the end."""
    (code,) = blocks("A robot in real time", DEPLOY)
    (tmp_path / "my_robot.py").write_text(code)
    small = ["policy.hidden=[8]", "critic.hidden=[8]", "policy_learner.batch_size=4"]
    line = ["task=robot", "env.make=my_robot:Arm", "algo=sac", "random_steps=0", "total_steps=100"]
    agent = config.build(config.load([*line, *small])).agent
    actor = Actor(agent, tmp_path, params=agent.params(agent.init(jax.random.key(0))))
    actor.run(seconds=1.0)
    row = RowLog(tmp_path / "rows", agent.spec).read(0)
    assert abs(row["obs"][0] - 3) < 0.5
    angle, rate = row["next_obs"]
    assert row["reward"] == pytest.approx(np.cos(angle) - 0.01 * rate**2, abs=1e-5)
    assert actor.robot.torque == 0


CALLBACK = """from dataclasses import dataclass

import jax
import jax.numpy as jnp
from hybrid_rl.types import EnvState, Spec

def advance(x, action):
    return x["goal"]

@dataclass(frozen=True)
class Swing:
    spec = Spec(obs=2, act=1, dt=0.05)

    def reset(self, key):
        return self._state(jax.random.normal(key, (2,)))

    def step(self, state, action):
        shape = jax.ShapeDtypeStruct((2,), "float32")
        return self._state(jax.pure_callback(advance, shape, state.data, action))

    def _state(self, x):
        return EnvState(x, x, x[0])
"""


def test_an_error_in_a_callback_is_a_line_of_its_file(conf, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "swing.py").write_text(CALLBACK)
    world = import_module("swing").Swing()
    step = jax.jit(world.step)
    with pytest.raises(UsageError, match=r"^swing\.py:8: Swing\.step: "):
        SourceOf(world).blamed("step", step, world.reset(jax.random.key(0)), jnp.zeros(1))
