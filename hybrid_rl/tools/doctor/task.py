"""Checks of the task as it is set: its ends, its time limit, its reward."""

from collections import Counter

import numpy as np

from hybrid_rl.tools.doctor.evidence import LONGER, Evidence, of_each
from hybrid_rl.tools.doctor.limits import (
    BOTH,
    ENOUGH,
    ERRORS,
    FIRST,
    MOSTLY,
    OFFSET,
    PAID,
    SAME,
    SOME,
    START,
)
from hybrid_rl.tools.doctor.regression import explained, features, halved, missed, predicted
from hybrid_rl.types import Transition


def ends(run: Evidence) -> str | None:
    """Terminations at one and the same decision, at the first one, or where decisions cost."""
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
    return _costly(run, run.made)


def _costly(run: Evidence, made: Transition) -> str | None:
    """Rewards that are negative, in a task that ends no other way: then an early end is best."""
    newest = slice(-made.reward.shape[1] // 4, None)
    ended = int(made.terminated[:, newest].sum())
    whole = ended + int(made.truncated[:, newest].sum())
    known = any("world/success" in row for row in run.rows)  # the end may be the goal
    if known or ended < max(SOME, MOSTLY * whole) or (made.reward < 0).mean() < MOSTLY:
        return None
    return (
        f"nearly every reward is negative, and {ended:,} of the last {whole:,} episodes were "
        "terminated: the sooner one ends, the less it costs; unless the end is the goal, add "
        "a constant to the reward, or charge the end"
    )


def _lengths(run: Evidence, k: np.ndarray, t: np.ndarray) -> list[int]:
    """Decisions of each episode that ended with (k, t); 0 if its beginning may not be in memory."""
    first = [np.flatnonzero(run.begins[i, : j + 1])[-1] for i, j in zip(k, t, strict=True)]
    return [int(j - start + 1) if start else 0 for j, start in zip(t, first, strict=True)]


def short(run: Evidence) -> str | None:
    """Episodes that are over before a policy has a say, or before it is paid."""
    return _fixed(run) or of_each(_cut)(run)


def _cut(run: Evidence) -> str | None:
    """A policy that is paid more after the time limit, where its episodes go on.

    From the differences d of an episode's mean reward in the last quarter of LONGER time limits,
    and of the first one: mean(d) and its standard error.
    """
    made = run.by_policy
    if made is None:
        return None
    limit, last = run.run.agent.episode.steps, made.reward.shape[1]
    whole = made.lives.all(1)
    if whole.sum() < BOTH:
        return None
    reward, part = made.reward[whole], max(limit // 4, 1)
    then, later = reward[:, limit - part : limit].mean(1), reward[:, last - part :].mean(1)
    more = later - then
    if not more.mean() > max(ERRORS * _error(more), PAID * reward.std()):
        return None
    return (
        f"new episodes of the policy are paid {then.mean():.3g} a decision when the time limit "
        f"comes, and {later.mean():.3g} where they go on: it cuts them before they are paid; "
        f"episode.steps={LONGER * limit}"
    )


def _fixed(run: Evidence) -> str | None:
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
    return _late(run, run.made)


def _late(run: Evidence, made: Transition) -> str | None:
    """A reward that the decision before explains better than its own.

    Of both it is given observation, action and next observation.
    """
    k, t = where = run.at(1)
    if len(k) < ENOUGH:
        return None
    paid, after = made.reward[where][:, None], made.next_obs[where][:, run.moving]
    own = np.concatenate((run.known(where, actions=1), after), axis=1)
    before = np.concatenate(
        (run.known((k, t - 1), actions=1), made.obs[where][:, run.moving]), axis=1
    )
    now, late = (missed(paid, sum(predicted([features(z)], paid))) for z in (own, before))
    if not halved(late, now).any():
        return None
    return (
        f"a decision leaves {now.mean():.1%} of its reward open, the one before it "
        f"{late.mean():.1%}: the reward is paid one decision late; return it with its own step"
    )


def sign(run: Evidence) -> str | None:
    """A reward that is lower where the task succeeds, in new episodes of random actions.

    From the differences d of an episode's mean reward with and without success: mean(d) and its
    standard error.
    """
    made = run.by_chance if any("world/success" in row for row in run.folder.rows) else None
    if made is None or made.success is None:
        return None
    good = made.success > 0
    both = good.any(1) & ~good.all(1)
    if both.sum() < BOTH:
        return None
    pairs = zip(made.reward[both], good[both], strict=True)
    more = np.array([reward[on].mean() - reward[~on].mean() for reward, on in pairs])
    if more.mean() > -ERRORS * _error(more):
        return None
    return (
        f"random actions were paid {-more.mean():.3g} a decision less where they succeeded "
        f"(`success`, {both.sum()} episodes): is the sign of the reward wrong?"
    )


def _error(sample: np.ndarray) -> float:
    """The standard error of the mean of a sample [n]."""
    return float(sample.std(ddof=1) / np.sqrt(len(sample)))
