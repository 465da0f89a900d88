"""The actions that acted between two observations, and how late, from the times of both.

    share_i = |[t_i + lag, t_{i-1} + lag] and [0, T]| / T,   u_acted = sum_i share_i u_i
    lag = argmin_d |(I - P) (Y - U_acted(d) B)|^2

u_0 is the action of the decision, u_1 the one before; t_i is when it was sent and T when the next
observation was taken, both from this one on [s]. Y is the change of the observation in units of its
standard deviation, P projects on what is linear in the observation, B is a ridge regression. Where
no lag explains more than any would by chance, it is 0. Once there is a model f of x and u, the lag
is followed by min_d |x_{t+dt} - f(x_t, U_acted(d))|, which needs no random actions.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.outside import handover

ENOUGH = 200  # random decisions that an estimate needs
SHORTEST = 1e-6  # [s] of an interval, where an observation is that of before
RIDGE = 1e-4  # of actions, per decision
STEPS = 50  # lags in a decision that are tried
FOLLOWED, COARSE = 100, 10  # decisions by which a lag is followed, and lags in one
SURE = 3.0  # standard errors by which another lag must be better


def shares(times: np.ndarray, interval: np.ndarray, lag: float) -> np.ndarray:
    """The share [..., P] of an interval [...] [s] in which each action acts, the newest first.

    times: [..., P] when each was sent [s]; the oldest acted before.
    """
    interval = np.maximum(np.asarray(interval, float), SHORTEST)
    begins = np.clip(times + lag, 0, interval[..., None])
    begins[..., -1] = 0
    ends = np.concatenate([interval[..., None], begins[..., :-1]], axis=-1)
    return (ends - begins) / interval[..., None]


def acted(sent: np.ndarray, times: np.ndarray, interval: np.ndarray, lag: float) -> np.ndarray:
    """The mean [..., m] of the actions `sent` [..., P, m] by their `shares`."""
    return np.einsum("...p,...pm->...m", shares(times, interval, lag), sent)


def estimated(
    obs: np.ndarray, after: np.ndarray, sent: np.ndarray, times: np.ndarray, interval: np.ndarray
) -> float:
    """The lag [s] of N decisions at obs [N, o] that led to `after` [N, o]; the rest as of `acted`.

    The actions should be random, and those of successive decisions independent. 0 if fewer than
    ENOUGH.
    """
    if len(obs) < ENOUGH:
        return 0.0
    y, period = after - obs, float(np.median(interval))
    seen, _ = np.linalg.qr(np.column_stack([np.ones(len(obs)), obs]).astype(float))
    y = y / np.maximum(y.std(0), 1e-9)
    y = y - seen @ (seen.T @ y)

    def error(lag: float) -> float:
        u = acted(sent, times, interval, lag)
        u = u - seen @ (seen.T @ u)
        ridge = RIDGE * len(u) * np.eye(u.shape[1])
        return float(((y - u @ np.linalg.solve(u.T @ u + ridge, u.T @ y)) ** 2).sum())

    tried = np.arange((sent.shape[1] - 2) * STEPS + 1) / STEPS * period
    errors = np.array([error(lag) for lag in tried])
    chance = 1 - 2 * sent.shape[-1] / len(obs)
    return float(tried[errors.argmin()]) if errors.min() < chance * errors[0] else 0.0


def followed(
    model: Callable[[np.ndarray, np.ndarray], np.ndarray], rows: np.ndarray, lag: float
) -> float:
    """The lag [s] of rows [N], by which `model` of (obs [N, o], u [N, m]) predicts best.

    It is the `lag` of before unless another one is better by SURE standard errors.
    """
    obs, after = rows["obs"], rows["next_obs"]
    period, scale = float(np.median(rows["interval"])), (after - obs).std(0) + 1e-9

    def errors(lag: float) -> np.ndarray:
        u = acted(rows["sent"], rows["times"], rows["interval"], lag)
        left = (after - np.asarray(model(obs, u.astype(np.float32)))) / scale
        return np.log1p((left**2).sum(-1))  # of each row, an impact weighs little

    tried = np.arange((rows["sent"].shape[1] - 2) * COARSE + 1) / COARSE * period
    each = np.array([errors(other) for other in tried])
    best = each.mean(-1).argmin()
    gain = errors(lag) - each[best]
    sure = gain.mean() > SURE * gain.std() / np.sqrt(len(gain))
    return float(tried[best]) if sure else lag


def known_lag(env: Robot, folder: Path) -> float | None:
    """The lag [s] of actions after they were sent: given, or published; None: neither."""
    found = handover.latest(folder / "lag", np.float64(0))
    return env.lag if env.lag is not None or found is None else float(found[1])


def publish(folder: Path, lag: float) -> None:
    """Let `known_lag` give this lag [s] from now on."""
    handover.publish(folder / "lag", np.float64(lag), 0)
