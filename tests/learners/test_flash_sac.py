"""The learner of flash_sac and its parts, on problems with known values."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from scipy.stats import norm

from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.critics.categorical_q import CategoricalQ
from hybrid_rl.learners.flash_sac import FlashSAC
from hybrid_rl.policies.unit_gaussian import UnitGaussian
from hybrid_rl.types import Batch, Params, Spec

SPEC = Spec(obs=1, act=1, dt=1.0)
B = 48
STEPS = 1000


def learner(**fields: float) -> FlashSAC:
    """A small learner with a high rate, and a discount for short tasks."""
    quick = {"learning_rate": 5e-3, "tau": 0.05, "batch_size": B, "batches": 1, "discount": 0.5}
    critic = CategoricalQ(hidden=(32,), bins=51)
    return FlashSAC(UnitGaussian(hidden=(16,)), critic, **(quick | fields))


def batch(key: Array, terminated: Array) -> Batch:
    """States in [-1, 1], uniform actions; reward 2 - (2 u - x)^2, best at u = x / 2."""
    x, u, after = jax.random.uniform(key, (3, B, 1), minval=-1, maxval=1)
    reward = 2 - ((2 * u - x) ** 2)[:, 0]
    return Batch(x, u, reward, terminated * jnp.ones(B), jnp.ones(B), after)


@pytest.fixture(scope="module")
def train():
    """(terminated, scale, alpha) -> state after training, and metrics [STEPS]; one program."""
    made = learner()

    @jax.jit
    def run(terminated, scale, alpha):
        def one(state, key):
            return made.update(state, Params(scale=scale), batch(key, terminated), key)

        state = made.init(jax.random.key(0), SPEC).replace(log_alpha=jnp.log(alpha))
        return jax.lax.scan(one, state, jax.random.split(jax.random.key(1), STEPS))

    return lambda *numbers: (made, *run(*map(jnp.float32, numbers)))


@pytest.fixture(scope="module")
def trained(train) -> tuple:
    """The learner with its state and metrics after terminal transitions, rewards divided by 2."""
    return train(1.0, 2.0, 0.05)


def test_at_terminal_transitions_q_is_the_scaled_reward(trained) -> None:
    made, state, _ = trained
    x, u = jnp.array([[0.8], [0.0], [-0.8]]), jnp.array([[0.4], [0.5], [0.4]])
    q = jax.jit(made.critic.value)(state.critic, x, u)
    np.testing.assert_allclose(q, (2 - (2 * u - x)[:, 0] ** 2) / 2, atol=0.2)


def test_the_policy_finds_the_best_action_of_each_state(trained) -> None:
    made, state, _ = trained
    x = jnp.array([[-0.8], [0.0], [0.8]])
    mean = jax.jit(made.policy.mean)(state.policy, x)
    np.testing.assert_allclose(mean, x / 2, atol=0.12)


def test_the_entropy_becomes_that_of_the_given_sigma(trained) -> None:
    """By SciPy; the temperature moves until it is."""
    _, _, metrics = trained
    entropy = metrics["sac/entropy"][-200:].mean()
    assert float(entropy) == pytest.approx(norm(scale=0.15).entropy(), abs=0.15)


def test_weights_have_unit_norm_and_target_follows(trained) -> None:
    """Each unit's incoming weights, and each layer's scale and shift, after many steps."""
    _, state, _ = trained
    for params in (state.policy, state.critic):
        for name, layer in params["weights"].items():
            if "kernel" in layer:
                norms = np.sqrt((np.asarray(layer["kernel"]) ** 2).sum(-2))
                np.testing.assert_allclose(norms, 1, rtol=1e-4, err_msg=name)
            else:
                size = layer["scale"].shape[-1]
                total = sum((np.asarray(part) ** 2).sum(-1) for part in layer.values())
                np.testing.assert_allclose(total, size, rtol=1e-4, err_msg=name)
    kernels = [p["weights"]["head"]["kernel"] for p in (state.critic, state.target)]
    assert 0 < float(jnp.abs(kernels[0] - kernels[1]).max()) < 0.2


def test_a_time_limit_is_bootstrapped_through(train) -> None:
    """Q of the best action is 2 + gamma E[r] / (1 - gamma), by Monte Carlo of its policy."""
    made, state, _ = train(0.0, 1.0, 1e-4)
    rng = np.random.default_rng(0)
    x, noise = jnp.float32(rng.uniform(-1, 1, (2000, 1))), jnp.float32(rng.normal(size=(2000, 1)))
    u, _ = jax.jit(made.policy.sample)(state.policy, x, noise)
    expected = 2 + np.mean(2 - (2 * u - x) ** 2)
    assert expected > 3.6
    x = jnp.array([[-0.5], [0.5]])
    q = jax.jit(made.critic.value)(state.critic, x, x / 2)
    np.testing.assert_allclose(q, [expected, expected], atol=0.4)


def test_noise_is_held_for_lengths_with_a_zeta_distribution() -> None:
    """Shares of the lengths 1 to 4 are those of 1, 1/4, 1/9, 1/16; the mean ends exploration."""
    policy = UnitGaussian(hidden=(4,))
    actor = PolicyController(policy, hold=4)
    params = Params(policy=jax.jit(policy.init, static_argnums=1)(jax.random.key(0), SPEC))

    def one(state, key: Array):
        u, state, _ = actor.act(params, state, jnp.zeros(1), key)
        return state, u[0]

    keys = jax.random.split(jax.random.key(1), 6000)
    u = np.asarray(jax.lax.scan(one, actor.init(SPEC), keys)[1])
    changes = np.flatnonzero(np.diff(u, prepend=np.nan) != 0)
    lengths = np.diff(changes)
    shares = np.bincount(lengths, minlength=5)[1:] / len(lengths)
    expected = 1 / np.arange(1, 5) ** 2
    np.testing.assert_allclose(shares, expected / expected.sum(), atol=0.03)
    assert actor.greedy().init(SPEC) == ()
    assert PolicyController(policy).init(SPEC) == ()
