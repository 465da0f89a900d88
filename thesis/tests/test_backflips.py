"""The study of backflips: safety, flights and queries against closed forms, and its command."""

from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.linalg import solve_discrete_are
from studied import drawn, trained

from hybrid_rl.core.domain import Box
from hybrid_rl.envs.analytic.lander import ANGLE, DT, Lander
from hybrid_rl.policies.deterministic import Deterministic
from hybrid_rl.targets.policy_information import PolicyInformation
from hybrid_rl.thesis.studies import backflips
from hybrid_rl.training.rollout import evaluation_keys
from hybrid_rl.types import Params, Spec


def test_safety_is_that_of_the_states() -> None:
    """V by SciPy's Riccati equation; one state of four beyond 90 degrees, two too high or low."""
    A, B = np.eye(6), np.zeros((6, 2))
    A[:3, 3:] = DT * np.eye(3)
    A[3, 2], B[4], B[5] = -DT, DT, [2 * DT, -2 * DT]
    P = solve_discrete_are(A, B, np.eye(6), 0.001 * np.eye(2))
    obs = np.zeros((2, 4, 6), np.float32)
    obs[0] = np.random.default_rng(0).uniform(-0.5, 0.5, (4, 6))
    obs[1, 1, 2], obs[1, 2, 1], obs[1, 3, 1] = -1.6, 1.1, -1.2
    V, beyond, high, std = backflips.safety(obs)
    np.testing.assert_allclose(V, np.einsum("sti,ij,stj->st", obs, P, obs).max(1), rtol=1e-4)
    np.testing.assert_allclose(beyond, [0, 0.25])
    np.testing.assert_allclose(high, [0, 0.5])
    np.testing.assert_allclose(std, obs.std((0, 1)), rtol=1e-6)


def test_the_regulator_is_lost_far_from_the_hover() -> None:
    """Its actions are bounded; near the hover, where they are not, it returns from all states."""
    shares = backflips.lost((0.01, 10.0, 1e4))
    assert shares[0.01] == 0
    assert 0 < shares[10.0] < shares[1e4]
    assert shares[1e4] > 0.9


def test_a_clone_without_weights_turns_as_its_start_turns() -> None:
    """No thrust: the angle is th + th' t, and no flight succeeds, as all fall."""
    policy = Deterministic((64,), "sin").init(jax.random.key(0), Lander().spec)
    policy = jax.tree.map(lambda leaf: jnp.stack([0 * leaf] * 2), policy)
    success, turned = backflips.flown(policy, (3, 4))
    np.testing.assert_array_equal(success, 0)
    for seed, share in zip((3, 4), turned, strict=True):
        resets = [jax.random.split(key)[0] for key in evaluation_keys(seed, backflips.STARTS)]
        x = np.asarray(jax.vmap(Lander().reset)(jnp.stack(resets)).obs)
        angle = x[:, 2, None] + x[:, 5, None] * DT * np.arange(101)
        assert share == pytest.approx((np.abs(angle + np.pi) < ANGLE).any(1).mean(), abs=1e-6)
        assert 0 < share < 1


def test_the_density_of_a_linear_clone_is_the_squared_distance_plus_one() -> None:
    """p = (|s|^2 + 1) / sum over the points of the objective, wherever the weights are."""
    policy, box = Deterministic((), "sin"), Box((0, 1, 2), (-1.0,) * 3, (1.0,) * 3)
    target = PolicyInformation(policy, Lander(), box, "trace")
    params = Params(policy=policy.init(jax.random.key(1), Spec(6, 2, DT)))
    s = box.sample(50, jax.random.key(2))
    p = jax.nn.softmax(jax.vmap(lambda s: target.log_density(params, s))(s))
    want = 1 + np.sum(np.asarray(s) ** 2, axis=1)
    np.testing.assert_allclose(p, want / want.sum(), rtol=1e-5)


def test_runs_become_two_figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Queries three decisions apart at the states that the run visited."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(backflips, "LENGTHS", (2, 4))
    monkeypatch.setattr(backflips, "STARTS", 3)
    few = ["total_steps=12", "checkpoint_every=12", "eval_every=12", "log_every=6", "num_seeds=2"]
    asking = ["dagger_learner.length=4", "dagger_learner.spacing=3", "dagger_learner.most=3"]
    line = ["experiment=thesis/fig_6_9", "algo=minie", "policy.hidden=[64]"]
    trained(*line, *few, *asking, "dagger_learner.better=false", "run_dir=minie")
    (one,) = backflips.explored("minie")
    assert (one.label, one.most, one.asked.tolist()) == ("minie, spacing 3", 3, [3, 3])
    np.testing.assert_array_equal(one.decision, [[0, 3, 6]] * 2)
    np.testing.assert_array_equal(one.x, one.visited[:, [0, 3, 6]])
    assert (one.own > 0).all()
    rows = {}
    for view in ("backflips", "information"):
        numbers = drawn(tmp_path / f"{view}.png", "imitation", f"view={view}", "runs=minie")
        rows[view] = numbers["rows"]["minie, spacing 3"]
    assert set(rows["backflips"]["3"]["success"]) == {"2", "4"}
    assert set(rows["backflips"]["3"]["turned"]) == {"2", "4"}
    assert len(rows["information"]["reference"]["iqm"]) == 3
