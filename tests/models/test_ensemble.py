"""Ensembles against their members."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.models.ensemble import Ensemble
from hybrid_rl.models.gaussian import Gaussian
from hybrid_rl.types import Spec

SPEC = Spec(obs=3, act=2, dt=0.1)
KEY = jax.random.key(4)
ONE = Gaussian(hidden=(8,))
MODEL = Ensemble(ONE, members=4)
X, U, NOISE = jnp.array([0.3, -1.0, 2.0]), jnp.array([0.5, -0.2]), jnp.array([1.0, 0.0, -2.0])


def member(params: dict, i: int) -> dict:
    """The parameters of member i."""
    return {**params, "weights": jax.tree.map(lambda w: w[i], params["weights"])}


@pytest.fixture
def params():
    return jax.jit(lambda key: MODEL.init(key, SPEC))(jax.random.key(0))


def test_members_differ_and_are_averaged(params) -> None:
    """`step` is the mean of the members' predictions, which differ."""
    step = jax.jit(ONE.step)
    each = np.stack([step(member(params, i), X, U) for i in range(4)])
    assert each.std(0).min() > 1e-3
    np.testing.assert_allclose(jax.jit(MODEL.each)(params, X, U), each, rtol=1e-6)
    np.testing.assert_allclose(jax.jit(MODEL.step)(params, X, U), each.mean(0), rtol=1e-5)


def test_the_disagreement_has_a_gradient_where_all_agree(params) -> None:
    """Zero, not NaN, so that a planner by gradients goes on."""
    same = {**params, "weights": jax.tree.map(lambda w: w[:1].repeat(4, 0), params["weights"])}
    slope = jax.jit(jax.grad(lambda u: MODEL.predictions(same, X, u)[1].sum()))(U)
    np.testing.assert_allclose(slope, 0, atol=1e-3)


def test_every_member_has_its_own_batch(params) -> None:
    """The loss is the mean over the members, each on its share of the transitions."""
    x, u, after = (
        jax.random.normal(jax.random.key(i), (8, n)) for i, n in ((1, 3), (2, 2), (3, 3))
    )
    shares = [slice(2 * i, 2 * i + 2) for i in range(4)]
    loss, whole = jax.jit(ONE.loss), jax.jit(MODEL.loss)
    losses = [loss(member(params, i), x[s], u[s], after[s], KEY) for i, s in enumerate(shares)]
    np.testing.assert_allclose(whole(params, x, u, after, KEY), np.mean(losses), rtol=1e-5)
    gradient = jax.jit(
        jax.grad(lambda w, after: MODEL.loss({**params, "weights": w}, x, u, after, KEY))
    )
    moved = jax.tree.map(
        lambda a, b: np.abs(np.asarray(a - b)).reshape(4, -1).max(1) > 0,
        gradient(params["weights"], after.at[:2].add(1)),
        gradient(params["weights"], after),
    )
    assert np.any(jax.tree.leaves(moved), axis=0).tolist() == [True, False, False, False]


def test_members_draw_equally_many_states(params) -> None:
    """Each next state is one member's draw with its own noise; the key selects the member."""
    x, u, noise = (
        jax.random.normal(jax.random.key(i), (10, n)) for i, n in ((1, 3), (2, 2), (3, 3))
    )
    alone, draw = jax.jit(ONE.draw), jax.jit(MODEL.draw)
    each = np.stack([alone(member(params, i), x, u, noise, None) for i in range(4)])
    members = []
    for seed in range(20):
        got = np.asarray(draw(params, x, u, noise, jax.random.key(seed)))
        assert got.shape == (10, 3)
        apart = np.abs(each - got).max(-1)  # [4, 10]
        assert (apart.min(0) < 1e-5).all()
        counts = np.bincount(apart.argmin(0), minlength=4)
        assert counts.max() <= 3
        members.append(apart.argmin(0))
    assert all(len(set(drawn)) == 4 for drawn in np.transpose(members))
