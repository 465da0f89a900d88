"""Checks that what a decision does follows one rule all the time.

    y = f(o) + g e,   e = W (u, u o):  of the change y, e is the effect of the action u; the gain g
                                       is 1 in a sound world

A rule that depends on something else, on every other decision, the episode, or whether a command
arrived, is a fault where it halves the error on decisions to which neither rule was fitted.
"""

from typing import NamedTuple

import numpy as np

from hybrid_rl.tools.doctor.evidence import Evidence
from hybrid_rl.tools.doctor.limits import ENOUGH, NOTHING, SHORTEST, STRETCH, TWO
from hybrid_rl.tools.doctor.regression import (
    features,
    halved,
    missed,
    predicted,
    products,
    residual,
)

NEWEST = 5_000  # decisions, of which the regressions are repeated
ROUNDS = 4  # of gains and effects in turn
TINY = np.finfo(float).tiny


class Rows(NamedTuple):
    """N decisions."""

    obs: np.ndarray  # [N, p]
    action: np.ndarray  # [N, m]
    y: np.ndarray  # [N, o] changes, over their standard deviation
    age: np.ndarray  # [N] decisions since the episode began
    episode: np.ndarray  # [N] its number

    @property
    def fold(self) -> np.ndarray:
        """[N] 0 or 1: stretches of an episode in turn."""
        return self.age // STRETCH % 2

    def effect(self, gain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """f(o) and e [N, o], with the gain [N] of each decision."""
        acts = gain[:, None] * products(self.action, self.obs)
        f, e = predicted([features(self.obs), acts], self.y, self.fold)
        return f, e


def _rows(run: Evidence) -> Rows | None:
    if run.made is None or len(run.at(1)[0]) < ENOUGH:
        return None
    (k, t), now = (each[-NEWEST:] for each in run.at(0)), np.arange(run.begins.shape[1])
    first = np.maximum.accumulate(np.where(run.begins, now, 0), axis=1)[k, t]
    _, episode = np.unique(k * len(now) + first, return_inverse=True)
    y = run.change((k, t)).astype(float)
    y /= np.where(y.std(0) > 0, y.std(0), 1.0)
    action = np.asarray(run.made.action[k, t])
    return Rows(run.known((k, t)), action, y, t - first, episode)


def alternates(run: Evidence) -> str | None:
    """Entries that follow another rule every other decision."""
    rows = _rows(run)
    if rows is None:
        return None
    phi = features(np.concatenate((rows.obs, rows.action), axis=1))
    single = missed(rows.y, sum(predicted([phi], rows.y)))
    both = missed(rows.y, sum(predicted([phi, phi * (rows.age % 2)[:, None]], rows.y)))
    at = np.flatnonzero(halved(both, single))
    if not len(at):
        return None
    worst = at[np.argmax(single.mean(0)[at])]
    return (
        f"of how obs {', '.join(map(str, run.moving[at][:5]))} changes observation and action "
        f"leave {single[:, worst].mean():.1%} open, and {both[:, worst].mean():.1%} if every other "
        "decision has a rule of its own: are entries swapped there, or sensors read in turn?"
    )


def gains(run: Evidence) -> str | None:
    """Actions of which a part does nothing, or whose effect depends on the episode."""
    rows = _rows(run)
    return None if rows is None else _lost(rows) or _by_episode(rows)


def _lost(rows: Rows) -> str | None:
    """Gains of two values, one of them 0: two means leave less than TWO of their variance.

    Of normal gains they leave 1 - 2 / pi, of uniform ones 1 / 4.
    """
    gain, weight = _gain(rows, *rows.effect(np.ones(len(rows.y))))
    weight, means = np.minimum(weight, np.quantile(weight, 0.9)), np.array([0.0, 2.0])
    for _ in range(10 * ROUNDS):
        arrived = (abs(gain - means[0]) > abs(gain - means[1])).astype(int)
        total = np.bincount(arrived, weight, 2)
        if not total.all():
            return None
        means = np.bincount(arrived, weight * gain, 2) / total
    spread = weight @ (gain - weight @ gain / weight.sum()) ** 2
    lost = 1 - arrived.mean()
    if (
        weight @ (gain - means[arrived]) ** 2 > TWO * spread
        or not abs(means[0]) < NOTHING * means[1]
    ):
        return None
    return (
        f"{lost:.0%} of the actions had no effect, and the others {means[1]:.1f} times that of "
        "all: commands are lost, or too small for the motor; compare what is sent and what arrives"
    )


def _by_episode(rows: Rows) -> str | None:
    """A gain for each episode, of one half of its stretches, that explains the other half."""
    count = np.bincount(rows.episode)
    if len(count) < 2 or np.median(count) < SHORTEST:
        return None
    single = missed(rows.y, sum(rows.effect(np.ones(len(rows.y)))))
    gain = _signs(rows)
    for _ in range(ROUNDS):
        f, e = rows.effect(gain[rows.episode])
        gain = np.clip(gain * _means(rows, f, e, rows.episode), -2, 2)
    f, e = rows.effect(gain[rows.episode])
    half = 2 * rows.episode + rows.fold
    other = np.append(_means(rows, f, e, half), (1, 1))[half + 1 - 2 * rows.fold]
    each = missed(rows.y, f + other[:, None] * e)
    if not halved(each, single).any():
        return None
    best = int(np.argmax(np.where(halved(each, single), single.mean(0), 0)))
    turned = min((gain < 0).sum(), (gain > 0).sum())
    how = f"the other way in {turned} of {len(gain)}" if turned else "more in some than in others"
    return (
        f"what an action does depends on the episode, {how}: that leaves "
        f"{each[:, best].mean():.0%} of a change open, one rule for all "
        f"{single[:, best].mean():.0%}; does reset change a sign, the motor or the body?"
    )


def _signs(rows: Rows) -> np.ndarray:
    """[E] 1 or -1 for each episode: of its actions' coefficients along their main direction."""
    left = residual(rows.obs, rows.y)
    left /= np.maximum(left.std(0), TINY)
    found = []
    for number, count in enumerate(np.bincount(rows.episode)):
        at = rows.episode == number
        z = np.concatenate((rows.action[at], np.ones((count, 1))), axis=1)
        found.append(np.sqrt(count) * np.linalg.lstsq(z, left[at], rcond=None)[0][:-1].ravel())
    return np.where(np.linalg.svd(np.array(found), full_matrices=False)[0][:, 0] < 0, -1.0, 1.0)


def _gain(rows: Rows, f: np.ndarray, e: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The gain of each decision and its weight [N], from all entries."""
    accuracy = 1 / np.maximum(((rows.y - f - e) ** 2).mean(0), np.finfo(np.float32).eps)
    weight = (accuracy * e**2).sum(1)
    return np.clip((accuracy * (rows.y - f) * e).sum(1) / np.maximum(weight, TINY), -5, 5), weight


def _means(rows: Rows, f: np.ndarray, e: np.ndarray, group: np.ndarray) -> np.ndarray:
    """The gain of each group [G] of decisions; `group` [N] are their numbers."""
    gain, weight = _gain(rows, f, e)
    return np.bincount(group, weight * gain) / np.maximum(np.bincount(group, weight), TINY)
