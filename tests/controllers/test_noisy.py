"""Noise beside a policy."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array

from hybrid_rl.controllers.noisy import NoisyController
from hybrid_rl.types import Params, Spec

SPEC = Spec(obs=1, act=3, dt=0.02)


class Still:
    """u = 0.2."""

    def mean(self, params: Any, x: Array) -> Array:
        """The same everywhere."""
        return jnp.full(SPEC.act, 0.2)


def noise(controller: NoisyController, count: int = 20_000) -> np.ndarray:
    """What was added to the policy [count, m]."""

    def decide(state: Any, at: tuple[Array, Array]) -> tuple:
        key, decisions = at
        params = Params(decisions=decisions)
        u, state, _ = controller.act(params, state, jnp.zeros(1), key)
        return state, u - 0.2

    at = jax.random.split(jax.random.key(0), count), jnp.arange(count)
    return np.asarray(jax.lax.scan(decide, controller.init(SPEC), at)[1])


@pytest.mark.parametrize(
    ("kind", "std", "greatest"), [("normal", 0.1, 0.55), ("uniform", 0.1 / 3**0.5, 0.1)]
)
def test_white_noise_has_its_deviation(kind, std, greatest) -> None:
    """And no memory, and the uniform one its bound."""
    e = noise(NoisyController(Still(), kind, level=0.1))
    np.testing.assert_allclose(e.std(0), std, rtol=0.03)
    np.testing.assert_allclose(e.mean(0), 0, atol=0.004)
    assert np.abs(np.mean(e[1:] * e[:-1], 0)).max() < 0.03 * std**2
    assert np.abs(e).max() <= greatest + 1e-6


def test_ou_noise_has_its_variance_and_its_memory() -> None:
    """level^2 / (2 theta), forgotten by exp(-theta t); theta t is 0.1 a decision here."""
    e = noise(NoisyController(Still(), "ou", level=0.3, theta=5.0), 100_000)
    variance = 0.09 * 0.02 / (1 - 0.9**2)
    np.testing.assert_allclose(e.var(0), variance, rtol=0.06)
    np.testing.assert_allclose(np.mean(e[7:] * e[:-7], 0), variance * 0.9**7, rtol=0.1)


def test_it_decays_and_is_bounded() -> None:
    """To nothing after `decay` decisions; actions stay within -1 and 1; greedy has none."""
    e = noise(NoisyController(Still(), "normal", level=0.1, decay=1000), 2000)
    assert (e[1000:] == 0).all()
    assert e[400:600].std() == pytest.approx(0.05, rel=0.1)
    assert np.abs(0.2 + noise(NoisyController(Still(), level=9.0), 50)).max() == 1
    assert (noise(NoisyController(Still(), "ou", decay=7).greedy(), 50) == 0).all()


@pytest.mark.parametrize("change", [{"kind": "pink"}, {"level": -1.0}, {"decay": 0}])
def test_bad_fields(change) -> None:
    """One line that names the field."""
    with pytest.raises(ValueError, match=next(iter(change))):
        NoisyController(Still(), **change)
