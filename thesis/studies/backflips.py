"""Landers that asked for backflips while they hovered: figures 6-9 and 6-10.

A run of experiment=thesis/fig_6_9 is restored, and its clones take `LENGTHS` more Adam steps on
their labels. Each then flies 100 starts of the flip, from N(0, 0.1 I), for 10 s.

    success      the criterion of the environment: upside down, with the height kept, for a second
    turned       upside down at some time
    information  tr I of a demonstration from each query's state: under the clone that asked (own),
                 and under one reference, a clone of 20 flips from starts of the flip
    safety       of the exploration: greatest V of the hover's regulator, shares of decisions
                 beyond 90 degrees and with |z| > 1
    lost         share of the states of one V from which the regulator does not return to the hover

Source: thesis section 6.3.4.
"""

import itertools
from collections.abc import Sequence
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.analysis.results import find
from hybrid_rl.envs.analytic.lander import Lander
from hybrid_rl.errors import UsageError
from hybrid_rl.learners import dagger
from hybrid_rl.run.folder import parse_config
from hybrid_rl.run.saved import restore
from hybrid_rl.settings.build import Run, build, load
from hybrid_rl.thesis.studies.recorded import read
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import (
    advance,
    begin,
    evaluate_episodes,
    evaluation_keys,
    rollout_with_actions,
)
from hybrid_rl.types import Params

LENGTHS = (3_000, 15_000)  # Adam steps after the run
FLIP = 100  # decisions of a flight
STARTS = 100  # flights of a clone
REFERENCE = (20, 10_000)  # demonstrations of the reference clone, its seed
TRAINING, ANGLE, HEIGHT = 0xF11B, np.pi / 2, 1.0
LEVELS = (1, 2, 3, 5, 10, 20, 50)  # of V
STATES, RETURN = 4000, 200  # of each level; decisions to return in


class Explored(NamedTuple):
    """One run: S seeds, Q queries at most."""

    label: str
    most: int  # Q
    run: Run
    state: Any  # [S, ...] of the learner, at the end
    asked: np.ndarray  # [S] queries
    decision: np.ndarray  # [S, Q] decisions before each; NaN: not asked
    own: np.ndarray  # [S, Q] tr I; NaN: not asked, or not measured
    x: np.ndarray  # [S, Q, 6] state at each; NaN: not asked
    visited: np.ndarray  # [S, T, 6] states of the exploration


def explored(pattern: str) -> list[Explored]:
    """All runs that match, sorted by label and number of queries.

    Raises:
        UsageError: for other runs than those of the experiment, or two with one label.
    """
    each = sorted(map(of, find(pattern)), key=lambda one: one[:2])
    for one, other in itertools.pairwise(each):
        if one[:2] == other[:2]:
            raise UsageError(f"runs={pattern}: two runs of {one.label}, {one.most} queries")
    return each


def label_of(config: Any) -> str:
    """The method, and its settings that differ from those of the experiment."""
    learner, full = config.learners.policy, config.controllers.full
    if config.env.task == "flip":
        return "starts of the flip"
    words = [str(config.algo)]
    inner = full.controller
    if "objective" in inner:
        if not inner.normalise:
            words.append(f"gain {inner.gain:g}, variance {inner.objective.variance[0]:g}")
        if inner.objective.target.criterion != "trace":
            words.append(f"p by {inner.objective.target.criterion}")
        if full.level is not None:
            words.append(f"V below {full.level:g}")
    elif full.level != 1:
        words.append(f"noise {full.level:g}")
    if learner.spacing != 20:
        words.append("no spacing" if learner.spacing == 1 else f"spacing {learner.spacing}")
    return ", ".join(words)


def of(folder: Path) -> Explored:
    """The clones of the run in `folder`.

    Raises:
        UsageError: unless they asked for flips of a lander.
    """
    config: Any = parse_config(folder) if (folder / "config.yaml").exists() else {}
    if "spacing" not in (config.get("learners", {}).get("policy") or {}):
        raise UsageError(f"runs={folder}: needs a run of experiment=thesis/fig_6_9")
    recorded = read(folder, "lander")
    learner: Any = recorded.run.agent.learners["policy"]
    state = restore(folder, recorded.run)[1].learners["policy"]
    asked = np.asarray(state.queries)
    done = np.arange(learner.most)[None] < asked[:, None]  # [S, Q]
    traced = learner.target is not None and learner.target.criterion == "trace"
    first = np.asarray(state.labels.obs)[:, :: learner.length][:, : learner.most]
    return Explored(
        label_of(recorded.config),
        learner.most,
        recorded.run,
        state,
        asked,
        np.where(done, state.decision, np.nan),
        np.where(done & traced, np.exp(state.information), np.nan),
        np.where(done[..., None], first, np.nan),
        recorded.made.obs,
    )


