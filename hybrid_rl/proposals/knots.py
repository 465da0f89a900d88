"""v_t = clip(a_t + s e(t)): noise around the plan, interpolated between random knots.

    e(t_j) = e_j ~ N(0, I),   t_j = j (T - 1) / (n - 1),   j = 0 .. n - 1

e is piecewise linear, or the natural cubic spline through the knots. Candidates of few knots move
a slow system farther than white noise of the same deviation. There are n knots, at most T; one
knot is the same noise at all decisions.

Source: splines as plans are MuJoCo MPC's (Howell et al. 2022, predictive sampling); here they are
noise around the plan, which keeps its own shape.
"""

from typing import Any, ClassVar, Literal

import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.fields import Count, Positive, part
from hybrid_rl.types import Params, Spec


@part
class KnotsProposal:
    """Candidates around the warm-started plan, smooth over the horizon."""

    knots: Count = 5  # n
    order: Literal["linear", "cubic"] = "linear"
    std: Positive = 0.7  # s of a knot, of full actuation
    density: ClassVar[bool] = False  # the noise of a decision follows from its neighbours

    def init(self, spec: Spec, quantile: Array) -> tuple[()]:
        """No carry."""
        return ()

    def shaped(self, noise: Array) -> Array:
        """e [T, m] through the first n rows of noise [T, m]."""
        n = min(self.knots, len(noise))
        return jnp.asarray(_interpolation(len(noise), n, self.order)) @ noise[:n]

    def __call__(
        self, params: Params, carry: tuple[()], x: Array, plan: Array, noise: Array
    ) -> tuple[Array, Array, Any]:
        """A candidate v [m] around plan [m] for the shaped noise [m], and no log-density."""
        return jnp.clip(plan + self.std * noise, -1, 1), jnp.zeros(()), carry


def _interpolation(steps: int, n: int, order: str) -> np.ndarray:
    """W [T, n], float32: W e are the values at the T steps of the curve through knots e [n].

    Knots have distance 1; u is the position after the knot before, v that before the knot after.

        linear   v e_j + u e_{j+1}
        cubic    + ((v^3 - v) M_j + (u^3 - u) M_{j+1}) / 6,   M_0 = M_{n-1} = 0,
                 M_{j-1} + 4 M_j + M_{j+1} = 6 (e_{j-1} - 2 e_j + e_{j+1})
    """
    if n == 1:
        return np.ones((steps, 1), np.float32)
    t = np.linspace(0, n - 1, steps)
    left = np.minimum(t.astype(int), n - 2)
    before, after = np.eye(n)[left], np.eye(n)[left + 1]
    u = (t - left)[:, None]
    v = 1 - u
    W = v * before + u * after
    if order == "cubic" and n > 2:
        second = np.diff(np.eye(n), 2, axis=0)  # [n-2, n] e_{j-1} - 2 e_j + e_{j+1}
        inner = 4 * np.eye(n - 2) + np.eye(n - 2, k=1) + np.eye(n - 2, k=-1)
        M = np.zeros((n, n))
        M[1:-1] = np.linalg.solve(inner, 6 * second)
        W += ((v**3 - v) * (before @ M) + (u**3 - u) * (after @ M)) / 6
    return W.astype(np.float32)
