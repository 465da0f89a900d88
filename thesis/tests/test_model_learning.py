"""The study of model learning in flight."""

import json
import re
from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from tiny import call, rows_of

from hybrid_rl import figures, train
from hybrid_rl.cli import command
from hybrid_rl.data.replay import Memory, Replay
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.models.exact import Exact
from hybrid_rl.models.local_linear import LocalLinear
from hybrid_rl.settings import build as config
from hybrid_rl.thesis.studies import flights, model_learning
from hybrid_rl.types import Batch, Params

SHORT = [
    "experiment=thesis/table_6_1",
    *(f"{name}=40" for name in ("total_steps", "episode.steps", "eval_every", "checkpoint_every")),
    "num_seeds=2",
    "log_every=20",
    "compile_cache=null",
]


def draw(*arguments) -> int:
    """Exit code of the command."""
    return call(lambda: command.run(figures.main), "study=model_learning", *arguments)


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
    """Rows of zeros except for the position along x, which counts trials and decisions."""
    spec = QuadcopterSE3().spec
    rows = jnp.zeros((3, 5, 1, Replay.width(spec)))
    rows = rows.at[..., 0].set(10 * jnp.arange(3.0)[:, None, None] + jnp.arange(5.0)[None, :, None])
    cut = flights.first("any", Memory(rows, jnp.full(3, 5)), 2, 4)
    np.testing.assert_array_equal(cut.obs[..., 0], [[0, 1, 2, 3], [10, 11, 12, 13]])
    np.testing.assert_array_equal(cut.memory.count, [4, 4])


def test_error_of_the_exact_model_and_of_its_linearisation() -> None:
    """The exact model has none, the linearisation a small one."""
    world, rng = QuadcopterSE3(), np.random.default_rng(0)
    x = jnp.asarray(rng.uniform(-0.3, 0.3, (50, 12)), jnp.float32)
    obs, u = jax.vmap(world.from_local)(x), jnp.asarray(rng.uniform(-1, 1, (50, 4)), jnp.float32)
    after, no = jax.vmap(world.dynamics)(obs, u), jnp.zeros(50)
    data = Batch(obs, u, no, no, no, after, u)
    errors = {}
    for name, model in {"exact": Exact(world), "local_linear": LocalLinear(world)}.items():
        agent = SimpleNamespace(learners={"model": SimpleNamespace(model=model)})
        run: Any = SimpleNamespace(agent=agent)
        errors[name] = float(model_learning.error(run, Params(), data))
    assert errors["exact"] == 0
    assert 0.01 < errors["local_linear"] < 0.5


def test_runs_become_a_picture_and_its_numbers(tmp_path, capsys) -> None:
    """Two methods with two labels; the costs are those of the replay memory and of the log."""
    train.train(config.load([*SHORT, "algo=ou_noise", f"run_dir={tmp_path / 'runs' / 'ou'}"]))
    more = ["algo=normal_noise", "noisy.level=0", f"run_dir={tmp_path / 'runs' / 'still'}"]
    train.train(config.load([*SHORT, *more, "env.twist=0"]))
    still = flights.read(tmp_path / "runs" / "still")
    assert still.label == "normal_noise 0"
    np.testing.assert_allclose(still.action, 0.40875, atol=1e-4)
    np.testing.assert_allclose(still.next_obs[:, :-1], still.obs[:, 1:])
    out = tmp_path / "f.png"
    arguments = (f"runs={tmp_path}/runs/*", f"out={out}", "updates=5", "steps=4")
    assert draw(*arguments) == 0
    lines = capsys.readouterr().out.splitlines()
    begins = (
        "compiling",
        "normal_noise 0: learned and flown (1 of 2, ",
        "ou_noise 0.1: learned and flown (2 of 2, ",
        "normal_noise 0, 2 trials: ",
        "ou_noise 0.1, 2 trials: ",
        "exact model, 2 trials: tracking ",
    )
    for line, begin in zip(lines[-7:-1], begins, strict=True):
        assert line.startswith(begin)
    assert "kept the hover in 100%, error " in lines[-3]
    numbers = json.loads(out.with_suffix(".json").read_text())
    assert set(numbers) == {"normal_noise 0", "ou_noise 0.1", "exact model"}
    hover, noise = numbers["normal_noise 0"], numbers["ou_noise 0.1"]
    assert hover["power_loss"][0] < 1e-3 < noise["power_loss"][0]
    assert noise["kept_hover"] == 1
    rows = rows_of(tmp_path / "runs" / "ou")
    logged = [row["world/power_loss"] for row in rows if "world/power_loss" in row]
    assert noise["power_loss"][0] == pytest.approx(np.mean(logged), rel=1e-3)
    assert out.stat().st_size > 1000
    assert draw(*arguments[:2], "updates=0") == 0
    assert "tracking" not in json.loads(out.with_suffix(".json").read_text())["ou_noise 0.1"]


