"""Falling quadcopters that learn while they stop: figures 7-2 and 7-3.

    error        |v|^2 + |w|^2, v [m/s], w [rad/s]; at rest: below 0.01 from a time on to the end
    information  tr sum s s' and log det (sum s s' + 0.01 I), s = (z, u), z of the thesis, u = 6 a

The information is that of the flights, in the same features for all methods, whatever they learn.
Shares have Wilson's 95% interval. With sensor noise the error is that of the true velocities: means
over the decisions between two rows of metrics.jsonl.
"""

from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import jax
import numpy as np
from scipy.stats import norm

from hybrid_rl.analysis.results import RunFolder, find
from hybrid_rl.envs.analytic.quadcopter_se3 import DT, THRUST
from hybrid_rl.errors import UsageError
from hybrid_rl.settings.build import build, load
from hybrid_rl.thesis.studies.recorded import Recorded, labels, one_episode, read

TWIST = slice(12, 18)  # v and w in an observation
STILL = 0.01  # error at rest
FIRST = 1.0  # [s] of learning in the thesis
SHARES = (1.5, 2.0, 3.0, 4.0)  # [s] by which a trial is at rest
MARKS = (0.5, 1.0, 2.0, 3.0, 4.0)  # [s] at which errors are reported
PRIOR = 0.01  # of the log-determinant
SIGMAS = 6.0  # of sensor noise, within which two first observations are equal


class Fall(NamedTuple):
    """The trials of one method: S trials of T decisions."""

    label: str
    obs: np.ndarray  # [S, T+1, 18]
    action: np.ndarray  # [S, T, 4]
    error: np.ndarray  # [S, T+1]
    std: float  # largest standard deviation of sensor noise
    seconds: float  # wall time of a decision of all trials, over their number; NaN: not known


def falls(pattern: str) -> list[Fall]:
    """The trials of all runs that match, with the same first observations.

    Raises:
        UsageError: for runs that cannot be compared.
    """
    folders = find(pattern)
    named = zip(folders, labels(folders), strict=True)
    each = [of(read(path, "quadcopter_se3"), label) for path, label in named]
    check_starts(each, folders)
    return each


def of(recorded: Recorded, label: str) -> Fall:
    """The trials of a run."""
    made, path = one_episode(recorded), recorded.folder.path
    if recorded.decisions < round(FIRST / DT):
        raise UsageError(f"runs={path}: needs trials of {FIRST:g} s or more, total_steps=200")
    obs = np.concatenate([made.obs, made.next_obs[:, -1:]], axis=1)
    error = (obs[..., TWIST].astype(float) ** 2).sum(-1)
    std = max(recorded.config.env.get("sensor_noise", [0.0]))
    if std > 0:
        error[:, 1:] = logged(recorded.folder, recorded.run.seeds, error.shape[1] - 1)
    speeds = [row.get("perf/env_steps_per_s") for row in recorded.folder.rows]
    known = [1 / speed for speed in speeds if speed]
    return Fall(label, obs, made.action, error, std, float(np.median(known or [np.nan])))


def logged(folder: RunFolder, seeds: tuple[int, ...], decisions: int) -> np.ndarray:
    """[S, T] of world/twist, each row's mean at all decisions since the row before."""
    result = np.full((len(seeds), decisions), np.nan)
    for i, seed in enumerate(seeds):
        rows = [row for row in folder.rows if row["seed"] == seed and "world/twist" in row]
        begin = 0
        for row in rows:
            result[i, begin : row["step"]] = row["world/twist"]
            begin = row["step"]
    return result


def check_starts(each: list[Fall], folders: list[Path]) -> None:
    """Raise UsageError unless trial i of all runs starts at the same observation."""
    first, path = each[0], folders[0]
    for other, folder in zip(each[1:], folders[1:], strict=True):
        if other.obs.shape != first.obs.shape:
            sizes = [f"{o.shape[0]} trials of {o.shape[1] - 1}" for o in (first.obs, other.obs)]
            raise UsageError(
                f"runs={folder}: has {sizes[1]} decisions where {path} has {sizes[0]}; "
                "train with the same num_seeds and total_steps"
            )
        allowed = 1e-6 + SIGMAS * (first.std + other.std)
        away = np.abs(other.obs[:, 0] - first.obs[:, 0]).max(1)
        if (away > allowed).any():
            raise UsageError(
                f"runs={folder}: trial {int(np.argmax(away > allowed))} starts elsewhere than in "
                f"{path}; train with the same seed and env"
            )


