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
from scipy.interpolate import CubicSpline, make_interp_spline

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
    """W [T, n], float32: W e are the values at the T steps of the curve through knots e [n]."""
    if n == 1:
        return np.ones((steps, 1), np.float32)
    at, each = np.arange(n), np.eye(n)
    if order == "cubic":
        curve = CubicSpline(at, each, bc_type="natural")
    else:
        curve = make_interp_spline(at, each, k=1)
    return curve(np.linspace(0, n - 1, steps)).astype(np.float32)