def test_a_batch_and_its_update_have_keys_of_their_own() -> None:
    """A learner whose state counts the updates that received the key of their batch."""
    same = lambda batch, key: jnp.all(batch == jax.random.key_data(key))  # noqa: E731
    learner = SimpleNamespace(
        batch_size=1,
        batches=1,
        init=lambda key, spec: jnp.zeros((), int),
        update=lambda state, params, batch, key: (state + same(batch, key), {}),
        params=lambda state: {"model": state},
    )
    replay = SimpleNamespace(sample=lambda memory, spec, size, key: jax.random.key_data(key))
    agent = SimpleNamespace(learners={"model": learner}, replay=replay, spec=None)
    run: Any = SimpleNamespace(agent=agent)
    assert model_learning.learn(run, None, 5, jax.random.key(0)).model == 0


def test_the_summary_has_a_line_a_method() -> None:
    """Cost as mean and deviation, error and tracking with a band if a model was learned."""
    numbers = model_learning.reported(flights.cost(flight()), 0.005)
    cost = "hover 1, 2 trials: power loss 0 ± 0 N, |u| 0.8175 ± 0, kept the hover in 100%"
    numbers["power_loss"] = [0.0, 0.0]  # not the rounding of float32
    assert model_learning.summary({"hover 1": numbers}) == [cost]
    more = {"error": [0.2, 0.1, 0.3], "tracking": [1.0, 0.5, 2.0]}
    exact = {"trials": 2, "tracking": [1.0, 0.5, 2.0]}
    assert model_learning.summary({"hover 1": numbers | more, "exact model": exact}) == [
        f"{cost}, error 0.2 [0.1, 0.3], tracking 1 [0.5, 2] m",
        "exact model, 2 trials: tracking 1 [0.5, 2] m",
    ]


def test_flights_of_one_label_have_labels_of_their_own(tmp_path, monkeypatch) -> None:
    """By the settings that differ, or by their folders: none replaces another."""
    for name, twist in (("a", 0), ("b", 1), ("c", 1)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "config.yaml").write_text(f"task: t\nenv: {{twist: {twist}}}\n")
    monkeypatch.setattr(flights, "read", lambda folder: flight()._replace(label="ou 1"))
    a, b, c = (tmp_path / name for name in "abc")
    assert [one.label for one in flights.read_all([a])] == ["ou 1"]
    assert [one.label for one in flights.read_all([a, b])] == ["ou 1 twist=0", "ou 1 twist=1"]
    assert [one.label for one in flights.read_all([b, c])] == [f"ou 1 {b}", f"ou 1 {c}"]


def test_legends_name_the_quantity_of_a_label() -> None:
    assert model_learning.named("kle3_model_learning 11") == "kle3_model_learning, gain 11"
    assert model_learning.named("ou_noise 0.1") == "ou_noise, level 0.1"


def test_the_picture_has_plain_ticks_and_whole_points() -> None:
    """On logarithmic axes, too; and no legend covers a curve."""
    rng = np.random.default_rng(0)
    cost = {"power_loss": np.array([0.5, 0.6]), "error": np.array([0.2, 0.3])}
    results = {
        label: cost | {"distance": rng.uniform(0.5, 2, (2, 500)), "turned_over": np.zeros(2)}
        for label in ("ou_noise 0.1", "kle3 11", "exact model")
    }
    figure = model_learning.draw(
        {label: model_learning.reported(one, 0.005) for label, one in results.items()}
    )
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    for axes in figure.axes:
        box = figure.legends[0].get_window_extent(canvas.get_renderer())
        assert not box.overlaps(axes.bbox.padded(-0.5))
        for axis in (axes.xaxis, axes.yaxis):
            low, high = axis.get_view_interval()
            inside = [
                text for text in axis.get_ticklabels() if low <= sum(text.get_position()) <= high
            ]
            assert len(inside) >= 2
            assert all(re.fullmatch(r"[0-9,.]+", text.get_text()) for text in inside)
    low, high = figure.axes[1].get_xlim()
    assert low < 0.55 < high
