"""How far a plan follows the policy, and what the planner's first action gains by the model."""

from functools import partial

import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import adjoint
from hybrid_rl.protocols import Policy
from hybrid_rl.types import Params, Return, Step


def metrics(
    step: Step, policy: Policy, params: Params, value: Return, x: Array, u: Array, horizon: int
) -> dict[str, Array]:
    """Metrics of the action u [m] at x [n] against that of the policy.

    The share |mu| / (|mu| + |u - mu|) is 1 if the plan follows the policy, else near 0.

    value: J of a path. horizon: decisions over which the insertion of u is valued.
    """
    mean = partial(policy.mean, params.policy)
    insertion = adjoint.insertion_ahead(step, mean, value, x, u, horizon)
    own, correction = jnp.linalg.norm(mean(x)), jnp.linalg.norm(u - mean(x))
    return {
        "planner/mode_insertion_gradient": insertion,
        **adjoint.per_variance(insertion, policy.variance(params.policy, x)),
        "planner/policy_share": own / (own + correction + 1e-6),
    }
