"""Checks of what has been learned, and of what learning needs."""

from functools import partial
from math import log, log10
from typing import Any

import jax
import numpy as np

from hybrid_rl import lifting
from hybrid_rl.tools.doctor.evidence import STILL, Evidence
from hybrid_rl.tools.doctor.limits import ENOUGH, INFLATED, OUTWEIGHED, SUMMED, UNSEEN

UNSOUND = (
    "the replay memory of the newest checkpoint has numbers that are not finite: what is observed "
    "is not examined; train again, or resume another copy of the run"
)


def diverged(run: Evidence) -> str | None:
    """Learners that reached NaN or infinity."""
    ends = run.folder.summary.get("diverged") or [
        {"seed": row["seed"], "step": row["step"], "quantity": row["diverged"]}
        for row in run.folder.rows
        if "diverged" in row
    ]
    if not ends:
        return UNSOUND if run.damaged else None
    first = min(ends, key=lambda end: end["step"])
    what = str(first["quantity"])
    cure = (
        "the world returned it: mend its reward or its observation there"
        if what.startswith("world/") and what != "world/action"
        else "begin again with a smaller learning rate, or precision=float32"
    )
    return f"{what} is not finite from step {first['step']:,} on, seed {first['seed']}: {cure}"


def forecast(run: Evidence) -> str | None:
    """A learned model that is hardly better than "nothing changes", on new episodes.

    They are of random actions, and of the policy until its time limit, where observations are
    within the limits of those that it has learned from: beyond them a model promises nothing.
    Where the world cannot be run here, the decisions of the run stand for them.
    """
    learner: Any = run.run.agent.learners.get("model")
    if learner is None or run.params is None or run.made is None:
        return None
    agent = run.run.agent
    own = lifting.is_identity(learner.model, run.params.model, agent.seen.obs)
    if not own or agent.episode.history > 1:
        return None
    where = run.at(0)
    own = tuple(
        np.asarray(each[where]) for each in (run.made.obs, run.made.action, run.made.next_obs)
    )
    tried = [each for each in (run.by_chance, run.by_policy) if each is not None]
    new = [each.rows(run.run.agent.episode.steps) for each in tried]
    rows = _within(own[0], tuple(map(np.concatenate, zip(*new, strict=True)))) if new else own
    if min(len(rows[0]), len(own[0])) < ENOUGH:
        return None
    step = jax.jit(jax.vmap(partial(learner.model.step, run.params.model)))
    share, kept = _unseen(step, rows), _unseen(step, own)
    worst = int(np.argmax(share))
    if not share[worst] > UNSEEN:
        return None
    cure = (
        "it does not see what moves; add velocities to the observation, or give it more decisions "
        "or model_learner.updates"
    )
    if kept[worst] < UNSEEN:
        cure = "these are too few for it; more random_steps or decisions, or a smaller model"
    return (
        f"the learned model's error in obs {worst} is {np.sqrt(share[worst]):.0%} of "
        f'"nothing changes" on new decisions, {np.sqrt(kept[worst]):.0%} on its own: {cure}'
    )


def _within(known: np.ndarray, rows: tuple[np.ndarray, ...]) -> tuple[np.ndarray, ...]:
    """The part of `rows` whose obs [n, o] are within the limits of `known` [N, o]."""
    inside = ((rows[0] >= known.min(0)) & (rows[0] <= known.max(0))).all(1)
    return tuple(each[inside] for each in rows)


def _unseen(step: Any, rows: tuple[np.ndarray, ...]) -> np.ndarray:
    """[o] the squared error of `step` over that of "nothing changes"; 0 where nothing does.

    In no decision either counts for more than the mean squared change, or a few collisions, which
    no model tells well, would count for more than all others.
    """
    obs, action, after = rows
    wrong, change = (np.asarray(step(obs, action)) - after) ** 2, (after - obs) ** 2
    most = change.mean(0)
    still = most <= (STILL * (1 + abs(obs).max(0))) ** 2
    share = np.minimum(wrong, most).mean(0) / np.where(still, 1, np.minimum(change, most).mean(0))
    return np.where(still, 0.0, share)


def random(run: Evidence) -> str | None:
    """Fewer random decisions than a linear model has unknowns, twice over; 0 is a choice.

    Least squares with p unknowns from n decisions predicts with 1 + p / (n - p - 1) times the
    variance of the noise.
    """
    agent = run.run.agent
    known = agent.replay.num_demonstrated(agent.num_envs) or run.run.config.get("begun")
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
    seen = ((row, row.get("sac/q"), row.get("sac/alpha", 0.0)) for row in run.rows)
    rows = [row for row, value, alpha in seen if value is not None and alpha is not None]
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


def scale(run: Evidence) -> str | None:
    """Rewards beyond what the critic has reached, or below what the entropy pays.

    An untrained critic's values are about 1. The target follows them by tau in an update, so that
    after n updates they hold sums of about n tau rewards, if Adam has moved the weights that far.
    """
    learner: Any = run.run.agent.learners.get("policy")
    rows = _learning(run)
    if run.made is None or run.params is None or not rows:  # or rewards are scaled already
        return None
    act, std = run.run.agent.spec.act, float(run.made.reward.std())
    most = rows[-1]["sac/alpha"] * act * log(2)  # the entropy of uniform actions on [-1, 1]
    if most > OUTWEIGHED * std > 0:
        return (
            f"the reward varies by {std:.2g}, and entropy is paid up to {most:.2g} a decision "
            f"(sac/alpha): the policy stays random; multiply the reward by {_round(most / std)}, "
            "or policy_learner.alpha=" + f"{rows[-1]['sac/alpha'] * std / most:.1g}"
        )
    updates = (rows[-1]["step"] - run.run.agent.random_steps) * learner.updates
    if updates * learner.tau < SUMMED:
        return None
    where = run.at(0)
    values = learner.critic.value(run.params.critic, run.made.obs[where], run.made.action[where])
    value, one = (float(np.sqrt(np.mean(np.square(e)))) for e in (values, run.made.reward[where]))
    if not (one > 1 and value < one):
        return None
    return (
        f"a reward is about {one:.2g}, and the critic's values, sums of them, are {value:.2g}: "
        f"it has not learned values that large; divide the reward by {_round(one)}, or "
        "critic.scale=true"
    )


def _learning(run: Evidence) -> list[dict[str, Any]]:
    """The rows that have the critic's value and the entropy's weight."""
    names = "sac/alpha", "sac/q"
    return [row for row in run.rows if all(row.get(name) is not None for name in names)]


def _round(x: float) -> str:
    """A power of ten."""
    return f"1e{round(log10(x))}"
