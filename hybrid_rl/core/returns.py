"""The rewards from each decision to the end of a path.

S_t = r_t + c_t S_{t+1},   S_T = the value of the last state
"""

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.protocols.contract import words
from hybrid_rl.types import Path, Reward, Step


def to_go(rewards: Array, goes_on: Array, last: Array, unroll: bool = False) -> Array:
    """S [T+1] for rewards [T], discounts c = goes_on [T] and the value `last` [] at the end."""

    def back(after: Array, at: tuple[Array, Array]) -> tuple[Array, Array]:
        r, c = at
        now = r + c * after
        return now, now

    S = jax.lax.scan(back, last, (rewards, goes_on), reverse=True, unroll=unroll)[1]
    return jnp.append(S, last)


def rewards(reward: Reward, path: Path) -> Array:
    """r [T] along path, x [T+1, n] and u [T, m]."""
    r = jax.vmap(reward)(path.x[:-1], path.u, path.x[1:])
    if r.ndim != 1:
        raise ValueError(f"reward returns {list(r.shape[1:])}; it must return one number, []")
    return r


def check_start(step: Step, x: Array, before: Array) -> None:
    """Raise ValueError unless they are a state [n] and a plan [T, m], and `step` gives such x."""
    if (jnp.ndim(x), jnp.ndim(before)) != (1, 2):
        given = f"x is {list(jnp.shape(x))} and before {list(jnp.shape(before))}"
        raise ValueError(f"{given}; they must be [n] and [T, m]: jax.vmap plans for many states")
    traced = jax.eval_shape(lambda x, u: (step(x, u), x), x, before[0])
    after, wanted = map(words, traced)
    if after != wanted:
        raise ValueError(f"step returns {after}, where x is {wanted}; it must return another x")
