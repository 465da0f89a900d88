"""Returns: of the rewards from each decision to the end of a path, and with the policy's entropy.

    S_t = r_t + c_t S_{t+1},   S_T = the value of the last state

The maximum-entropy return along trajectories of a policy in a model:

    V_H = Q(x_H, u_H) - alpha log pi_H
    y_t = r_t + discount c_t V_{t+1},   V_t = y_t - alpha log pi_t,   t < H

with c_t the chance that the episode continues. V_0 is what a policy maximises by gradients through
the model, as in MAAC (Clavera et al. 2020); for H = 0 it is the policy's objective in SAC. y_t,
with the target critic's Q, are model-based value expansion (Feinberg et al. 2018).
"""

from abc import ABC, abstractmethod
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import FieldError
from hybrid_rl.protocols import Env
from hybrid_rl.types import Imagined, Params, Path, Return, Reward, Spec

FALLS = 3.0  # the survival bonus of a decision, where episodes end by a fall


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
    return jax.vmap(reward)(path.x[:-1], path.u, path.x[1:])


class Summed(ABC):
    """What objectives share that are a sum of rewards over time, without a memory."""

    @abstractmethod
    def rewards(self, params: Params, path: Path) -> Array:
        """r [T] along path, x [T+1, n] and u [T, m]."""

    def init(self, spec: Spec) -> tuple[()]:
        """No memory: what the data say is in the model's parameters."""
        return ()

    def prepare(
        self, params: Params, memory: tuple[()], x: Array, u_before: Array, key: Array
    ) -> tuple[Return, tuple[()]]:
        """J of a path; the key is not used."""
        return lambda path: self.rewards(params, path).sum(), memory

    def reward_to_go(self, params: Params, path: Path) -> Array:
        """S [T+1] along path, x [T+1, n] and u [T, m]; S[T] is 0."""
        to_go = jnp.cumsum(self.rewards(params, path)[::-1])[::-1]
        return jnp.append(to_go, 0.0)


def soft(paths: Imagined, alpha: Array, discount: float, last: Array) -> tuple[Array, Array]:
    """V_0 [B] and y [H, B] along paths whose last decisions have action values `last` [B]."""

    def back(value: Array, at: tuple[Array, Array, Array]) -> tuple[Array, Array]:
        r, continues, log_prob = at
        y = r + discount * continues * value
        return y - alpha * log_prob, y

    along = paths.reward, paths.continues, paths.log_prob[:-1]
    value = last - alpha * paths.log_prob[-1]
    return jax.lax.scan(back, value, along, reverse=True, unroll=True)


def reached(paths: Imagined) -> Array:
    """The probability [H, B] that a trajectory does not end before each decision."""
    before = jnp.concatenate([jnp.ones_like(paths.continues[:1]), paths.continues[:-1]])
    return jnp.cumprod(before, 0)


def quantities(part: Any, *names: str) -> dict[str, Array]:
    """All quantities of the `world` of a reward or a constraint; FieldError if it lacks a name."""
    known = part.world.quantities(jnp.zeros(part.world.spec.obs))
    if missing := [name for name in names if name not in known]:
        raise FieldError(part, "world", f"has no {missing[0]}, only {', '.join(known)}")
    return known


def bonus(world: Env) -> float:
    """The survival bonus of a decision, 0 where no episode of `world` can end.

    Without it falling pays: it ends an episode of negative rewards.
    """
    return 0.0 if getattr(world, "ended", None) is None else FALLS
