"""Checks of the task as it is set, and of what has been learned."""

from collections import Counter
from functools import partial
from math import log
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.analysis.held_out import RandomActions
from hybrid_rl.core.lifting import is_identity
from hybrid_rl.doctor.evidence import Evidence, explained
from hybrid_rl.doctor.limits import (
    ENOUGH,
    EPISODES,
    ERRORS,
    FEWEST,
    FIRST,
    INFLATED,
    OFFSET,
    SAME,
    START,
    UNSEEN,
)
from hybrid_rl.envs.adapters.external import External
from hybrid_rl.run.rows import of_world
from hybrid_rl.trained import load
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Params

START_KEY = 2_000_000  # of episodes, which no evaluation uses


def diverged(run: Evidence) -> str | None:
    """Learners that reached NaN or infinity."""
    ends = run.folder.summary.get("diverged") or [
        {"seed": row["seed"], "step": row["step"], "quantity": row["diverged"]}
        for row in run.folder.rows
        if "diverged" in row
    ]
    if not ends:
        return None
    first = min(ends, key=lambda end: end["step"])
    what = str(first["quantity"])
    cure = (
        "the world returned it: mend its reward or its observation there"
        if of_world(what)
        else "begin again with a smaller learning rate, or precision=float32"
    )
    return f"{what} is not finite from step {first['step']:,} on, seed {first['seed']}: {cure}"


def forecast(run: Evidence) -> str | None:
    """A learned model that is hardly better than "nothing changes"."""
    learner: Any = run.run.agent.learners.get("model")
    if run.made is None or learner is None or len(run.at(0)[0]) < ENOUGH:
        return None
    where = run.at(0)
    obs, act, after = (
        jnp.asarray(each[where]) for each in (run.made.obs, run.made.action, run.made.next_obs)
    )
    params = jax.tree.map(lambda leaf: leaf[0], load(run.path).params.model)
    if not is_identity(learner.model, params, run.run.agent.spec.obs):
        return None
    step = jax.jit(jax.vmap(learner.model.step, (None, 0, 0)))
    wrong = np.asarray(((step(params, obs, act) - after) ** 2).mean(0))[run.moving]
    share = wrong / np.asarray(((after - obs) ** 2).mean(0))[run.moving]
    at = np.flatnonzero(share > UNSEEN)
    if not len(at):
        return None
    worst = at[np.argmax(share[at])]
    return (
        f"the learned model's error in obs {run.moving[worst]} is {np.sqrt(share[worst]):.0%} of "
        '"nothing changes", on its own decisions: it does not see what moves; add velocities to '
        "the observation, or give it more decisions or model_learner.updates"
    )


def ends(run: Evidence) -> str | None:
    """Terminations at one and the same decision, or at the first one."""
    if run.made is None:
        return None
    k, t = np.nonzero(run.made.terminated)
    lengths = [each for each in _lengths(run, k, t) if each]
    if len(lengths) < 3:
        return None
    length, number = Counter(lengths).most_common(1)[0]
    if np.median(lengths) <= FIRST:
        return (
            f"{len(lengths):,} episodes were terminated within {FIRST} decisions: the end is true "
            "at the start; see `terminated` in reset and step"
        )
    if number > SAME * len(lengths) and length == max(lengths):
        return (
            f"{number:,} of {len(lengths):,} terminations came at decision {length}: a time limit "
            "that is returned as `terminated`, and the learner takes what follows for worth 0; "
            "leave it to episode.steps, or return it as `truncated`"
        )
    return None


def _lengths(run: Evidence, k: np.ndarray, t: np.ndarray) -> list[int]:
    """Decisions of each episode that ended with (k, t); 0 if its beginning may not be in memory."""
    first = [np.flatnonzero(run.begins[i, : j + 1])[-1] for i, j in zip(k, t, strict=True)]
    return [int(j - start + 1) if start else 0 for j, start in zip(t, first, strict=True)]


