"""J = sum_t of the information of x_t, u_t about a linear model's parameters K.

    gain   log(1 + s' S s / sigma^2),  S = W W': the information of one more measurement of K s
    norm   -1 / (s's + eps), as printed: the reciprocal of the trace of Fisher's information

Under the norm no data count, and a state far from zero is informative. Source: thesis eq. (7.10);
the gain is ours, that of a Bayesian linear regression (D-optimality; Chaloner and Verdinelli 1995).
"""

from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import least_squares
from hybrid_rl.core.returns import Summed
from hybrid_rl.fields import Positive, part
from hybrid_rl.protocols import LinearModel
from hybrid_rl.types import Params, Path


@part
class Information(Summed):
    """Information along a path about the model in `Params`."""

    model: LinearModel
    criterion: Literal["gain", "norm"] = "gain"
    noise: Positive = 0.1  # sigma of gain, in units of the data's noise; 1: as accurate as they are
    floor: Positive = 1e-5  # eps of norm

    def rewards(self, params: Params, path: Path) -> Array:
        """r [T] along path, x [T+1, n] and u [T, m]."""
        regressors = jax.vmap(self.model.regressors, (None, 0, 0))
        s = regressors(params.model, path.x[:-1], path.u)
        if self.criterion == "norm":
            return -1 / (jnp.sum(s**2, -1) + self.floor)
        spread = jax.vmap(least_squares.leverage, (None, 0))(params.model["spread"], s)
        return jnp.log1p(spread / self.noise**2)
