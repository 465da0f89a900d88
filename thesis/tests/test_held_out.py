"""Held-out errors of learned models."""

import json
from pathlib import Path
from types import SimpleNamespace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import call, finished

from hybrid_rl import figures
from hybrid_rl.cli import command
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.errors import UsageError
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.run.saved import load
from hybrid_rl.thesis.studies import held_out
from hybrid_rl.types import Params, Spec

pytestmark = pytest.mark.turns(3)


def test_the_error_is_that_of_numpy_for_linear_models() -> None:
    """One model for each of two seeds; predicting the mean change gives 1."""
    model, rng = Gaussian(hidden=(), normalise=False), np.random.default_rng(0)
    obs, action = rng.normal(size=(40, 2)), rng.normal(size=(40, 1))
    after = obs + rng.normal(size=(40, 2)) * [0.1, 3.0] + [1.0, -2.0]
    keys = jax.random.split(jax.random.key(0), 2)
    params = jax.vmap(lambda key: model.init(key, Spec(2, 1, 0.1)))(keys)
    layer = params["weights"]["net"]["params"]["Dense_0"]
    layer["kernel"] = layer["kernel"].at[1].set(0)
    layer["bias"] = layer["bias"].at[1].set((after - obs).mean(0))
    agent = SimpleNamespace(learners={"model": SimpleNamespace(model=model)})
    run = SimpleNamespace(agent=agent, params=Params(model=params))
    data = (jnp.asarray(each, jnp.float32) for each in (obs, action, after))
    errors = held_out.errors(run, *data)
    change = np.concatenate([obs, action], 1) @ np.asarray(layer["kernel"][0])
    change += np.asarray(layer["bias"][0])
    first = np.sqrt((((obs + change - after) ** 2).mean(0) / (after - obs).var(0)).mean())
    np.testing.assert_allclose(errors, [first, 1.0], rtol=1e-4)


# A run of two learners of a model.
folder = finished("algo=nn_mppi", "total_steps=60", "num_seeds=2")


def test_the_study_measures_each_seed_on_both_kinds_of_decisions(folder: Path) -> None:
    out = folder.with_name("held_out.png")
    line = ("study=held_out", f"runs={folder}", "decisions=100", f"out={out}")
    assert call(lambda: command.run(figures.main), *line) == 0
    (one,) = json.loads(out.with_suffix(".json").read_text())["runs"].values()
    assert (one["step"], one["seeds"]) == (60, [0, 1])
    assert all(error > 0 for kind in held_out.SETS for error in one[kind]["each"])


def test_held_out_decisions_are_transitions_of_the_task(folder: Path) -> None:
    """The pendulum's own dynamics lead from each observation to the next one, for both kinds."""
    data = held_out.held_out([load(folder, "runs")], 50)
    assert sorted(data) == sorted(held_out.SETS)
    for obs, action, after in data.values():
        assert obs.shape == (50, 3)
        want = jax.vmap(Pendulum().dynamics)(obs, jnp.clip(action, -1, 1))
        np.testing.assert_allclose(after, want, atol=1e-4)


def test_a_run_without_a_model_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    run = SimpleNamespace(task="pendulum", params=Params())
    monkeypatch.setattr(held_out, "find", lambda runs: [Path("runs/a")])
    monkeypatch.setattr(held_out, "load", lambda *_: run)
    with pytest.raises(UsageError, match=r"^runs=runs/a: .* learned model"):
        held_out.figure("runs/a")