def short(run: Evidence) -> str | None:
    """Episodes whose last observation follows from the first one."""
    if run.made is None:
        return None
    k, t = np.nonzero(run.made.truncated)
    lengths = np.array(_lengths(run, k, t), int)
    whole = lengths > 0
    k, t, lengths = k[whole], t[whole], lengths[whole]
    if len(k) < ENOUGH or run.made.terminated.sum() > len(k):
        return None
    begin = np.asarray(run.made.obs)[k, t - lengths + 1][:, run.moving]
    end = np.asarray(run.made.next_obs)[k, t][:, run.moving]
    moved = (end - begin).std(0) > 0
    if not moved.any():
        return None
    fixed = float(np.median(explained(begin, end)[moved]))
    if fixed < START:
        return None
    return (
        f"the start of an episode fixes {fixed:.0%} of its end, {int(np.median(lengths))} "
        "decisions later: it is over before the policy has a say; episode.steps="
        f"{10 * int(np.median(lengths))}"
    )


def reward(run: Evidence) -> str | None:
    """A reward that never changes, or hides in an offset."""
    if run.made is None or run.made.reward.size < ENOUGH:
        return None
    mean, std = float(run.made.reward.mean()), float(run.made.reward.std())
    if std <= np.finfo(np.float32).eps * abs(mean):
        return f"the reward was {mean:.4g} in every decision: there is nothing to learn from"
    if abs(mean) > OFFSET * std:
        return (
            f"the reward is {mean:.4g} and varies by {std:.2g} only: the critic learns the offset "
            "first; subtract it"
        )
    return None


def sign(run: Evidence) -> str | None:
    """A reward that is lower where the task succeeds, in new episodes of random actions.

    From the differences d of an episode's mean reward with and without success: mean(d) and its
    standard error.
    """
    episode = run.run.agent.episode
    if isinstance(episode.env, External) or not any("world/success" in r for r in run.folder.rows):
        return None
    keys = jax.random.split(jax.random.key(START_KEY), EPISODES)
    controller: Any = RandomActions()
    go = partial(rollout_with_actions, episode, controller, Params())
    states = jax.jit(jax.vmap(lambda key: go(key, episode.steps)[1]))(keys)
    good, paid = (np.asarray(each)[:, 1:] for each in (states.metrics["success"], states.reward))
    good = good > 0
    both = good.any(1) & ~good.all(1)
    if both.sum() < FEWEST:
        return None
    pairs = zip(paid[both], good[both], strict=True)
    more = np.array([reward[on].mean() - reward[~on].mean() for reward, on in pairs])
    if more.mean() > -ERRORS * more.std(ddof=1) / np.sqrt(len(more)):
        return None
    return (
        f"random actions were paid {-more.mean():.3g} a decision less where they succeeded "
        f"(`success`, {both.sum()} episodes): is the sign of the reward wrong?"
    )


def random(run: Evidence) -> str | None:
    """Fewer random decisions than a linear model has unknowns, twice over; 0 is a choice.

    Least squares with p unknowns from n decisions predicts with 1 + p / (n - p - 1) times the
    variance of the noise.
    """
    agent = run.run.agent
    known = agent.replay.num_demonstrated(agent.num_envs) or run.config.get("begun")
    if known or not {"policy", "model"} & set(agent.learners):
        return None
    p = 1 + agent.spec.obs + agent.spec.act
    least = p + 1 + p / (INFLATED - 1)
    if not 0 < agent.random_steps < least:
        return None
    return (
        f"random_steps={agent.random_steps}: even a linear model of {agent.spec.obs} observations "
        f"and {agent.spec.act} actions has {p} unknowns a row; random_steps=1000 is usual"
    )


def critic(run: Evidence) -> str | None:
    """A critic whose values are larger than any possible return, with entropy."""
    rows = [row for row in run.folder.rows if row.get("sac/q") is not None]
    learner: Any = run.run.agent.learners.get("policy")
    if run.made is None or not rows or getattr(learner.critic, "scale", True):
        return None
    last = rows[-1]
    entropy = last.get("sac/alpha", 0.0) * run.run.agent.spec.act * log(2)  # uniform on [-1, 1]
    most = (max(float(run.made.reward.max()), 0.0) + entropy) / (1 - learner.discount)
    if last["sac/q"] <= most:
        return None
    return (
        f"the critic's value {last['sac/q']:.4g} (sac/q) is above {most:.4g}, the return "
        "of the best reward at every decision: it diverges; policy_learner.discount=0.98, "
        "critic.layer_norm=true, or fewer policy_learner.updates"
    )
