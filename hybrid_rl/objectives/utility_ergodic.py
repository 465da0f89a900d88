"""J = -D(p || q) around a policy, p(s) ~ exp(c Q(s)): spend time where the critic promises much.

    s = (x / units, u),   s_i ~ U(s_0 - reach, s_0 + reach) where -1 <= u <= 1,   q over the path

s holds states and actions (thesis eq. 6.27, Algorithm 11). The N points are drawn anew at every
decision, about s_0, the state that the robot is in and its policy's action there; units are the
deviations of the states that the model has seen. D is the KL-ergodic measure itself: the bound of
eq. (6.17), which the thesis takes for speed, follows the mean of p alone.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import ergodic
from hybrid_rl.types import Params, Path, Policy, Spec


class Seen(NamedTuple):
    """What was drawn at a decision."""

    points: ergodic.Points  # [N], s [n+m]
    units: Array  # [n]


@dataclass(frozen=True)
class UtilityErgodic:
    """Minus the KL-ergodic measure of states and actions, before a critic.

    Raises:
        ValueError: for sizes, a variance or constants that are not positive.
    """

    model: Any  # whose parameters hold "state", statistics of what was seen
    policy: Policy
    critic: Any
    samples: int = 20  # N
    variance: float = 0.1  # of Sigma = variance I, in squared units
    reach: float = 0.5  # [units], of actions [u]
    sharpness: float = 1.0  # c [1/Q]

    def __post_init__(self) -> None:
        """Check the fields."""
        for name in ("samples", "variance", "reach", "sharpness"):
            if not getattr(self, name) > 0:
                raise ValueError(f"utility.{name}={getattr(self, name)}: must be above 0")

    def begin(self, spec: Spec) -> Seen:
        """Nothing drawn."""
        n = self.samples
        points = ergodic.Points(jnp.zeros((n, spec.obs + spec.act)), jnp.full(n, -jnp.log(n)))
        return Seen(points, jnp.ones(spec.obs))

    def look(self, params: Params, memory: Seen, x: Array, key: Array) -> Seen:
        """Draw the points about x [n], and weigh them. The key is consumed."""
        units, u = params.model["state"].scale, self.policy.mean(params.policy, x)
        bound = jnp.concatenate([jnp.full(x.shape, jnp.inf), jnp.ones(u.shape)])
        about = jnp.concatenate([x / units, u])
        low, high = (jnp.clip(about + apart, -bound, bound) for apart in (-self.reach, self.reach))
        s = jax.random.uniform(key, memory.points.s.shape, minval=low, maxval=high)
        q = self.critic.value(params.critic, s[:, : len(x)] * units[None], s[:, len(x) :])
        return Seen(ergodic.Points(s, jax.nn.log_softmax(self.sharpness * q)), units)

    def value(self, params: Params, memory: Seen, path: Path) -> Array:
        """J [] [nat], up to the volume that is drawn from."""
        s = jnp.concatenate([path.x[:-1] / memory.units[None], path.u], axis=-1)
        variance = jnp.full(s.shape[-1], self.variance)
        log_q = ergodic.log_sum(memory.points.s, s, variance) - jnp.log(len(s))
        return -ergodic.divergence(memory.points, log_q, 1.0)
