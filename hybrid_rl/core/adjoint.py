"""Adjoint core: the gradient of a return at a policy's actions, by the exact costate.

    x_{t+1} = f(x_t, u_t),   u_t = pi(x_t) + v_t,   dJ = (J_x, J_u) = grad J(path)
    rho_T = J_x[T],   g_t = J_u[t] + f_u' rho_{t+1},   rho_t = J_x[t] + pi_x' g_t + f_x' rho_{t+1}

g is the gradient of J with respect to v; J is any functional of the path and is maximised.
Source: thesis eq. (3.2)-(3.4) and Theorem 1, discrete in time, with the reward's own
dependence on u, which is missing in print.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import returns, rollout
from hybrid_rl.core.rollout import scan_unroll
from hybrid_rl.protocols import Policy
from hybrid_rl.types import Params, Path, Return, Reward, Step


class Adjoint(NamedTuple):
    """A path, and the derivatives of its return."""

    path: Path  # x [T+1, n]; u [T, m]
    costate: Array  # rho [T+1, n] [J / x]
    gradient: Array  # g [T, m] [J / u]


def roll(step: Step, policy: Callable[[Any], Array | float], x: Any, correction: Array) -> Path:
    """The path from x [n], or a tree of arrays, under `policy` plus `correction` v [T, m]."""

    def act(_: None, x: Any, v: Array) -> tuple[Array, None, None]:
        return policy(x) + v, None, None

    return rollout.roll(lambda x, u: (step(x, u), None), act, x, correction).path


def adjoint(
    step: Step,
    policy: Callable[[Array], Array],
    objective: Return,
    path: Path,
    bound: float | None = None,
) -> Adjoint:
    """Costate and gradient along `path`, which must come from `roll` with `step` and `policy`.

    `bound` clips every entry of the complete rho to [-bound, bound], as the thesis' author did;
    g is then no longer the gradient.
    """
    dJ = jax.grad(objective)(path)

    def back(after: Array, at: tuple[Array, ...]) -> tuple[Array, tuple[Array, Array]]:
        x, u, j_x, j_u = at
        f_x, f_u = jax.vjp(step, x, u)[1](after)
        g = j_u + f_u
        rho = j_x + jax.vjp(policy, x)[1](g)[0] + f_x
        return rho, (rho, g)

    along = (path.x[:-1], path.u, dJ.x[:-1], dJ.u)
    unroll = scan_unroll(len(path.u))
    costate, gradient = jax.lax.scan(back, dJ.x[-1], along, reverse=True, unroll=unroll)[1]
    costate = jnp.concatenate([costate, dJ.x[-1:]])
    if bound is not None:
        costate = jnp.clip(costate, -bound, bound)
        gradient = jax.vmap(back)(costate[1:], along)[1][1]
    return Adjoint(path, costate, gradient)


def mode_insertion_gradient(step: Step, objective: Return, nominal: Adjoint, u: Array) -> Array:
    """The derivative dJ / d lambda [] of replacing the first action by u [m] for a time lambda.

    lambda -> 0 is counted in decisions: divide by the time between decisions for [J/s]. Thesis
    eq. (3.1) with the jump of a reward that depends on the action,

        r(x, u) - r(x, u_0) + rho_1' (f(x, u) - f(x, u_0)),

    which is missing in print. It is positive if u is better by the model, zero if both agree.
    """
    path = nominal.path
    other = path._replace(u=path.u.at[0].set(u))
    jump = objective(other) - objective(path)
    x = path.x[0]
    return jump + nominal.costate[1] @ (step(x, u) - step(x, path.u[0]))


def per_variance(insertion: Array, variance: Array) -> dict[str, Array]:
    """A mode insertion gradient divided by the policy's variance Sigma = diag(variance [m]).

    To first order the insertion gradient is g' (u - mu), and g' Sigma g for u = mu + Sigma g
    (thesis Corollary 1), so that it falls both as model and policy come to agree and as Sigma
    shrinks. Divided by tr(Sigma) it measures only the gradient g of the return [J / u^2].
    """
    total = variance.sum()
    return {
        "planner/policy_variance": total,
        "planner/insertion_per_variance": insertion / (total + 1e-6),
    }


def insertion_ahead(
    step: Step,
    policy: Callable[[Array], Array],
    objective: Return,
    x: Array,
    u: Array,
    horizon: int,
) -> Array:
    """`mode_insertion_gradient` [] of u [m] at x [n] over `horizon` decisions, without a costate.

    rho_1' (f(x, u) - f(x, u_0)) is the derivative of J along one direction, which forward-mode
    differentiation gives at twice the cost of the path.
    """
    first = policy(x)
    after = step(x, first)

    def returned(after: Array) -> tuple[Array, Path]:
        rest = roll(step, policy, after, jnp.zeros((horizon - 1, *u.shape)))
        path = Path(jnp.concatenate([x[None], rest.x]), jnp.concatenate([first[None], rest.u]))
        return objective(path), path

    value, slope, path = jax.jvp(returned, (after,), (step(x, u) - after,), has_aux=True)
    return objective(path._replace(u=path.u.at[0].set(u))) - value + slope


def agreement(
    step: Step, policy: Policy, params: Params, value: Return, x: Array, u: Array, horizon: int
) -> dict[str, Array]:
    """Metrics of the action u [m] at x [n] against that of the policy, and of what it gains.

    The share |mu| / (|mu| + |u - mu|) is 1 if the plan follows the policy, else near 0.

    value: J of a path. horizon: decisions over which the insertion of u is valued.
    """
    mean = partial(policy.mean, params.policy)
    insertion = insertion_ahead(step, mean, value, x, u, horizon)
    own, correction = jnp.linalg.norm(mean(x)), jnp.linalg.norm(u - mean(x))
    return {
        "planner/mode_insertion_gradient": insertion,
        **per_variance(insertion, policy.variance(params.policy, x)),
        "planner/policy_share": own / (own + correction + 1e-6),
    }


def plan(
    step: Step, reward: Reward, x: Array, before: Array, *, iterations: int = 10, gain: float = 0.2
) -> Array:
    """The plan [T, m] from x [n]: gradient ascent on the sum of rewards from `before` [T, m].

    An iteration moves the plan by gain * g / rms(g), and clips it to [-1, 1]; gain [u] falls to
    zero over the iterations. `step` and `reward` need derivatives. Execute the first action and
    shift the rest:

        a = jnp.zeros((20, 1))  # 20 decisions
        for _ in range(60):
            a = plan(step, reward, x, a)
            x, a = step(x, a[0]), sampling.shift(a)
    """

    def policy(x: Array) -> Array:
        return jnp.zeros_like(before[0])

    def objective(path: Path) -> Array:
        return returns.rewards(reward, path).sum()

    def improve(a: Array, gain: Array) -> tuple[Array, None]:
        g = adjoint(step, policy, objective, roll(step, policy, x, a)).gradient
        return jnp.clip(a + gain * g / (jnp.sqrt(jnp.mean(g**2)) + 1e-6), -1, 1), None

    gains = gain * (1 - jnp.arange(iterations) / iterations)
    return jax.lax.scan(improve, before, gains)[0]
