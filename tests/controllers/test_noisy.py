"""Noise around a controller."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.controllers.noisy import NoisyController
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.controllers.stages import StagesController
from hybrid_rl.envs.analytic.lander import Lander
from hybrid_rl.policies.regulator import Regulator
from hybrid_rl.types import Params, Spec

SPEC = Spec(obs=1, act=3, dt=0.02)
STILL = ConstantController(0.2)


def noise(*fields: Any, count: int = 20_000, **more: Any) -> np.ndarray:
    """The noise [count, m] that was added to the inner action."""
    controller = NoisyController(STILL, *fields, **more)

    def decide(state: Any, at: tuple) -> tuple:
        key, decisions = at
        u, state, _ = controller.act(Params(decisions=decisions), state, jnp.zeros(1), key)
        return state, u - 0.2

    at = jax.random.split(jax.random.key(0), count), jnp.arange(count)
    return np.asarray(jax.lax.scan(decide, controller.init(SPEC), at)[1])


@pytest.mark.parametrize(
    ("kind", "std", "largest"), [("normal", 0.1, 0.55), ("uniform", 0.1 / 3**0.5, 0.1)]
)
def test_white_noise_has_its_standard_deviation(kind: str, std: float, largest: float) -> None:
    """It is uncorrelated in time, and the uniform one is bounded."""
    e = noise(kind, level=0.1)
    np.testing.assert_allclose(e.std(0), std, rtol=0.03)
    np.testing.assert_allclose(e.mean(0), 0, atol=0.004)
    assert np.abs(np.mean(e[1:] * e[:-1], 0)).max() < 0.03 * std**2
    assert np.abs(e).max() <= largest + 1e-6


def test_ou_noise_has_its_variance_and_its_correlation() -> None:
    """level^2 / (2 theta), with correlation exp(-theta t); theta dt = 0.1 here."""
    e = noise("ou", level=0.3, theta=5.0, count=100_000)
    variance = 0.09 * 0.02 / (1 - 0.9**2)
    np.testing.assert_allclose(e.var(0), variance, rtol=0.06)
    np.testing.assert_allclose(np.mean(e[7:] * e[:-7], 0), variance * 0.9**7, rtol=0.1)


def test_noise_decays_and_actions_are_bounded() -> None:
    """By `decay`, and linearly to zero after `until` decisions; actions stay within -1 and 1.

    Where the decisions of the run are not counted, the noise that decays is over.
    """
    e = noise("normal", level=0.1, until=1000, decay=0.998, count=2000)
    np.testing.assert_allclose(e[1000:], 0, atol=1e-7)
    assert e[400:600].std() == pytest.approx(0.05 * 0.998**500, rel=0.1)
    e = noise("normal", level=0.1, decay=0.999, count=2000)
    assert e[900:1100].std() == pytest.approx(0.1 * 0.999**1000, rel=0.1)
    assert np.abs(0.2 + noise(level=9.0, count=50)).max() == 1
    for fields in ({"decay": 0.999}, {"until": 100}):
        controller = NoisyController(STILL, "normal", level=0.1, **fields)
        u = controller.act(Params(), controller.init(SPEC), jnp.zeros(1), jax.random.key(0))[0]
        np.testing.assert_array_equal(u, np.float32(0.2))


def test_held_noise_is_drawn_every_few_decisions() -> None:
    """Five equal values in sequence, then five others."""
    e = noise("held", level=0.1, hold=5, count=1000)[:, 0].reshape(200, 5)
    np.testing.assert_array_equal(e, e[:, :1] * np.ones(5))
    assert e[:, 0].std() == pytest.approx(0.1, rel=0.15)
    assert len(np.unique(e[:, 0])) == 200


def test_the_inner_controller_keeps_its_state_and_evaluates_without_noise() -> None:
    inner = StagesController({"a": STILL, "b": STILL}, (3,))
    controller = NoisyController(inner)
    given = Params(), controller.init(SPEC), jnp.zeros(1), jax.random.key(0)
    _, state, metrics = controller.act(*given)
    after = inner.act(Params(), inner.init(SPEC), *given[2:])
    jax.tree.map(np.testing.assert_array_equal, (state.inner, metrics), after[1:])
    assert controller.greedy() == inner.greedy()


def test_noise_is_added_before_the_action_is_clipped() -> None:
    """Around a regulator without a clip: noise that is smaller than the excess changes nothing."""
    world, obs = Lander("hover"), jnp.zeros(6).at[4].set(-2.0)
    for clip in (False, True):
        regulator = PolicyController(Regulator(world, (1.0,), (0.001,), clip=clip), explore=False)
        noisy = NoisyController(regulator, level=1.0)
        act = partial(noisy.act, Params(), noisy.init(world.spec), obs)
        u = np.asarray(jax.jit(jax.vmap(act))(jax.random.split(jax.random.key(0), 200))[0])
        assert (u < 1).any() == clip  # without a clip: 1/2 + 2 * 5.248 > 10
