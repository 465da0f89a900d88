"""The study of active learning: figure 4-1."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from studied import drawn, trained
from tiny import rows_of

from hybrid_rl.envs.analytic.cart_swing_up import CartSwingUp
from hybrid_rl.models.exact import Exact
from hybrid_rl.run.saved import load
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
]


def data(*_: Any) -> unseen.Unseen:
    """Transitions of the world itself, drawn by NumPy."""
    rng = np.random.default_rng(0)
    x, u = jnp.asarray(rng.normal(size=(50, 4))), jnp.asarray(rng.uniform(-1, 1, (50, 1)))
    batch = unseen.transitions(x, u, jax.vmap(CartSwingUp().dynamics)(x, u))
    return unseen.Unseen(batch, batch, np.array([0.5, 0.7]), np.full((2, 30), 0.95))


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


def test_figure_of_tiny_runs(tmp_path, monkeypatch) -> None:
    """Costs are those of the log; the last loss is that of the last model."""
    monkeypatch.setattr(unseen, "collect", data)
    monkeypatch.setattr(active_learning, "UPDATES", 200)
    for name, level in (("none", 0.0), ("noise", 0.5)):
        trained(*SHORT, f"noisy.level={level}", f"run_dir={tmp_path / name}")
    numbers = drawn(tmp_path / "f.png", "active_learning", f"runs={tmp_path}/no*", "refit=20")
    one = numbers["methods"]["none"]
    assert one["area"]["cost"][0] == pytest.approx(np.mean(one["each"]["cost"]), rel=1e-3)
    rows = rows_of(tmp_path / "none")
    returns = [row["train/return"] for row in rows if "train/return" in row and row["step"] == 30]
    np.testing.assert_allclose(one["first_cost"], np.array(returns) / -30, rtol=1e-3)
    run = load(tmp_path / "none")
    model = run.controllers["full"].model
    losses = jax.vmap(lambda params: unseen.loss(model, params, data().box))
    assert one["loss_box"][0][-1] == pytest.approx(losses(run.params.model).mean(), rel=1e-3)
    assert set(numbers["differences"]) == {"noise"}
    assert set(numbers["refit"]) == {"noise", "none"}
