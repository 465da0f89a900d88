"""The command that tells what flights cost and taught."""

import json
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import call

from hybrid_rl import command, config, flights, train
from hybrid_rl.data.replay import Memory, Replay
from hybrid_rl.envs.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.types import Batch, Params

SHORT = [
    "experiment=thesis/table_6_1",
    *(f"{name}=40" for name in ("total_steps", "episode.steps", "eval_every", "checkpoint_every")),
    "num_seeds=2",
    "log_every=20",
    "compile_cache=null",
]


def flight(**fields: np.ndarray) -> flights.Flight:
    """Two trials of three decisions at hover."""
    hover = np.zeros((2, 3, 18))
    still = {
        "obs": hover,
        "action": np.full((2, 3, 4), 0.40875),
        "next_obs": hover,
        "terminated": np.zeros((2, 3)),
    }
    return flights.Flight("hover", None, **(still | fields))


def test_cost_by_hand() -> None:
    """Hover costs nothing; one full rotor for one decision of three costs what it lifts."""
    cost = flights.cost(flight())
    np.testing.assert_allclose(cost["power_loss"], 0, atol=1e-6)
    np.testing.assert_allclose(cost["norm_of_u"], 0.8175)
    action = np.full((2, 3, 4), 0.40875)
    action[1, 2, 0] = 1
    next_obs = np.zeros((2, 3, 18))
    next_obs[1, 1, :3] = 3, 0, 4
    terminated = np.zeros((2, 3))
    terminated[0, 1] = 1
    cost = flights.cost(flight(action=action, next_obs=next_obs, terminated=terminated))
    np.testing.assert_allclose(cost["power_loss"], [0, 0.59125 * 3.6 / 3], atol=1e-6)
    np.testing.assert_allclose(cost["furthest"], [0, 5])
    np.testing.assert_array_equal(cost["lost"], [1, 0])


def test_first_cuts_trials_and_decisions() -> None:
    """Rows of zeros but for the place along x, which counts trials and decisions."""
    spec = QuadcopterSE3().spec
    rows = jnp.zeros((3, 5, 1, Replay.width(spec)))
    rows = rows.at[..., 0].set(10 * jnp.arange(3.0)[:, None, None] + jnp.arange(5.0)[None, :, None])
    cut = flights.first("any", Memory(rows, jnp.full(3, 5)), 2, 4)
    np.testing.assert_array_equal(cut.obs[..., 0], [[0, 1, 2, 3], [10, 11, 12, 13]])
    np.testing.assert_array_equal(cut.memory.count, [4, 4])


def test_error_of_the_exact_model_and_of_its_linearisation() -> None:
    """The one is right, the other nearly."""
    world, rng = QuadcopterSE3(), np.random.default_rng(0)
    x = jnp.asarray(rng.uniform(-0.3, 0.3, (50, 12)), jnp.float32)
    obs, u = jax.vmap(world.place)(x), jnp.asarray(rng.uniform(-1, 1, (50, 4)), jnp.float32)
    after, no = jax.vmap(world.flow)(obs, u), jnp.zeros(50)
    seen = Batch(obs, u, no, no, no, after, u)
    found = {}
    for name in ("exact", "local_linear"):
        over = [*flights.TRACKING, f"model@known_model={name}", "likelihood.model=${known_model}"]
        found[name] = float(flights.error(config.build(config.load(over)), Params(), seen))
    assert found["exact"] == 0
    assert 0.01 < found["local_linear"] < 0.5


def test_runs_become_a_picture_and_its_numbers(tmp_path) -> None:
    """Two methods, labelled apart; what was flown is what the run remembers, and what it logged."""
    train.train(config.load([*SHORT, "algo=ou_noise", f"run_dir={tmp_path / 'runs' / 'ou'}"]))
    more = ["algo=normal_noise", "noisy.level=0", f"run_dir={tmp_path / 'runs' / 'still'}"]
    train.train(config.load([*SHORT, *more, "env.twist=0"]))
    read = flights.read(tmp_path / "runs" / "still")
    assert read.label == "normal_noise 0"
    np.testing.assert_allclose(read.action, 0.40875, atol=1e-4)
    np.testing.assert_allclose(read.next_obs[:, :-1], read.obs[:, 1:])
    out = tmp_path / "f.png"
    arguments = (f"runs={tmp_path}/runs/*", f"out={out}", "updates=5", "steps=4")
    assert call(lambda: command.guarded(flights.main), *arguments) == 0
    said = json.loads(out.with_suffix(".json").read_text())
    assert set(said) == {"normal_noise 0", "ou_noise 0.1", "exact model"}
    assert said["normal_noise 0"]["power_loss"][0] < 1e-3 < said["ou_noise 0.1"]["power_loss"][0]
    assert said["ou_noise 0.1"]["kept_hover"] == 1
    rows = map(json.loads, (tmp_path / "runs" / "ou" / "metrics.jsonl").read_text().splitlines())
    logged = [row["world/power_loss"] for row in rows if "world/power_loss" in row]
    assert said["ou_noise 0.1"]["power_loss"][0] == pytest.approx(np.mean(logged), rel=1e-3)
    assert out.stat().st_size > 1000
    assert call(lambda: command.guarded(flights.main), *arguments[:2], "updates=0") == 0
    assert "tracking" not in json.loads(out.with_suffix(".json").read_text())["ou_noise 0.1"]


def test_a_batch_and_its_update_have_keys_of_their_own() -> None:
    """A learner whose state counts the updates that were given the key of their batch."""
    same = lambda batch, key: jnp.all(batch == jax.random.key_data(key))  # noqa: E731
    learner = SimpleNamespace(
        batch_size=1,
        init=lambda key, spec: jnp.zeros((), int),
        update=lambda state, params, batch, key: (state + same(batch, key), {}),
        params=lambda state: {"model": state},
    )
    replay = SimpleNamespace(sample=lambda memory, spec, size, key: jax.random.key_data(key))
    agent = SimpleNamespace(learners={"model": learner}, replay=replay, spec=None)
    run: Any = SimpleNamespace(agent=agent)
    assert flights.learn(run, None, 5, jax.random.key(0)).model == 0


@pytest.mark.parametrize(
    ("given", "words"),
    [("runs=nowhere/*", "no run folder there"), ("runs=*", "must end in .png")],
)
def test_bad_arguments_are_one_line(given, words, capsys, tmp_path, monkeypatch) -> None:
    """And exit code 2."""
    (tmp_path / "a").mkdir()
    monkeypatch.chdir(tmp_path)
    arguments = [given, "out=a.gif"] if given == "runs=*" else [given]
    assert call(lambda: command.guarded(flights.main), *arguments) == 2
    assert words in capsys.readouterr().err
