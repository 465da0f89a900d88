"""The study of model learning in flight."""

from types import SimpleNamespace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from studied import drawn, trained
from tiny import rows_of

from hybrid_rl.data.replay import Memory, Replay
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.models.exact import Exact
from hybrid_rl.models.local_linear import LocalLinear
from hybrid_rl.thesis.studies import flights, model_learning
from hybrid_rl.types import Batch, Params

SHORT = [
    "experiment=thesis/table_6_1",
    *(f"{name}=40" for name in ("total_steps", "episode.steps", "eval_every", "checkpoint_every")),
    "num_seeds=2",
    "log_every=20",
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


def test_runs_become_a_picture_and_its_numbers(tmp_path) -> None:
    """Two methods with two labels; the costs are those of the replay memory and of the log."""
    runs = tmp_path / "runs"
    trained(*SHORT, "algo=ou_noise", f"run_dir={runs / 'ou'}")
    still = ["algo=normal_noise", "noisy.level=0", "env.twist=0", f"run_dir={runs / 'still'}"]
    trained(*SHORT, *still)
    flown = flights.read(runs / "still")
    np.testing.assert_allclose(flown.action, 0.40875, atol=1e-4)
    np.testing.assert_allclose(flown.next_obs[:, :-1], flown.obs[:, 1:])
    given = (f"runs={runs}/*", "updates=5", "steps=4")
    numbers = drawn(tmp_path / "f.png", "model_learning", *given)
    assert set(numbers) == {"normal_noise 0", "ou_noise 0.1", "exact model"}
    assert all("tracking" in one for one in numbers.values())
    hover, noise = numbers["normal_noise 0"], numbers["ou_noise 0.1"]
    assert hover["power_loss"][0] < 1e-3 < noise["power_loss"][0]
    assert noise["kept_hover"] == 1
    logged = [row["world/power_loss"] for row in rows_of(runs / "ou") if "world/power_loss" in row]
    assert noise["power_loss"][0] == pytest.approx(np.mean(logged), rel=1e-3)
