"""Noise around a controller."""

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.controllers.noisy import NoisyController
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.envs.analytic.lander import Lander
from hybrid_rl.policies.regulator import Regulator
from hybrid_rl.types import Params, Spec

SPEC = Spec(obs=1, act=3, dt=0.02)


class Still:
    """u = 0.2."""

    def init(self, spec: Spec) -> Array:
        """A count of decisions."""
        return jnp.zeros(())

    def act(self, params: Any, state: Array, obs: Array, key: Array) -> tuple:
        """The constant action."""
        return jnp.full(SPEC.act, 0.2), state + 1, {"planner/count": state}

    def greedy(self) -> "Still":
        """The same controller."""
        return self


def noise(controller: Any, count: int = 20_000) -> np.ndarray:
    """The noise [count, m] that was added to the inner action."""

    def decide(state: Any, at: tuple[Array, Array]) -> tuple:
        key, decisions = at
        params = Params(decisions=decisions)
        u, state, _ = controller.act(params, state, jnp.zeros(1), key)
        return state, u - 0.2

    at = jax.random.split(jax.random.key(0), count), jnp.arange(count)
    return np.asarray(jax.lax.scan(decide, controller.init(SPEC), at)[1])


@pytest.mark.parametrize(
    ("kind", "std", "largest"), [("normal", 0.1, 0.55), ("uniform", 0.1 / 3**0.5, 0.1)]
)
def test_white_noise_has_its_standard_deviation(kind, std, largest) -> None:
    """It is uncorrelated in time, and the uniform one is bounded."""
    e = noise(NoisyController(Still(), kind, level=0.1))
    np.testing.assert_allclose(e.std(0), std, rtol=0.03)
    np.testing.assert_allclose(e.mean(0), 0, atol=0.004)
    assert np.abs(np.mean(e[1:] * e[:-1], 0)).max() < 0.03 * std**2
    assert np.abs(e).max() <= largest + 1e-6


def test_ou_noise_has_its_variance_and_its_correlation() -> None:
    """level^2 / (2 theta), with correlation exp(-theta t); theta dt = 0.1 here."""
    e = noise(NoisyController(Still(), "ou", level=0.3, theta=5.0), 100_000)
    variance = 0.09 * 0.02 / (1 - 0.9**2)
    np.testing.assert_allclose(e.var(0), variance, rtol=0.06)
    np.testing.assert_allclose(np.mean(e[7:] * e[:-7], 0), variance * 0.9**7, rtol=0.1)


@pytest.mark.parametrize("fields", [{"decay": 0.999}, {"until": 100}])
def test_noise_that_decays_is_over_after_training(fields: dict[str, float]) -> None:
    """Where the decisions of the run are not counted."""
    controller = NoisyController(Still(), "normal", level=0.1, **fields)
    u = controller.act(Params(), controller.init(SPEC), jnp.zeros(1), jax.random.key(0))[0]
    np.testing.assert_array_equal(u, np.float32(0.2))


def test_noise_decays_and_actions_are_bounded() -> None:
    """By `decay`, and linearly to zero after `until` decisions; actions stay within -1 and 1."""
    e = noise(NoisyController(Still(), "normal", level=0.1, until=1000, decay=0.998), 2000)
    np.testing.assert_allclose(e[1000:], 0, atol=1e-7)
    assert e[400:600].std() == pytest.approx(0.05 * 0.998**500, rel=0.1)
    e = noise(NoisyController(Still(), "normal", level=0.1, decay=0.999), 2000)
    assert e[900:1100].std() == pytest.approx(0.1 * 0.999**1000, rel=0.1)
    assert np.abs(0.2 + noise(NoisyController(Still(), level=9.0), 50)).max() == 1


def test_held_noise_is_drawn_every_few_decisions() -> None:
    """Five equal values in sequence, then five others."""
    e = noise(NoisyController(Still(), "held", level=0.1, hold=5), 1000)[:, 0].reshape(200, 5)
    np.testing.assert_array_equal(e, e[:, :1] * np.ones(5))
    assert e[:, 0].std() == pytest.approx(0.1, rel=0.15)
    assert len(np.unique(e[:, 0])) == 200


def test_noise_keeps_the_inner_controller_and_evaluation_removes_the_noise() -> None:
    """Its state and metrics are passed on; `greedy` returns only that controller."""
    controller = NoisyController(Still())
    _, state, metrics = controller.act(
        Params(), controller.init(SPEC), jnp.zeros(1), jax.random.key(0)
    )
    assert (float(state.inner), float(metrics["planner/count"])) == (1, 0)
    assert isinstance(controller.greedy(), Still)


@pytest.mark.parametrize(
    "change", [{"kind": "pink"}, {"level": -1.0}, {"decay": 0.0}, {"until": 0}, {"hold": 0}]
)
def test_bad_fields(change) -> None:
    """One line that names the field."""
    with pytest.raises(ValueError, match=next(iter(change))):
        NoisyController(Still(), **change)


def test_noise_is_added_before_the_action_is_clipped() -> None:
    """Around a regulator without a clip: noise that is smaller than the excess changes nothing."""
    world, obs, key = Lander("hover"), jnp.zeros(6).at[4].set(-2.0), jax.random.key(0)
    for clip, moved in ((False, False), (True, True)):
        regulator = PolicyController(Regulator(world, (1.0,), (0.001,), clip=clip), explore=False)
        noisy = NoisyController(regulator, level=1.0)
        keys = jax.random.split(key, 200)
        act = partial(noisy.act, Params(), noisy.init(world.spec), obs)
        u = np.asarray(jax.jit(jax.vmap(act))(keys)[0])
        assert (u < 1).any() == moved  # without a clip: 1/2 + 2 * 5.248 > 10
