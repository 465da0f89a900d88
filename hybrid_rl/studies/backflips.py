"""Landers that asked for backflips while they hovered: figures 6-9 and 6-10.

A run of experiment=thesis/fig_6_9 is restored, and its clones take `LENGTHS` more Adam steps on
their labels. Each then flies 100 starts of the flip, from N(0, 0.1 I), for 10 s.

    success      the criterion of the environment: upside down, with the height kept, for a second
    turned       upside down at some time
    information  tr I of a demonstration from each query's state: under the clone that asked (own),
                 and under one reference, a clone of 20 flips from starts of the flip
    safety       of the exploration: greatest V of the hover's regulator, shares of decisions
                 beyond 90 degrees and with |z| > 1

Source: thesis section 6.3.4.
"""

from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from omegaconf import OmegaConf

from hybrid_rl.config import Run, build, load
from hybrid_rl.core import labels
from hybrid_rl.envs.analytic.lander import Lander
from hybrid_rl.errors import UsageError
from hybrid_rl.run import checkpoint
from hybrid_rl.studies.recorded import Recorded, matching, read
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.loop import Loop
from hybrid_rl.training.rollout import advance, begin, evaluation_keys, rollout_with_actions
from hybrid_rl.types import Params

LENGTHS = (3_000, 15_000)  # Adam steps after the run
FLIP = 100  # decisions of a flight
STARTS = 100  # flights of a clone
REFERENCE = (20, 10_000)  # demonstrations of the reference clone, its seed
TRAINING, ANGLE, HEIGHT = 0xF11B, np.pi / 2, 1.0


class Explored(NamedTuple):
    """The clones of one run: S seeds, Q queries at most."""

    label: str
    most: int  # Q
    asked: np.ndarray  # [S] queries
    decision: np.ndarray  # [S, Q] decisions before each; NaN: not asked
    success: np.ndarray  # [lengths, S] share of flights
    turned: np.ndarray  # [lengths, S]
    own: np.ndarray  # [S, Q] tr I; NaN: not asked, or not measured
    reference: np.ndarray  # [S, Q]
    greatest: np.ndarray  # [S] V
    beyond: np.ndarray  # [S] share of decisions
    high: np.ndarray  # [S]
    std: np.ndarray  # [6] of the states


def explored(pattern: str) -> list[Explored]:
    """All runs that match, sorted by label and number of queries.

    Raises:
        UsageError: for other runs than those of the experiment, or two with one label.
    """
    each = sorted(map(of, matching(pattern, "backflips")), key=lambda one: one[:2])
    for one, other in zip(each[:-1], each[1:], strict=True):
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
    if learner.spacing != 20:
        words.append("no spacing" if learner.spacing == 1 else f"spacing {learner.spacing}")
    return ", ".join(words)


def of(folder: Path) -> Explored:
    """The clones of the run in `folder`.

    Raises:
        UsageError: unless they asked for flips of a lander.
    """
    config: Any = OmegaConf.load(folder / "config.yaml") if folder.is_dir() else {}
    if "spacing" not in (config.get("learners", {}).get("policy") or {}):
        raise UsageError(f"runs={folder}: needs a run of experiment=thesis/fig_6_9")
    recorded = read(folder, "lander")
    learner: Any = recorded.run.agent.learners["policy"]
    state = _state(recorded)
    asked = np.asarray(state.queries)
    done = np.arange(state.decision.shape[1])[None] < asked[:, None]
    x = state.labels.obs[:, :: learner.length][:, : done.shape[1]]
    success, turned = trained(recorded.run, state)
    traced = learner.target is not None and learner.target.criterion == "trace"
    own = np.where(done & traced, np.exp(state.information), np.nan)
    under = jax.vmap(jax.vmap(lambda x: _shared().log_density(_reference(), x)))
    return Explored(
        label_of(recorded.config),
        learner.most,
        asked,
        np.where(done, state.decision, np.nan),
        success,
        turned,
        own,
        np.where(done, np.exp(under(x)), np.nan),
        *safety(recorded.made.obs),
    )


