"""The command that tells what flights cost and taught."""

import json

import numpy as np
import pytest
from tiny import call

from hybrid_rl import command, config, flights, train

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


def test_others_are_of_another_trial() -> None:
    """What a model is asked of was not in its data."""
    x = np.arange(2.0)[:, None, None] * np.ones((2, 3, 18))
    both = [flight(obs=x), flight(obs=x)]
    assert (flights.others(both, 0, 50).obs == 1).all()
    assert (flights.others(both, 1, 50).obs == 0).all()


def test_runs_become_a_picture_and_its_numbers(tmp_path) -> None:
    """Two methods, labelled apart; what was flown is what the run remembers."""
    train.train(config.load([*SHORT, "algo=ou_noise", f"run_dir={tmp_path / 'ou'}"]))
    more = ["algo=normal_noise", "noisy.level=0", f"run_dir={tmp_path / 'still'}"]
    train.train(config.load([*SHORT, *more, "env.twist=0"]))
    read = flights.read(tmp_path / "still")
    assert read.label == "normal_noise 0"
    np.testing.assert_allclose(read.action, 0.40875, atol=1e-4)
    np.testing.assert_allclose(read.next_obs[:, :-1], read.obs[:, 1:])
    out = tmp_path / "f.png"
    arguments = (f"runs={tmp_path}/*", f"out={out}", "updates=5", "steps=4")
    assert call(lambda: command.guarded(flights.main), *arguments) == 0
    said = json.loads(out.with_suffix(".json").read_text())
    assert set(said) == {"normal_noise 0", "ou_noise 0.1"}
    assert said["normal_noise 0"]["power_loss"][0] < 1e-3 < said["ou_noise 0.1"]["power_loss"][0]
    assert said["ou_noise 0.1"]["kept_hover"] == 1
    assert out.stat().st_size > 1000


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
