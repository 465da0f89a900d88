"""theta: the weights of a model's mean, of which Fisher information is measured (core.fisher)."""

from typing import Any

import jax
from jax import Array

from hybrid_rl.protocols import Model
from hybrid_rl.types import Spec


def require(name: str, model: Model, spec: Spec) -> None:
    """Raise ValueError unless `model`, a field of the part `name`, learns by gradients."""
    shapes = jax.eval_shape(lambda: model.init(jax.random.key(0), spec))
    if not (isinstance(shapes, dict) and "net" in shapes.get("weights", ())):
        line = "has no weights whose information could be measured; choose model=gaussian"
        raise ValueError(f"{name}.model={type(model).__name__}: {line}")


def of(params: Any) -> Any:
    """theta of a model with `params`: the weights of its mean."""
    return params["weights"]["net"]


def replaced(params: Any, theta: Any) -> Any:
    """The model's parameters with theta for the weights of its mean."""
    return {**params, "weights": {**params["weights"], "net": theta}}


def noise(model: Any, params: Any, x: Array, sigma: float | None) -> Array:
    """sigma [n] in units of x [n]; given in running deviations of the change, None: the model's."""
    of_change = model.std(params, x) if sigma is None else sigma
    return of_change * params["change"].scale