def settled(error: np.ndarray, threshold: float = STILL) -> np.ndarray:
    """[S] index from which errors [S, T+1] are below the threshold to the end; inf: never."""
    above = ~(error < threshold)  # not a number counts as above
    last = error.shape[1] - np.argmax(above[:, ::-1], axis=1)
    index = np.where(above.any(1), last, 0).astype(float)
    return np.where(index < error.shape[1], index, np.inf)


def wilson(successes: int, trials: int, level: float = 0.95) -> tuple[float, float]:
    """Wilson's score interval of a share. Source: Wilson, JASA 22, 1927."""
    z, share = norm.ppf(0.5 + level / 2), successes / trials
    middle = share + z**2 / (2 * trials)
    half = z * np.sqrt(share * (1 - share) / trials + z**2 / (4 * trials**2))
    scale = 1 + z**2 / trials
    return max(0.0, (middle - half) / scale), min(1.0, (middle + half) / scale)


def regressors(fall: Fall) -> np.ndarray:
    """s [S, T, 22] in the thesis' features and units of u."""
    z = _lift()(fall.obs[:, :-1])
    return np.concatenate([z, THRUST * fall.action], axis=-1).astype(float)


@cache
def _lift() -> Any:
    """obs [S, T, 18] -> z [S, T, 18] in the thesis' features."""
    learner: Any = build(load(["experiment=thesis/fig_7_2"])).agent.learners["model"]
    return jax.jit(jax.vmap(jax.vmap(lambda obs: learner.model.features({}, obs))))


def trace(s: np.ndarray) -> np.ndarray:
    """[S, T] tr sum s s' over the decisions so far, s [S, T, r]."""
    return np.cumsum((s**2).sum(-1), axis=1)


def log_det(s: np.ndarray, prior: float = PRIOR) -> np.ndarray:
    """[S] log det (sum s s' + prior I) over all decisions of s [S, T, r]."""
    information = s.swapaxes(1, 2) @ s + prior * np.eye(s.shape[-1])
    return np.linalg.slogdet(information)[1]


def reported(fall: Fall, s: np.ndarray) -> dict[str, Any]:
    """The numbers of one method; s: its regressors [S, T, r]."""
    error, (trials, length) = fall.error, fall.error.shape
    time = DT * settled(error)
    end = DT * (length - 1)
    marks = [mark for mark in SHARES if mark <= end + 1e-9] or [end]
    at_rest = {mark: int((time <= mark + 1e-9).sum()) for mark in marks}
    begun = round(FIRST / DT)
    known = {mark: error[:, round(mark / DT)] for mark in MARKS if round(mark / DT) < length}
    greatest = np.sqrt(error[:, : begun + 1].max(1))
    u = THRUST * fall.action
    return {
        "trials": trials,
        "at_rest": {f"{m:g}": [n / trials, *wilson(n, trials)] for m, n in at_rest.items()},
        "time_at_rest": time,
        "median_time_at_rest": float(np.median(time[np.isfinite(time)]))
        if np.isfinite(time).any()
        else None,
        "error": {f"{m:g}": np.nanquantile(v, [0.5, 0.1, 0.9]) for m, v in known.items()},
        "trace_1_s": np.quantile(trace(s[:, :begun])[:, -1], [0.5, 0.1, 0.9]),
        "log_det_1_s": np.quantile(log_det(s[:, :begun]), [0.5, 0.1, 0.9]),
        "greatest_twist_1_s": [float(np.median(greatest)), float(greatest.max())],
        "rms_u": float(np.sqrt((u**2).mean())),
        "rms_u_1_s": float(np.sqrt((u[:, :begun] ** 2).mean())),
        "microseconds_a_decision": 1e6 * fall.seconds,
    }


def lines(numbers: dict[str, Any]) -> list[str]:
    """A line for each method."""
    result = []
    for label, one in numbers["methods"].items():
        last = max(one["at_rest"], key=float)
        share, low, high = one["at_rest"][last]
        time, late = one["median_time_at_rest"], max(one["error"], key=float)
        after = "" if time is None else f" after {time:.2f} s (median)"
        middle, below, above = one["error"][late]
        result.append(
            f"{label}, {one['trials']} trials: at rest by {last} s {share:.1%} "
            f"[{low:.1%}, {high:.1%}]{after}; error at {late} s {middle:.2g} "
            f"[{below:.2g}, {above:.2g}]; after 1 s tr I {one['trace_1_s'][0]:,.0f}, log det "
            f"{one['log_det_1_s'][0]:.1f}, greatest twist {one['greatest_twist_1_s'][1]:.3g}"
        )
    return result