def _state(recorded: Recorded) -> Any:
    """The learner's state [S, ...] at the end of the run."""
    run = recorded.run
    like = jax.eval_shape(Loop(run.agent, run.seeds, 1).init)
    like = like.replace(env=None, control=None, memory=None, key=None)
    folder = recorded.folder.path / "checkpoints"
    return checkpoint.restore(folder, like, part=True)[1].learners["policy"]


def trained(run: Run, state: Any) -> tuple[np.ndarray, np.ndarray]:
    """Success and turned [lengths, S] after more training of the clones in `state` [S, ...]."""
    learner: Any = run.agent.learners["policy"]
    keys = jnp.stack([jax.random.fold_in(jax.random.key(seed), TRAINING) for seed in run.seeds])
    fit = jax.jit(jax.vmap(learner.fit, in_axes=(0, None, 0)))
    shares, before = [], 0
    for length in LENGTHS:
        each = jax.vmap(jax.random.fold_in, (0, None))(keys, length)
        state, before = fit(state, length - before, each), length
        shares.append(flown(run, state.policy))
    success, turned = np.swapaxes(np.array(shares), 0, 1)
    return success, turned


def flown(run: Run, policy: Any) -> tuple[np.ndarray, np.ndarray]:
    """Shares [S] of the flights of each policy [S, ...] that succeeded, and that turned."""
    keys = jnp.stack([evaluation_keys(seed, STARTS) for seed in run.seeds])
    episode, controller = Episode(Lander("flip"), FLIP), run.controllers["policy"]

    @jax.jit
    @jax.vmap
    def fly(policy: Any, keys: Any) -> Any:
        start = begin(episode, controller, keys)
        end = advance(episode, controller, Params(policy=policy), start, jnp.int32(FLIP))[0]
        return end.metrics["success"].mean(), end.metrics["turned"].mean()

    success, turned = fly(policy, keys)
    return np.asarray(success), np.asarray(turned)


@cache
def _experiment() -> Run:
    """The experiment with its default method."""
    return build(load(["experiment=thesis/fig_6_9"]))


def _shared() -> Any:
    """The target whose log density is log tr I."""
    learner: Any = _experiment().agent.learners["policy"]
    return learner.target


@cache
def _reference() -> Params:
    """The reference clone: demonstrations from starts of the flip, longest training."""
    learner: Any = _experiment().agent.learners["policy"]
    episode, (count, seed) = Episode(Lander("flip"), FLIP), REFERENCE
    flying, beginning, fitting = jax.random.split(jax.random.key(seed), 3)
    one = partial(rollout_with_actions, episode, learner.teacher, Params(), steps=FLIP)
    actions, states = jax.jit(jax.vmap(one))(jax.random.split(flying, count))
    state = learner.init(beginning, episode.spec)
    for u, obs in zip(actions, states.obs, strict=True):
        added = labels.add(state.labels, obs[:-1], u, jnp.array(True))
        state = state.replace(labels=added)
    return Params(policy=jax.jit(learner.fit)(state, LENGTHS[-1], fitting).policy)


def safety(obs: np.ndarray) -> tuple[np.ndarray, ...]:
    """Greatest V [S], shares [S] beyond 90 degrees and too high or low, deviations [6].

    obs [S, T, 6]: the states of the exploration.
    """
    guarded: Any = _experiment().agent.controller
    V = np.asarray(jax.jit(jax.vmap(jax.vmap(guarded.policy.lyapunov)))(jnp.asarray(obs)))
    beyond, high = np.abs(obs[..., 2]) > ANGLE, np.abs(obs[..., 1]) > HEIGHT
    return V.max(1), beyond.mean(1), high.mean(1), obs.std((0, 1))
