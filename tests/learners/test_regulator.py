"""Regulators of Koopman models, against SciPy and closed forms."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.linalg import solve_discrete_are

from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.envs.analytic.point_mass import PointMass
from hybrid_rl.envs.analytic.quadcopter_se3 import QuadcopterSE3
from hybrid_rl.features.monomials import Monomials
from hybrid_rl.learners.least_squares import LeastSquares
from hybrid_rl.learners.regulator import RegulatorLearner
from hybrid_rl.models.exact import Exact
from hybrid_rl.models.koopman import Koopman
from hybrid_rl.policies.linear import Linear
from hybrid_rl.types import Batch, Params, Spec

SPEC = Spec(obs=2, act=1, dt=0.1)
RNG = np.random.default_rng(0)


def linearised(dynamics, x, u):
    """Derivatives A and B of dynamics."""
    return (np.asarray(m) for m in jax.jit(jax.jacobian(dynamics, (0, 1)))(x, u))


def lqr(A, B, Q, R):
    """The gain of SciPy's solution."""
    P = solve_discrete_are(A, B, Q, R)
    return np.linalg.solve(R + B.T @ P @ B, B.T @ P @ A)


def test_feed_forward_holds_a_goal_that_needs_an_action() -> None:
    """A linear system with a drift, whose hold is B^-1 (I - A) goal."""
    A, B = np.array([[0.9, 0.1], [0.0, 0.8]]), np.array([[0.0], [0.4]])

    def step(x, u):
        return A @ x + B @ u

    params = {**Linear().init(jax.random.key(0), SPEC), "inverse": jnp.linalg.pinv(jnp.asarray(B))}
    goal = jnp.array([0.3, 0.3])  # the first row holds for any u
    aimed = Linear().aim(params, goal, goal, step)
    np.testing.assert_allclose(step(goal, aimed["hold"]), goal, atol=1e-6)
    np.testing.assert_allclose(Linear().mean(aimed, goal), aimed["hold"])


@pytest.mark.parametrize("world", [Pendulum(), PointMass()])
def test_any_model_with_derivatives_has_a_regulator(world) -> None:
    """The exact one of the pendulum, upright, and of the point mass: gains over 200 decisions."""
    learner = RegulatorLearner(Exact(world), Linear(), world, (1.0,), (0.1,), horizon=200)
    state = learner.init(jax.random.key(0), world.spec)
    state, metrics = jax.jit(learner.update)(state, Params(), None, jax.random.key(0))
    A, B = linearised(world.dynamics, *world.equilibrium())
    P, K = np.eye(len(A)), np.zeros_like(B.T)
    for _ in range(200):
        K = np.linalg.solve(0.1 * np.eye(len(K)) + B.T @ P @ B, B.T @ P @ A)
        P = np.eye(len(A)) + A.T @ P @ (A - B @ K)
    np.testing.assert_allclose(state.policy["gain"], K, rtol=1e-3, atol=1e-4)
    np.testing.assert_array_equal(state.policy["goal"], world.equilibrium()[0])
    np.testing.assert_allclose(state.policy["hold"], 0, atol=1e-6)
    assert metrics["policy/rejected_solutions"] == 0


def test_a_solution_that_is_not_finite_is_rejected() -> None:
    """The last gain stays, and the rejection is counted."""
    world = PointMass()
    learner = RegulatorLearner(Koopman(Monomials()), Linear(), world)
    state = learner.init(jax.random.key(0), world.spec)
    good = learner.model.init(jax.random.key(0), world.spec)
    good = {**good, "K": good["K"].at[:, 4:].set(0.3 * jnp.eye(4, 2, -2))}
    update = jax.jit(learner.update)
    state, _ = update(state, Params(model=good), None, jax.random.key(0))
    bad = {**good, "K": good["K"] * jnp.nan}
    after, metrics = update(state, Params(model=bad), None, jax.random.key(0))
    np.testing.assert_array_equal(after.policy["gain"], state.policy["gain"])
    assert np.abs(after.policy["gain"]).max() > 0
    assert metrics["policy/rejected_solutions"] == 1


def test_a_hovering_quadcopter_has_the_gain_and_the_thrust_of_its_linearisation() -> None:
    """K of small motions around the hover, against SciPy on the eight controllable coordinates.

    The vertical component of gravity is the constant that the feed-forward balances.
    """
    world = QuadcopterSE3()
    model = Koopman(Monomials((9, 10, 11, 15, 16, 17, 12, 13, 14), (*[-9.81] * 3, *[1.0] * 6)))
    moved = [0, 1, *range(3, 9)]
    Q, R = np.diag([10.0] * 6 + [50.0] * 3), 36 * np.eye(4)
    with jax.enable_x64(True):
        hover = world.equilibrium()[1]
        local = np.zeros((2000, 12))
        local[:, 3:] = 1e-3 * RNG.uniform(-1, 1, (2000, 9))
        obs = jax.jit(jax.vmap(world.from_local))(jnp.asarray(local))
        u = hover[None] + 1e-3 * RNG.uniform(-1, 1, (2000, 4))
        after = jax.jit(jax.vmap(world.dynamics))(obs, u)
        learner = LeastSquares(model, prior=1e-14)
        state = learner.init(jax.random.key(0), world.spec)
        none = jnp.zeros(len(obs))
        batch = Batch(*map(jnp.asarray, (obs, u)), none, none, none, jnp.asarray(after))
        state, _ = jax.jit(learner.update)(state, Params(), batch, jax.random.key(0))
        weights = tuple(np.diag(Q)), tuple(np.diag(R))
        regulator = RegulatorLearner(model, Linear(), world, *weights, horizon=1024)
        policy = Linear().init(jax.random.key(0), world.spec._replace(state=9))
        policy = jax.tree.map(lambda x: x.astype(float), policy)
        solved = jax.jit(regulator.solve)(state.model, policy)
        np.testing.assert_allclose(solved["hold"], hover, rtol=0.01)

        def reduced(y, u):
            """The next eight coordinates of a small motion y."""
            s = jnp.stack([y[1] / 9.81, -y[0] / 9.81, 0.0])  # gravity in the body frame: -g R' e3
            e = jnp.concatenate([jnp.zeros(3), -s, y[5:], y[2:5]])
            x = world.dynamics(world.from_local(e), u)
            return model.lift(state.model, x)[jnp.array(moved)]

        A, B = linearised(reduced, jnp.zeros(8), hover)
    F = lqr(A, B, Q[np.ix_(moved, moved)], R)
    gain = np.asarray(solved["gain"])[:, moved]
    np.testing.assert_allclose(gain, F, rtol=0.01, atol=0.01 * np.abs(F).max())
