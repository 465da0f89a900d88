"""The study of active learning: figure 4-1."""

import json
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import call

from hybrid_rl import figures, train
from hybrid_rl.cli import command
from hybrid_rl.envs.analytic.cart_swing_up import CartSwingUp
from hybrid_rl.models.exact import Exact
from hybrid_rl.run.saved import load
from hybrid_rl.settings import build as config
from hybrid_rl.thesis.studies import active_learning, unseen

SHORT = [
    "experiment=thesis/fig_4_1",
    "algo=known_mpc",
    "adjoint_planner.horizon=2",
    "shooting_planner.iterations=1",
    "model.hidden=[4]",
    "model_learner.updates=1",
    "model_learner.batch_size=4",
    "episode.steps=30",
    "history.every=30",
    *(f"{name}=90" for name in ("total_steps", "eval_every", "checkpoint_every")),
    "num_seeds=2",
    "compile_cache=null",
]


def draw(*arguments: str) -> int:
    """Exit code of the command."""
    return call(lambda: command.run(figures.main), "study=active_learning", *arguments)


def data(*_: Any) -> unseen.Unseen:
    """Transitions of the world itself, drawn by NumPy."""
    rng = np.random.default_rng(0)
    x, u = jnp.asarray(rng.normal(size=(50, 4))), jnp.asarray(rng.uniform(-1, 1, (50, 1)))
    batch = unseen.transitions(x, u, jax.vmap(CartSwingUp().dynamics)(x, u))
    return unseen.Unseen(batch, batch, np.array([0.5, 0.7]), np.full((2, 30), 0.95))


def test_figure_of_tiny_runs(tmp_path, monkeypatch, capsys) -> None:
    """Costs are those of the log; the last loss is that of the last model."""
    monkeypatch.setattr(unseen, "collect", data)
    monkeypatch.setattr(active_learning, "UPDATES", 200)
    for level in (0.0, 0.5):
        folder = tmp_path / ("noise" if level else "none")
        train.train(config.load([*SHORT, f"noisy.level={level}", f"run_dir={folder}"]))
    assert draw(f"runs={tmp_path}/no*", "refit=20", f"out={tmp_path}/f.png") == 0
    numbers = json.loads((tmp_path / "f.json").read_text())
    lines = (tmp_path / "none" / "metrics.jsonl").read_text().splitlines()
    rows = [json.loads(line) for line in lines]
    returns = [row["train/return"] for row in rows if "train/return" in row and row["step"] == 30]
    one = numbers["methods"]["none"]
    assert one["area"]["cost"][0] == pytest.approx(np.mean(one["each"]["cost"]), rel=1e-3)
    first = one["first_cost"]
    np.testing.assert_allclose(first, np.array(returns) / -30, rtol=1e-3)
    trained = load(tmp_path / "none")
    model = trained.controllers["full"].model
    losses = jax.vmap(lambda params: unseen.loss(model, params, data().box))
    last = numbers["methods"]["none"]["loss_box"][0][-1]
    assert last == pytest.approx(losses(trained.params.model).mean(), rel=1e-3)
    assert set(numbers["differences"]) == {"noise"}
    assert set(numbers["refit"]) == {"noise", "none"}
    printed = capsys.readouterr().out
    assert "exact model: cost 0.6 [0.5, 0.7], upright 100%" in printed
    assert "noise, 2 seeds: cost " in printed
    assert "none, fitted again: log10 loss: uniform " in printed


def test_the_exact_model_has_no_loss_and_standing_still_has_one() -> None:
    """One for a model that predicts the mean change, zero for the world itself."""
    world: Any = CartSwingUp()
    batch = data().box
    np.testing.assert_allclose(unseen.loss(Exact(world), (), batch), 0, atol=1e-10)
    mean = (batch.next_obs - batch.obs).mean(0)

    class Mean:
        def step(self, params, x, u):
            return x + mean

    np.testing.assert_allclose(unseen.loss(Mean(), (), batch), 1, rtol=1e-5)


def test_information_adds_up() -> None:
    """Against NumPy at the first and at the last end; the diagonal bounds the determinant."""
    F = np.random.default_rng(0).normal(size=(6, 2, 5))
    result = unseen.information(F, np.array([2, 6]), 0.1)
    for i, end in enumerate((2, 6)):
        rows = F[:end].reshape(-1, 5)
        total = rows.T @ rows + 0.1 * np.eye(5)
        np.testing.assert_allclose(result["log_det"][i], np.log(np.linalg.eigvalsh(total)).sum())
        np.testing.assert_allclose(result["trace"][i], np.trace(total))
    assert (result["log_det_diagonal"] >= result["log_det"]).all()


def test_methods_differ_by_a_test_of_their_seeds() -> None:
    """Five seeds above five others: p is 0.008; with three pairs the other way round, 0.056."""
    base = np.arange(5.0)
    areas = {"none": base, "a": base + 5, "b": base + 2.5, "c": base - 5}
    methods = {label: {"each": {"cost": each}} for label, each in areas.items()}
    verdicts = active_learning.differences(methods, "none")
    assert {label: one["cost"] for label, one in verdicts.items()} == {
        "a": "higher",
        "b": "no difference",
        "c": "lower",
    }


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["runs=nowhere/*"], "runs=nowhere/*: no run there"),
        (["runs={}", "against=best"], "against=best: no such run; choose one of"),
    ],
)
def test_bad_arguments_are_one_line(tmp_path, capfd, arguments, line) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "metrics.jsonl").write_text("{}\n")
    given = [argument.format(f"{tmp_path}/a") for argument in arguments]
    assert draw(*given, f"out={tmp_path}/f.png") == 2
    assert line in capfd.readouterr().err
