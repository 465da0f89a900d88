"""The best of some random linear policies, beside what the run has learned.

    u = clip(K z + b, -1, 1),  z = (o - mean) / std,  K, b ~ N(0, 1) / sqrt(o + 1)

Each returns what it returns in one episode; the best is tried again in new ones, or chance would
have chosen it. A linear policy keeps its direction for many decisions, which independent noise at
each decision does not: it can move what is slow.
"""

from dataclasses import replace
from math import inf
from time import monotonic
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl import evaluate
from hybrid_rl.envs.adapters.external import External
from hybrid_rl.tools.doctor.evidence import Evidence
from hybrid_rl.tools.doctor.limits import ERRORS
from hybrid_rl.tools.doctor.tried import in_jax
from hybrid_rl.types import Params, Spec

POLICIES, EPISODES = 50, 16  # tried once; of the best one, and of the run's policy
LONGEST = 30.0  # [s] of an evaluation in Gymnasium, or there is none
START_SEED = 3_000_000  # of episodes, which no evaluation uses


class Linear:
    """The policy; params.policy: K and b [o+1, m], mean and std [o]."""

    def init(self, spec: Spec) -> Array:
        """No state."""
        return jnp.zeros(())

    def act(self, params: Params, state: Array, obs: Array, key: Array) -> tuple[Any, ...]:
        """Action [m], the state, no metrics."""
        weights, mean, std = params.policy
        z = jnp.append((obs - mean) / std, 1.0)
        return jnp.clip(z @ weights, -1.0, 1.0), state, {}


def better(run: Evidence) -> str | None:
    """A linear policy, found by chance, that returns more than the learned one."""
    policy, params = run.run.controllers.get("policy"), run.params
    if policy is None or params is None or run.made is None:
        return None
    spec, seen = run.run.agent.spec, run.made.obs.reshape(-1, run.made.obs.shape[-1])
    size = (POLICIES, spec.obs + 1, spec.act)
    weights = np.random.default_rng(0).normal(size=size) / np.sqrt(spec.obs + 1)
    std = np.where(seen.std(0) > 0, seen.std(0), 1.0)
    linear = Params(policy=(jnp.array(weights, jnp.float32), *_repeated(seen.mean(0), std)))
    once = _returns(run, Linear(), linear, 1, 0)
    if once is None:
        return None
    best = int(np.argmax(once))
    chosen = jax.tree.map(lambda leaf: leaf[best : best + 1], linear)
    again = _returns(run, Linear(), chosen, EPISODES, 1)
    own = _returns(run, policy, jax.tree.map(lambda leaf: leaf[None], params), EPISODES, 1)
    if again is None or own is None:
        return None
    error = np.sqrt((again.var(ddof=1) + own.var(ddof=1)) / EPISODES)
    if not again.mean() - own.mean() > ERRORS * error:
        return None
    steps = max(run.run.agent.episode.steps // 4, 1)
    return (
        f"the best of {POLICIES} random linear policies returns {again.mean():.4g}, the learned "
        f"one {own.mean():.4g}: it needs more decisions, or explores too little in decisions of "
        f"{spec.dt:.3g} s; train longer, or try episode.action_repeat=4 episode.steps={steps}"
    )


def _repeated(*each: np.ndarray | Array) -> list[Array]:
    return [jnp.tile(jnp.array(one, jnp.float32), (POLICIES, 1)) for one in each]


def _returns(
    run: Evidence, controller: Any, params: Params, number: int, key: int
) -> np.ndarray | None:
    """[S, number] of new episodes with params [S, ...]; None: they cannot be made, or take long."""
    episode, learners = run.run.agent.episode, len(jax.tree.leaves(params)[0])
    outside = isinstance(episode.env, External)
    if run.trained is None or not (outside or in_jax(episode)):
        return None
    first, end = START_SEED + key * POLICIES, monotonic() + (LONGEST if outside else inf)
    seeds = tuple(range(first, first + learners))
    made = replace(run.trained, controllers={"full": controller}, params=params, seeds=seeds)
    return evaluate(made, "full", number, lambda _: monotonic() > end).get("return")