def trained(one: Explored) -> tuple[np.ndarray, np.ndarray]:
    """Success and turned [lengths, S] of its clones after more training."""
    seeds, state = one.run.seeds, one.state
    keys = jnp.stack([jax.random.fold_in(jax.random.key(seed), TRAINING) for seed in seeds])
    none = jnp.zeros((len(seeds), 1))  # the record of queries, whose length differs by run
    state = state.replace(information=none, decision=none.astype(int), evidence=None)
    shares, before = [], 0
    for length in LENGTHS:
        each = jax.vmap(jax.random.fold_in, (0, None))(keys, length)
        state, before = _fit()(state, length - before, each), length
        shares.append(flown(state.policy, seeds))
    success, turned = np.swapaxes(np.array(shares), 0, 1)
    return success, turned


@cache
def _fit() -> Any:
    """Training of all seeds, which the experiment's methods have in common."""
    learner: Any = _experiment().agent.learners["policy"]
    return jax.jit(jax.vmap(learner.fit, in_axes=(0, None, 0)))


def flown(policy: Any, seeds: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
    """Shares [S] of the flights of each policy [S, ...] that succeeded, and that turned."""
    keys = jnp.stack([evaluation_keys(seed, STARTS) for seed in seeds])
    success, turned = _fly()(policy, keys)
    return np.asarray(success), np.asarray(turned)


@cache
def _fly() -> Any:
    """Shares [S] of success and turned, from policies [S, ...] and keys [S, N]."""
    episode, controller = _flight(), _experiment().controllers["policy"]

    @jax.jit
    @jax.vmap
    def fly(policy: Any, keys: Any) -> Any:
        start = begin(episode, controller, keys)
        end = advance(episode, controller, Params(policy=policy), start, jnp.int32(FLIP))[0]
        return end.metrics["success"].mean(), end.metrics["turned"].mean()

    return fly


def _flight() -> Episode:
    world: Any = Lander("flip")
    return Episode(world, FLIP)


@cache
def _experiment() -> Run:
    """The experiment with its default method."""
    return build(load(["experiment=thesis/fig_6_9"]))


def by_reference(one: Explored) -> np.ndarray:
    """tr I [S, Q] at its queries under the reference clone."""
    learner: Any = _experiment().agent.learners["policy"]
    clone = _reference()
    under = jax.vmap(jax.vmap(lambda x: learner.target.log_density(clone, x)))
    return np.exp(jax.jit(under)(jnp.asarray(one.x)))


@cache
def _reference() -> Params:
    """The reference clone: demonstrations from starts of the flip, longest training."""
    learner: Any = _experiment().agent.learners["policy"]
    episode, (count, seed) = _flight(), REFERENCE
    flying, beginning, fitting = jax.random.split(jax.random.key(seed), 3)
    one = partial(rollout_with_actions, episode, learner.teacher, Params(), steps=FLIP)
    actions, states = jax.jit(jax.vmap(one))(jax.random.split(flying, count))
    state = learner.init(beginning, episode.spec)
    for u, obs in zip(actions, states.obs, strict=True):
        added = dagger.add(state.labels, obs[:-1], u, jnp.array(True))
        state = state.replace(labels=added)
    return Params(policy=jax.jit(learner.fit)(state, LENGTHS[-1], fitting).policy)


def teacher() -> float:
    """The teacher's share of successes, at the starts of seed 0."""
    learner: Any = _experiment().agent.learners["policy"]
    keys = evaluation_keys(0, STARTS)
    got = evaluate_episodes(_flight(), learner.teacher, Params(), keys)
    return float(got["success"].mean())


def safety(obs: np.ndarray) -> tuple[np.ndarray, ...]:
    """Greatest V [S], shares [S] beyond 90 degrees and too high or low, deviations [6].

    obs [S, T, 6]: the states of the exploration.
    """
    guarded: Any = _experiment().agent.controller
    V = np.asarray(jax.jit(jax.vmap(jax.vmap(guarded.policy.lyapunov)))(jnp.asarray(obs)))
    beyond, high = np.abs(obs[..., 2]) > ANGLE, np.abs(obs[..., 1]) > HEIGHT
    return V.max(1), beyond.mean(1), high.mean(1), obs.std((0, 1))


def lost(levels: Sequence[float] = LEVELS) -> dict[float, float]:
    """Share of random states at each level of V from which V does not fall below 1 in 20 s.

    The directions are uniform in coordinates in which V is the squared distance.
    """
    guarded: Any = _experiment().agent.controller
    regulator = guarded.policy
    z = np.random.default_rng(0).normal(size=(STATES, 6))
    z = z / np.linalg.norm(z, axis=1, keepdims=True)
    directions = np.linalg.solve(np.linalg.cholesky(regulator.solve()[1]).T, z.T).T

    def hover(x: Any, _: None) -> tuple[Any, None]:
        return regulator.world.dynamics(x, regulator.mean((), x)), None

    @jax.jit
    @jax.vmap
    def end(x: Any) -> Any:
        return regulator.lyapunov(jax.lax.scan(hover, x, None, length=RETURN)[0])

    ends = {level: end(jnp.asarray(level**0.5 * directions, jnp.float32)) for level in levels}
    return {level: float((~(np.asarray(V) < 1)).mean()) for level, V in ends.items()}
