"""J = a scalar of the Fisher information that a path has about a learned model's parameters.

The criteria A_step, A, D, T and full, and the sensitivities `step` and `path`, are those of
core/fisher.py; c = floor + the information of the data so far, which is `information` in `Params`
(learners/information.py). Thesis eq. (4.4) minimises tr I_t^-1 summed over time, by path and
without the data so far: A_step, path, past=false. D by step, with the data so far, is our default.
It is the term without the task; `weighted_sum` adds one.
"""

from typing import Literal

import jax
import jax.numpy as jnp
from jax import Array
from jax.flatten_util import ravel_pytree

from hybrid_rl.core import fisher
from hybrid_rl.fields import FieldError, Natural, Positive, part
from hybrid_rl.networks import mean_weights, precision
from hybrid_rl.protocols import Model
from hybrid_rl.types import Params, Path, Return, Spec


@part
class FisherInformation:
    """Information along a path about the weights of the model in `Params`.

    T with `probes` = k > 0 estimates tr I = E|F v|^2 / sigma^2, v ~ N(0, 1), by k directions, which
    are drawn at every decision: networks with many weights need no derivative by each of them.
    """

    model: Model
    criterion: Literal["A_step", "A", "D", "T", "full"] = "D"  # what is maximised
    sensitivity: Literal["step", "path"] = "step"  # of one step, or of the path
    sigma: Positive | None = 0.1  # of the change, in running deviations; None: the model's
    floor: Positive = 0.01  # of the diagonal [1/theta^2]
    past: bool = True  # count the data so far, if a learner does
    probes: Natural = 0  # directions that estimate T; 0: exact

    def __post_init__(self) -> None:
        if self.probes and self.criterion != "T":
            raise FieldError(self, "probes", "only criterion=T is estimated")

    def init(self, spec: Spec) -> tuple[()]:
        """No memory: what the data say is in `Params`."""
        mean_weights.require("information", self.model, spec)
        return ()

    def prepare(
        self, params: Params, memory: tuple[()], x: Array, u_before: Array, key: Array
    ) -> tuple[Return, tuple[()]]:
        """J of a path. The key is consumed."""
        theta = mean_weights.of(params.model)
        flat, unravel = ravel_pytree(theta)
        sigma = mean_weights.noise(self.model, params.model, x, self.sigma)
        prior = jnp.full_like(flat, self.floor)
        if self.past and params.information is not None:
            prior += params.information.total

        def step(theta: object, x: Array, u: Array) -> Array:
            with precision.using("float32"):
                return self.model.step(mean_weights.replaced(params.model, theta), x, u)

        def exact(path: Path) -> Array:
            F = fisher.along(step, theta, path, self.sensitivity)
            return fisher.criterion(self.criterion, F, sigma, prior)

        directions = jax.random.normal(key, (self.probes, flat.size), flat.dtype)

        def estimated(path: Path) -> Array:
            def one(v: Array) -> Array:
                each = fisher.products(step, theta, path, self.sensitivity, unravel(v))
                return jnp.sum((each / sigma[None]) ** 2)

            return jnp.log(jax.vmap(one)(directions).mean() + prior.sum())

        return estimated if self.probes else exact, memory
