"""Episodes that the doctor runs itself: decisions that no learner has seen."""

from dataclasses import dataclass, replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl import Episode, UsageError, rollout
from hybrid_rl.types import EnvState, Params, Spec, Transition

START_KEY = 2_000_000  # of episodes, which no evaluation uses
FEWEST, EPISODES = 16, 64  # of them
DECISIONS = 64_000  # in all of them, unless that makes too few


@dataclass(frozen=True)
class Tried:
    """N episodes of T decisions; one that has ended repeats its last state."""

    obs: np.ndarray  # [N, T+1, o]
    action: np.ndarray  # [N, T, m]
    reward: np.ndarray  # [N, T]
    lives: np.ndarray  # [N, T] whether the episode had not ended before this decision
    success: np.ndarray | None  # [N, T]; None: the task does not measure it

    def rows(self, decisions: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """obs [n, o], action [n, m], next_obs [n, o] of the first `decisions` of each episode."""
        lives = self.lives[:, :decisions]
        obs, after = self.obs[:, :decisions], self.obs[:, 1 : decisions + 1]
        return obs[lives], self.action[:, :decisions][lives], after[lives]

    def second_half(self) -> Transition:
        """The second half of the episodes that last so long, as decisions of learners."""
        which, half = self.lives.all(1), self.action.shape[1] // 2
        obs, action, reward = (each[which, half:] for each in (self.obs, self.action, self.reward))
        over = np.zeros_like(reward)
        rows: Any = (obs[:, :-1], action, reward, over, over, obs[:, 1:])
        return Transition(*rows)


class RandomActions:
    """Uniform actions."""

    def init(self, spec: Spec) -> jax.Array:
        """An action that gives the size."""
        return jnp.zeros(spec.act)

    def act(self, params: Params, state: Any, obs: Any, key: jax.Array) -> tuple[Any, ...]:
        """Action [m], the state, no metrics."""
        return jax.random.uniform(key, state.shape, minval=-1, maxval=1), state, {}


def in_jax(episode: Episode) -> bool:
    """Whether the world steps in JAX, and not outside, as a robot does."""
    try:
        state = jax.eval_shape(episode.reset, jax.random.key(0))
        return bool(jax.eval_shape(episode.step, state, jnp.zeros(episode.spec.act)))
    except UsageError:
        return False


def episodes(
    episode: Episode, controller: Any, params: Params, learners: int = 1, longer: int = 1
) -> list[Tried] | None:
    """Episodes of a controller for each learner, `longer` time limits long; None: no world of JAX.

    params: [learners, ...].
    """
    if not in_jax(episode):
        return None
    steps = longer * episode.steps
    number = min(max(DECISIONS // steps, FEWEST), EPISODES)
    world = replace(episode, steps=steps)

    def one(params: Params, key: jax.Array) -> tuple:
        actions, states = rollout.rollout_with_actions(world, controller, params, key, steps)
        return actions, _seen(states)

    keys = jax.random.split(jax.random.key(START_KEY), number)
    each = jax.vmap(jax.vmap(one, (None, 0)), (0, None), axis_size=learners)
    made: Any = jax.tree.map(np.asarray, jax.jit(each)(params, keys))
    found = [jax.tree.map(lambda a, i=i: a[i], made) for i in range(learners)]
    return [
        Tried(obs, action, reward[:, 1:], ~done[:, :-1], success)
        for action, (obs, reward, done, success) in found
    ]


def _seen(states: EnvState) -> tuple:
    success = states.metrics.get("success")
    after = None if success is None else success[1:]
    return states.obs, states.reward, states.done, after
