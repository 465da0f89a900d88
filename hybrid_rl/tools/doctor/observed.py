"""Checks of what the learner is shown, and of what its actions do to it."""

import numpy as np

from hybrid_rl import lag
from hybrid_rl.tools.doctor.evidence import Evidence
from hybrid_rl.tools.doctor.limits import (
    CLIPPED,
    DISTINCT,
    ENOUGH,
    ERRORS,
    HISTORY,
    LAGS,
    NOISE,
    OLDER,
    RELATED,
    SLOW,
    SOONER,
    UNSEEN,
)
from hybrid_rl.tools.doctor.regression import (
    curved,
    explained,
    features,
    missed,
    predicted,
    residual,
)
from hybrid_rl.tools.doctor.regular import alternates, gains


def constant(run: Evidence) -> str | None:
    """Entries of the observation that never change."""
    if run.made is None or run.made.obs.shape[1] < ENOUGH:
        return None
    still = np.setdiff1d(np.arange(run.made.obs.shape[-1]), run.moving)
    if not len(still):
        return None
    return (
        f"obs {_numbers(still)} never changed: a sensor that is off, or a number that is not "
        "needed; take it out of the observation, or mend it"
    )


def clipped(run: Evidence) -> str | None:
    """Entries of the observation that stand at their largest or smallest value."""
    if run.made is None or run.made.obs.shape[1] < ENOUGH:
        return None
    obs = run.made.obs.reshape(-1, run.made.obs.shape[-1])
    share = (obs == obs.max(0)).mean(0) + (obs == obs.min(0)).mean(0)
    levels = np.array([len(np.unique(entry)) for entry in obs.T])
    at = np.flatnonzero((share > CLIPPED) & (levels > DISTINCT))
    if not len(at):
        return None
    worst = at[np.argmax(share[at])]
    return (
        f"obs {_numbers(at)} stood at its limit, {obs[:, worst].min():.4g} or "
        f"{obs[:, worst].max():.4g}, in {share[worst]:.0%} of the decisions: it is clipped, and "
        "what lies beyond it is not seen; widen the limits, or divide it by a larger number"
    )


