"""What becomes of episodes under a controller whose parameters stay as they are."""

from collections.abc import Callable, Mapping
from functools import partial
from time import perf_counter

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loop import SAME, SEEDS, Loop
from hybrid_rl.training.pace import Pace
from hybrid_rl.types import Controller, EnvState, Params

EVALUATED = {  # mode -> what its outcomes' names begin with
    "full": "eval/",
    "policy": "eval/policy_",
    "planner": "eval/planner_",
}


def begin(episode: Episode, controller: Controller, keys: Array) -> tuple:
    """One episode per key [N] before its first decision: (states, controller states, keys)."""
    starts, keys = _split(keys)
    env = jax.vmap(episode.reset)(starts)
    rest = controller.init(episode.spec)
    control = jax.tree.map(lambda x: jnp.broadcast_to(x, (len(keys), *x.shape)), rest)
    return env, control, keys


def advance(
    episode: Episode, controller: Controller, params: Params, carry: tuple, rounds: Array
) -> tuple:
    """`carry` of `begin` after at most `rounds` [] more decisions in each episode.

    All N worlds run side by side; one that is done stands still.
    """
    act = jax.vmap(controller.act, in_axes=(None, 0, 0, 0))

    def going(carry: tuple) -> Array:
        return (carry[0] < rounds) & ~jnp.all(carry[1].done)

    def decide(carry: tuple) -> tuple:
        i, env, control, keys = carry
        keys, now = _split(keys)
        u, control, _ = act(params, control, env.obs, now)
        after = jax.vmap(episode.step)(env, u)
        frozen = jax.tree.map(
            lambda old, new: jnp.where(
                env.done.reshape(env.done.shape + (1,) * (new.ndim - 1)), old, new
            ),
            env,
            after,
        )
        return i + 1, frozen, control, keys

    return jax.lax.while_loop(going, decide, (jnp.zeros((), jnp.int32), *carry))[1:]


def scores(env: EnvState) -> dict[str, Array]:
    """Undiscounted `return` of each finished episode, and where the task has it `success`.

    Success is 1 where the last state counts as one, else 0.
    """
    success = {"success": env.metrics["success"]} if "success" in env.metrics else {}
    return {"return": env.info["return"], **success}


def outcomes(
    episode: Episode, controller: Controller, params: Params, keys: Array
) -> dict[str, Array]:
    """The `scores` [N] of one whole episode per key [N]."""
    carry = begin(episode, controller, keys)
    return scores(advance(episode, controller, params, carry, jnp.int32(episode.steps))[0])


class Evaluations:
    """Evaluations of all learners of `loop` in every mode; `controllers` are by mode."""

    def __init__(
        self, loop: Loop, controllers: Mapping[str, Controller], episodes: int, params: Params
    ) -> None:
        """Compile all of them; params: [S, ...]."""
        self.keys = jnp.stack([evaluation_keys(seed, episodes) for seed in loop.seeds])
        self._evaluators = {
            mode: Evaluator(loop, controller, params, self.keys)
            for mode, controller in controllers.items()
        }

    def __call__(self, params: Params, cut: Callable[[], bool]) -> list[dict[str, float]] | None:
        """For each learner the mean of every outcome; None as soon as `cut` is true."""
        found: dict[str, np.ndarray] = {}  # [S]
        for mode, evaluator in self._evaluators.items():
            got = evaluator(params, self.keys, cut)
            if got is None:
                return None
            found |= {EVALUATED[mode] + name: each.mean(-1) for name, each in got.items()}
        return [{name: float(m[s]) for name, m in found.items()} for s in range(len(self.keys))]


class Evaluator:
    """Episodes of every learner of `loop` under `controller`, in calls of a few seconds at most.

    It compiles when it is made. params: [S, ...]; keys: [S, N], one per episode.
    """

    def __init__(self, loop: Loop, controller: Controller, params: Params, keys: Array) -> None:
        self.steps = loop.agent.episode.steps
        first = partial(begin, loop.agent.episode, controller)
        more = partial(advance, loop.agent.episode, controller)
        program = loop.spread(jax.vmap(first), SEEDS, SEEDS)
        self._begin = program.lower(keys).compile()
        takes = SEEDS, SEEDS, SAME
        program = loop.spread(jax.vmap(more, (0, 0, None)), takes, SEEDS, donate_argnums=1)
        self._advance = program.lower(params, self._begin(keys), jnp.int32(0)).compile()

    def __call__(
        self, params: Params, keys: Array, cut: Callable[[], bool]
    ) -> dict[str, np.ndarray] | None:
        """The `scores` [S, N]; None as soon as `cut` is true."""
        carry, pace = self._begin(keys), Pace()
        while not np.asarray(carry[0].done).all():
            if cut():
                return None
            rounds, began = pace.rounds(self.steps), perf_counter()
            carry = jax.block_until_ready(self._advance(params, carry, jnp.int32(rounds)))
            pace.took(rounds, perf_counter() - began)
        return {name: np.asarray(value) for name, value in scores(carry[0]).items()}


def rollout(
    episode: Episode, controller: Controller, params: Params, key: Array, steps: int
) -> EnvState:
    """The states [steps+1, ...] of one episode, from its reset; it stands still once done."""
    return acted(episode, controller, params, key, steps)[1]


def acted(
    episode: Episode, controller: Controller, params: Params, key: Array, steps: int
) -> tuple[Array, EnvState]:
    """The actions [steps, m] of one episode and its states [steps+1, ...]."""
    start, key = jax.random.split(key)
    env = episode.reset(start)

    def decide(carry: tuple, key: Array) -> tuple:
        env, control = carry
        u, control, _ = controller.act(params, control, env.obs, key)
        after = episode.step(env, u)
        env = jax.tree.map(lambda old, new: jnp.where(env.done, old, new), env, after)
        return (env, control), (u, env)

    carry = (env, controller.init(episode.spec))
    _, (actions, states) = jax.lax.scan(decide, carry, jax.random.split(key, steps))
    join = jax.tree.map(lambda first, rest: jnp.concatenate([first[None], rest]), env, states)
    return actions, join


def evaluation_keys(seed: int, episodes: int) -> Array:
    """Keys [N] of the evaluation of learner `seed`: the same at every evaluation."""
    return jax.random.split(jax.random.fold_in(jax.random.key(seed), 0xE7A1), episodes)


def _split(keys: Array) -> tuple[Array, Array]:
    """Two keys [N] from each of keys [N]."""
    pairs = jax.vmap(jax.random.split)(keys)
    return pairs[:, 0], pairs[:, 1]
