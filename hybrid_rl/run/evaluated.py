"""Evaluations of a trained run: the same episodes as in training, and what a file of them holds."""

from collections.abc import Callable
from functools import partial
from itertools import count
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.outside.host_loop import HostEvaluator
from hybrid_rl.run.evaluations import finish_episodes
from hybrid_rl.run.saved import Trained
from hybrid_rl.training.rollout import advance, begin, evaluation_keys


def evaluate(
    trained: Trained,
    mode: str = "full",
    episodes: int = 10,
    on_decisions: Callable[[int], bool | None] = lambda made: None,
) -> dict[str, np.ndarray]:
    """Undiscounted `return` [S, episodes] of the same episodes as in training.

    If the task measures it, also `success` [S, episodes], 0 or 1; with a constraint also
    `violations` [S, episodes], in decisions. on_decisions: is called now and then with the number
    of decisions that every episode has made; once it returns True, there is no result, {}.

    Raises:
        UsageError: for a mode that the method does not have.
    """
    episode, (controller, _) = trained.episode, trained.learner(mode=mode, world=True)
    keys = jnp.stack([evaluation_keys(seed, episodes) for seed in trained.seeds])
    if isinstance(episode.env, External):
        decisions = count()
        got = HostEvaluator(episode, controller, trained.params, keys)(
            trained.params, keys, lambda: bool(on_decisions(next(decisions)))
        )
        return got or {}
    first = jax.jit(jax.vmap(partial(begin, episode, controller)))
    more = jax.vmap(partial(advance, episode, controller), (0, 0, None))
    more = partial(jax.jit(more, donate_argnums=1), trained.params)
    return finish_episodes(first(keys), more, episode.steps, on_decisions) or {}


def report(trained: Trained, mode: str, got: dict[str, np.ndarray]) -> dict[str, Any]:
    """What evaluation_<mode>.json holds."""
    more, returns = {}, got["return"]
    if (success := got.get("success")) is not None:
        more = {"success": success.mean(1).tolist(), "succeeded": success.astype(bool).tolist()}
    if (count := got.get("violations")) is not None:
        more |= {"violations": count.mean(1).tolist(), "violated": count.astype(int).tolist()}
    return {
        "mode": mode,
        "step": trained.step,
        "seeds": list(trained.seeds),
        "episodes": returns.shape[1],
        "mean": returns.mean(1).tolist(),
        "std": returns.std(1).tolist(),
        **more,
        "returns": returns.tolist(),
    }