def effects(run: Evidence) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Effect [L, o] of the actions 0, 1, ... decisions old, of all together [o], and what is left.

    The error of the change's prediction without an action, less that with all, over that without
    any; 0 below ERRORS standard errors. What is left [o] is the share of the change that is
    not predicted.
    """
    lags = LAGS
    while lags > 2 and len(run.at(lags - 1)[0]) < ENOUGH:
        lags -= 1
    where = run.at(lags - 1)
    if len(where[0]) < ENOUGH:
        return None
    y, obs, actions = run.change(where), run.known(where), run.known(where, actions=lags)
    actions = actions[:, obs.shape[1] :].reshape(len(obs), lags, -1)  # [N, L, m]

    def prediction(kept: list[int]) -> np.ndarray:
        z = np.concatenate((obs, *(actions[:, k] for k in kept)), axis=1)
        return sum(predicted([features(z)], y))

    every, full = list(range(lags)), prediction(list(range(lags)))
    none, best = missed(y, prediction([])), missed(y, full)
    size = np.where(none.any(0), none.mean(0), np.inf)  # what needs no action has no effect of one
    loss = [missed(y, prediction([j for j in every if j != k])) - best for k in every]
    sure = [each.mean(0) > ERRORS * each.std(0) / np.sqrt(len(y)) for each in loss]
    effect = np.where(sure, np.mean(loss, axis=1) / size, 0.0)
    spread = y.var(0)
    left = ((y - full) ** 2).mean(0) / np.where(spread > 0, spread, np.inf)  # even: predicted
    return effect, (none - best).mean(0) / size, left


def action(run: Evidence) -> str | None:
    """Actions that do nothing, or whose effect comes later, on some entries or on all."""
    found = None if run.made is None else effects(run)
    if found is None:
        return None
    each, together, left = found
    most = int(np.argmax(together))
    effect, late = each[:, most], int(np.argmax(each[:, most]))
    shown = ", ".join(f"{min(part, 1):.0%}" for part in effect)
    shown = f"of what actions can explain, those 0, 1, ... decisions old explain {shown}"
    old = (each[0] == 0) & (each.max(0) > HISTORY * together) & (together > HISTORY)
    if old.any() and each[0].any():
        return (
            f"obs {_numbers(run.moving[old])} shows an action later than obs "
            f"{_numbers(run.moving[each[0] > 0])}: that sensor is late, by about "
            f"{each[:, old].argmax(0).max()} decisions; read all at the same time"
        )
    # an effect may hide in what is not predicted
    if (left[most] if effect.any() else left.max()) > UNSEEN:
        return None
    if not effect.any():
        if gains(run) or alternates(run):  # then they cancel out
            return None
        return (
            "no action changed what is observed afterwards: is it applied, and is the motor on? "
            "render run=DIR shows it"
        )
    late_by = lag_of(run) or late * (effect[0] == 0 and together[most] > HISTORY)
    two = effect[int(late_by) : int(late_by) + 2].sum()  # a motor that is slow has a longer tail
    if late_by > SOONER and two > OLDER * (effect.sum() - two):
        seconds = late_by * run.run.agent.spec.dt
        return (
            f"an action acts {late_by:.2f} decisions late ({shown}): shorten the delay, or say it: "
            f"episode.lag={seconds:.3g} (env.lag={seconds:.3g} with task=robot)"
        )
    if effect[1:].sum() > OLDER * effect[0]:
        return (
            f"older actions act more than the newest one ({shown}): the motor is slower than "
            "a decision; episode.action_repeat=5, or show the learner the motor's state"
        )
    return None


def lag_of(run: Evidence) -> float:
    """The lag [decisions] of actions by the random decisions; 0: none, or too few of them."""
    assert run.made is not None
    agent = run.run.agent
    k, t = run.at(LAGS)
    chance = t < agent.random_steps // agent.num_envs
    k, t = k[chance], t[chance]
    ages = np.arange(LAGS + 1)
    made = run.made.obs, run.made.next_obs, run.made.action
    obs, next_obs, action = map(np.asarray, made)
    sent = action[k[:, None], t[:, None] - ages]
    seen, after = (each[k, t][:, run.moving] for each in (obs, next_obs))
    return lag.estimated(seen, after, sent, np.tile(-ages, (len(k), 1)), np.ones(len(k)))


def rare(run: Evidence) -> str | None:
    """Successive observations that are hardly related, of the slower half of the entries.

    Velocities may change with every contact; positions that do are sampled too rarely.
    """
    if run.made is None or len(run.at(1)[0]) < ENOUGH:
        return None
    k, t = run.at(1)
    obs = run.made.obs[..., run.moving]
    before, after = obs[k, t - 1], obs[k, t]
    related = ((before - before.mean(0)) * (after - after.mean(0))).mean(0)
    slow = float(np.quantile(related / (before.std(0) * after.std(0)), SLOW))
    if slow > RELATED:
        return None
    seconds = run.run.agent.spec.dt
    return (
        f"successive observations are correlated by {slow:.2f} only: in {seconds:.3g} s, a "
        "decision, the state is another one (or the sensors are noise); decide more often: a "
        "smaller episode.action_repeat, or dt"
    )


def noise(run: Evidence) -> str | None:
    """Changes of the observation that the next decision takes back: noise of a sensor.

    Noise n of variance s^2 makes n' - n of the change, and -s^2 of the covariance of what is left
    of it from one decision to the next, so that -2 cov is its share. What is left is predicted
    from the observation before: that of the decision has the same noise n. A contact moves and
    moves back, too, but what the decision's own observation leaves of it has no such covariance.
    Where the observations are too many for more than a plane, what bends is left, too, and may
    do the same: so half of the noise at least must be there when nothing acts, too.
    """
    if run.made is None or len(run.at(2)[0]) < ENOUGH:
        return None
    noise, share, sure = _taken_back(run)
    found = (share > NOISE) & sure
    rest = run.at_rest if found.any() else None
    if rest is not None and len(rest.at(2)[0]) >= ENOUGH:
        noise_at_rest, share_at_rest, _ = _taken_back(rest)
        found &= (share_at_rest > NOISE) & (2 * noise_at_rest > noise)
    at = np.flatnonzero(found)
    if not len(at):
        return None
    size = ", ".join(f"{each:.2g}" for each in noise[at])
    return (
        f"obs {_numbers(at)} moves and moves back: noise of about {size} is "
        f"{min(share[at].max(), 1):.0%} of its change; filter the sensor, or "
        "give the learner several observations"
    )


def _taken_back(run: Evidence) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """[o] std of the noise, its share of the change, whether a contact cannot make it.

    Each is 0 for an entry that does not move.
    """
    assert run.made is not None
    k, t = run.at(1)
    y = run.change((k, t))
    next_one = (k[1:] == k[:-1]) & (t[1:] == t[:-1] + 1) & ~run.begins[k[1:], t[1:]]

    def both(seen: np.ndarray) -> np.ndarray:  # [N, o] products of what is left in succession
        left = residual(seen, y)
        return (left[1:] * left[:-1])[next_one]

    before = np.concatenate((run.known((k, t - 1), actions=1), run.made.action[k, t]), axis=1)
    older, own = both(before), both(run.known((k, t), actions=1))
    share = -2 * older.mean(0) / np.maximum(y.var(0), np.finfo(float).tiny)
    sure = -own.mean(0) > ERRORS * own.std(0) / np.sqrt(len(own))
    found = np.zeros((3, run.made.obs.shape[-1]))
    found[:, run.moving] = np.sqrt(np.maximum(-older.mean(0), 0)), share, sure
    return found[0], found[1], found[2] > 0


def hidden(run: Evidence) -> str | None:
    """Changes that observation and two actions do not tell, and the last observation does."""
    if run.made is None or len(run.at(1)[0]) < ENOUGH or run.run.agent.episode.history > 1:
        return None
    where = run.at(1)
    y = run.change(where)
    last = run.known(where, obs=1, actions=2)
    if not curved(last):  # a plane's error would be taken for something hidden
        return None
    unseen = 1 - explained(run.known(where, actions=2), y)
    more = 1 - explained(last, y)
    at = np.flatnonzero((unseen > UNSEEN) & (more < (1 - HISTORY) * unseen))
    if not len(at):
        return None
    worst = at[np.argmax(unseen[at])]
    return (
        f"observation and action explain {1 - unseen[worst]:.0%} of how obs "
        f"{_numbers(run.moving[at])} changes, with the last observation {1 - more[worst]:.0%}: "
        "what moves is not observed; add velocities to the observation, or episode.history=3"
    )


def _numbers(entries: np.ndarray) -> str:
    """0, 2 and 5; of many the first ones."""
    shown = ", ".join(map(str, entries[:5]))
    return f"{shown} and {len(entries) - 5} more" if len(entries) > 5 else shown
