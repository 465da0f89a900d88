"""Models, policies and goals with known solutions, and updates of a learner."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.types import Batch, Params, Path, Spec, Transition

SPEC = Spec(obs=2, act=1, dt=0.1)


@dataclass(frozen=True)
class Cart:
    """A mass on a line: x' = [p + 0.1 v, v + 0.1 u]."""

    def lift(self, params: Any, obs: Array) -> Array:
        return obs

    def step(self, params: Any, x: Array, u: Array) -> Array:
        return jnp.array([x[0] + 0.1 * x[1], x[1] + 0.1 * u[0]])


@dataclass(frozen=True)
class Doubted(Cart):
    """The mass, whose members disagree by |u| in every entry."""

    def predictions(self, params: Any, x: Array, u: Array) -> tuple[Array, Array, Array]:
        after = self.step(params, x, u)
        return after, jnp.full(2, jnp.abs(u).sum()), after[None]


@dataclass(frozen=True)
class Breaking(Cart):
    """The mass, of which nothing is known for u below `low` or above `high`."""

    low: float = -jnp.inf
    high: float = jnp.inf

    def step(self, params: Any, x: Array, u: Array) -> Array:
        known = (self.low <= u[0]) & (u[0] <= self.high)
        return jnp.where(known, super().step(params, x, u), jnp.nan)


@dataclass(frozen=True)
class Acting:
    """A policy of mean u - brake v and of variance 0.25; as a critic its value is 250."""

    u: float = 0.0
    brake: float = 0.0

    def mean(self, params: Any, x: Array) -> Array:
        return jnp.full(1, self.u) - self.brake * x[-1]

    def variance(self, params: Any, x: Array) -> Array:
        return jnp.full(1, 0.25)

    def sample(self, params: Any, x: Array, noise: Array) -> tuple[Array, Array]:
        """The mean, whatever the noise."""
        return self.mean(params, x), jnp.zeros(())

    def value(self, params: Any, x: Array, u: Array) -> Array:
        return jnp.full((), 250.0)


@dataclass(frozen=True)
class Goal:
    """J of a path by a function; its memory is the action before."""

    value: Callable[[Path], Array]

    def init(self, spec: Spec) -> Array:
        return jnp.full(spec.act, jnp.nan)

    def prepare(self, params: Any, memory: Array, x: Array, u_before: Array, key: Array) -> tuple:
        return self.value, u_before


def speed(price: float = 0.0) -> Goal:
    """J = sum of speeds - price * sum of u^2."""
    return Goal(lambda path: jnp.sum(path.x[1:, 1]) - price * jnp.sum(path.u**2))


@dataclass(frozen=True)
class Fast:
    """The rewards of speed(0.1), without an end."""

    def outcome(self, params: Any, x: Array, u: Array, after: Array) -> tuple[Array, float]:
        """r, and minus infinity."""
        return after[1] - 0.1 * u[0] ** 2, -jnp.inf


@dataclass(frozen=True)
class Grid:
    """A proposal whose candidate k of K has u = k / K at all times."""

    def init(self, spec: Spec, quantile: Array) -> Array:
        return quantile

    def shaped(self, noise: Array) -> Array:
        return noise

    def __call__(self, params: Params, carry: Array, x: Array, plan: Array, noise: Array) -> tuple:
        return jnp.full(1, carry), jnp.zeros(()), carry


class Shown:
    """Demonstrations of which states [N, o] and actions [N, m] alone are numbers."""

    def __init__(self, obs: Any, action: Any) -> None:
        self.obs, self.action = (np.asarray(given, np.float32) for given in (obs, action))

    def load(self) -> Transition:
        nothing = np.full(len(self.obs), np.nan, np.float32)
        return Transition(self.obs, self.action, *[nothing] * 3, np.nan * self.obs)


@partial(jax.jit, static_argnums=(0, 1))
def _begun(part: Any, spec: Spec, key: Array) -> Any:
    return part.init(key, spec)


def begun(part: Any, spec: Spec = SPEC, seed: int = 0) -> Any:
    """The first parameters or state of a part, by a program that equal parts share."""
    return _begun(part, spec, jax.random.key(seed))


def learned(learner: Any, spec: Spec, draw: Callable[[Array], Batch], steps: int) -> tuple:
    """State and metrics [steps] after as many updates on the batches that `draw` makes of keys."""

    def one(state: Any, key: Array) -> tuple:
        drawing, updating = jax.random.split(key)
        return learner.update(state, Params(**learner.params(state)), draw(drawing), updating)

    keys = jax.random.split(jax.random.key(1), steps)
    return jax.jit(lambda s: jax.lax.scan(one, s, keys))(begun(learner, spec))
