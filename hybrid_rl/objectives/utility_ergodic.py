"""J = -D(p || q) around a policy, p(s) ~ exp(c Q(s)): spend time where the critic's Q is high.

    s = (x / units, u),   s_i ~ U(s_0 - reach, s_0 + reach) where -1 <= u <= 1,   q over the path

s holds states and actions (thesis eq. 6.27, Algorithm 11). The N points are drawn at every decision
around s_0, the current state and the policy's action there; units are the running standard
deviations of the model's states. D is the KL-ergodic measure itself: the bound of eq. (6.17), which
the thesis uses for speed, depends on p only through its mean.
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import ergodic
from hybrid_rl.fields import Count, Positive, part
from hybrid_rl.protocols import Critic, Policy, Trainable
from hybrid_rl.types import Params, Path, Return, Spec


@part
class UtilityErgodic:
    """Minus the KL-ergodic measure of states and actions under a critic."""

    model: Trainable  # its parameters hold "state", statistics of the states
    policy: Policy
    critic: Critic
    samples: Count = 20  # N
    variance: Positive = 0.1  # of Sigma = variance I, in squared units
    reach: Positive = 0.5  # [units], of actions [u]
    sharpness: Positive = 1.0  # c [1/Q]

    def init(self, spec: Spec) -> tuple[()]:
        """No memory."""
        return ()

    def prepare(
        self, params: Params, memory: tuple[()], x: Array, u_before: Array, key: Array
    ) -> tuple[Return, tuple[()]]:
        """J [nat] of a path, up to a constant, with points drawn around x [n]."""
        units, u = params.model["state"].scale, self.policy.mean(params.policy, x)
        bound = jnp.concatenate([jnp.full(x.shape, jnp.inf), jnp.ones(u.shape)])
        middle = jnp.concatenate([x / units, u])
        low, high = (jnp.clip(middle + r, -bound, bound) for r in (-self.reach, self.reach))
        s = jax.random.uniform(key, (self.samples, middle.size), minval=low, maxval=high)
        q = self.critic.value(params.critic, s[:, : len(x)] * units[None], s[:, len(x) :])
        points = ergodic.Points(s, jax.nn.log_softmax(self.sharpness * q))

        def value(path: Path) -> Array:
            s = jnp.concatenate([path.x[:-1] / units[None], path.u], axis=-1)
            variance = jnp.full(s.shape[-1], self.variance)
            log_q = ergodic.log_sum(points.s, s, variance) - jnp.log(len(s))
            return -ergodic.divergence(points, log_q, 1.0)

        return value, memory
