"""Parameters from logs, by least squares on simulated positions (mujoco.sysid), with intervals.

    min over z, s   sum_t |(y_t - y(t; z, s)) / sigma|^2

s: state at the beginning of each window, so that neither noise nor a doubtful speed there counts.
Several starts of short windows come first, as long ones have local minima; the best go on with long
ones. sigma of each channel is that of what follows no pattern: r_t^2 - e^2, below.

A 95% interval is of the noise alone. The rest follows from what is left of the residuals without
noise, e^2 = mean r_t r_{t+k} over LAGS lags k: in the logs, and in a second one (`check`), which is
not fitted. If e^2 is above 99% of what noise and intervals make, the model does not explain the
logs. Then the intervals grow by the larger of two ratios: that of the second log's error to the
predicted one, and that of the distance between the parameters of the two logs, each fitted alone,
to what noise makes of it (Birge 1932, "The calculation of errors by the method of least squares").
"""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import mujoco
import numpy as np
from scipy.special import ndtri

from hybrid_rl import UsageError
from hybrid_rl.tools.identify.information import Weak, covariance, weak, without_scale
from hybrid_rl.tools.identify.log import Log
from hybrid_rl.tools.identify.simulation import (
    FINE,
    SECANT,
    Motion,
    measured,
    simulate,
    state,
)
from hybrid_rl.tools.identify.system import System

STARTS, SEARCHED, FINISHED = 6, 8, 2  # starts, iterations of each, and how many go on
SHORT, LONG = 1.0, 4.0  # [s] of windows
ITERATIONS, TOLERANCE = 30, 1e-4  # of the long windows; relative step that ends them
DAMPING = 5.0  # factor between dampings that are tried
NEAR = 0.06  # [s] of the log around a window's begin, for its first state
LAGS = 5  # rows over which residuals are correlated, but not their noise
OPEN = 10.0  # of the noise: unit of a position in s; of a speed it is that in 0.1 s
LOOSE = 0.1  # weight of s in its units: it is almost free
QUANTILE, LEVEL, DRAWS = 1.96, 0.99, 2000
INSTALL = 'mujoco.sysid is empty: pip install "hybrid_rl[identify]"'


@dataclass(frozen=True)
class Held:
    """What the logs say of the model, the second one above all."""

    error: float  # RMS of the positions without their noise [rad, m]
    nominal: float  # that of the nominal model
    expected: float  # that the intervals predict
    explained: bool
    widen: float  # factor on the intervals


@dataclass(frozen=True)
class Found:
    """Identified parameters theta [P]."""

    system: System
    theta: np.ndarray  # [P]
    std: np.ndarray  # [P] of the coordinates, by the noise alone
    weak: list[Weak]
    noise: np.ndarray  # [n] of each channel
    error: float  # as Held.error, of the logs themselves
    held: Held | None
    shown: list[tuple[Log, np.ndarray]]  # logs, the last one `check`, and simulated [T, n]

    def interval(self, widened: bool = True) -> np.ndarray:
        """[P, 2] the 95% intervals, within the ranges that were given."""
        factor = self.held.widen if self.held and widened else 1.0
        z, half = self.system.z(self.theta), QUANTILE * factor * self.std
        ends = self.system.theta(np.stack((z - half, z + half)))
        return np.clip(ends, self.system.low, self.system.high).T

    def ranges(self) -> dict[str, list[float]]:
        """Name -> [low, high] for `episode.randomise.elements` of the written model.

        Gains are factors on its own; the delay is none of them: episode.delay and jitter.
        """
        gains = np.array([name.endswith(".gain") for name in self.system.names])
        pairs = self.interval() / np.where(gains, self.theta, 1.0)[:, None]
        named = zip(self.system.names, pairs.tolist(), strict=True)
        return {name: pair for name, pair in named if name != "delay"}


@dataclass(frozen=True)
class Window:
    """Part of a log that is simulated at one go."""

    log: Log
    rows: slice
    first: np.ndarray  # [nstate] roughly
    t: np.ndarray  # [T] its times
    y: np.ndarray  # [T, n] what was measured


class Problem:
    """Residuals of logs, in windows of some seconds, over x = (z [P], s [S]) and their minimum."""

    def __init__(
        self, system: System, logs: Sequence[Log], seconds: float, sigma: np.ndarray
    ) -> None:
        self.system, self.logs, self.sigma = system, logs, sigma
        self.windows = [each for log in logs for each in _windows(system, log, seconds)]
        h = system.base.opt.timestep
        self.motions = [
            Motion(w.log.t, w.log.ctrl, w.first, w.t[0], int(np.ceil(np.ptp(w.t) / h)) + 2)
            for w in self.windows
        ]
        nv = system.base.nv
        unit = OPEN * np.median(sigma[: system.base.nq])
        self.units = np.concatenate((np.full(nv, unit), np.full(nv, unit / 0.1)))
        self.P, self.S = system.size, 2 * nv * len(self.windows)
        self.y = np.concatenate([(w.y / sigma).ravel() for w in self.windows])

    def simulated(self, z: np.ndarray, s: np.ndarray) -> list[np.ndarray]:
        """Of each window [B, T, n], for z [B, P] and s [B, W, 2 nv]."""
        system, made = self.system, {}
        for row in z:
            if row.tobytes() not in made:
                theta = system.theta(row)
                made[row.tobytes()] = system.model(theta), system.delay(theta)
        models, delays = zip(*(made[row.tobytes()] for row in z), strict=True)
        firsts = np.stack([[self._first(w, x) for w, x in enumerate(row)] for row in s])
        x, sensors = simulate(models, delays, self.motions, firsts)
        W = len(self.windows)
        return [
            measured(system, x[w::W], sensors[w::W], window.t[0], window.t)
            for w, window in enumerate(self.windows)
        ]

    def _first(self, w: int, s: np.ndarray) -> np.ndarray:
        """The first state of a window, moved by s [2 nv] in its units."""
        model, first = self.system.base, self.windows[w].first.copy()
        nq, nv = model.nq, model.nv
        qpos, moved = first[1 : 1 + nq].copy(), s * self.units
        mujoco.mj_integratePos(model, qpos, moved[:nv], 1.0)
        first[1 : 1 + nq] = qpos
        first[1 + nq : 1 + nq + nv] += moved[nv:]
        return first

    def residuals(self, x: np.ndarray) -> np.ndarray:
        """[B, N + S] for x [B, P + S]: of the log, and of s."""
        s = x[:, self.P :].reshape(len(x), len(self.windows), -1)
        y = self.simulated(x[:, : self.P], s)
        flat = np.concatenate([(each / self.sigma).reshape(len(x), -1) for each in y], axis=1)
        r = np.nan_to_num(flat - self.y, nan=1e4, posinf=1e4, neginf=-1e4)
        return np.concatenate((np.clip(r, -1e4, 1e4), LOOSE * x[:, self.P :]), axis=1)

    def jacobian(self, x: np.ndarray, step: float) -> np.ndarray:
        """[N + S, P + S] by central secants; all windows move their first states at once."""
        P, W = self.P, len(self.windows)
        each, z = self.S // W, range(P)
        moves = np.zeros((P + each, P + self.S))
        moves[z, z] = step
        for j in range(each):
            moves[P + j, P + j :: each] = 0.5
        up, down = x + moves, x - moves
        up[:, :P] = np.minimum(up[:, :P], self.system.z(self.system.high))
        down[:, :P] = np.maximum(down[:, :P], self.system.z(self.system.low))
        r = self.residuals(np.concatenate((up, down)))
        d = (r[: P + each] - r[P + each :]).T
        J = np.zeros((d.shape[0], P + self.S))
        J[:, :P] = d[:, :P] / (up - down)[z, z]
        ends = np.cumsum([0, *(w.y.size for w in self.windows)])
        for w in range(W):
            at = slice(ends[w], ends[w + 1])
            J[at, P + each * w : P + each * (w + 1)] = d[at, P:]
        J[len(self.y) + np.arange(self.S), P + np.arange(self.S)] = LOOSE
        return J

    def seen(self, x: np.ndarray) -> np.ndarray:
        """[N + S, P] the part of the derivatives by z that no choice of s would make."""
        J, s = self.jacobian(x, FINE), self.system.scale(self.system.theta(x[: self.P]))
        move = FINE * np.append(s, np.zeros(self.S))
        up, down = self.residuals(np.stack((x + move, x - move)))
        q = np.linalg.qr(J[:, self.P :])[0]
        J = without_scale(s, J[:, : self.P], (up - down) / (2 * FINE))
        return J - q @ (q.T @ J)

    def split(self, r: np.ndarray) -> list[np.ndarray]:
        """The residuals [N + S] of each window [T, n]."""
        ends = np.cumsum([w.y.size for w in self.windows])
        parts = np.split(r[: ends[-1]], ends[:-1])
        return [part.reshape(w.y.shape) for part, w in zip(parts, self.windows, strict=True)]

    def correlated(self, r: np.ndarray) -> np.ndarray:
        """[n] mean r_t r_{t+k}: the squared residuals without their noise, in units of sigma."""
        pairs = [(r[k:] * r[:-k]).mean(0) for r in self.split(r) for k in range(1, LAGS + 1)]
        return np.mean(pairs, axis=0)

    @property
    def chance(self) -> float:
        """Standard deviation of the mean of `correlated` if there is noise alone."""
        return 1 / np.sqrt(LAGS * len(self.y))

    def shown(self, r: np.ndarray) -> list[tuple[Log, np.ndarray]]:
        """Each log, and what was simulated [T, n] where the residuals were r [N + S]."""
        made = {id(log): np.zeros_like(log.y) for log in self.logs}
        for window, part in zip(self.windows, self.split(r), strict=True):
            made[id(window.log)][window.rows] = window.y + part * self.sigma
        return [(log, made[id(log)]) for log in self.logs]

    def solve(
        self, z: np.ndarray, step: float, most: int, fixed: bool = False
    ) -> tuple[np.ndarray, float]:
        """The minimum x [P + S] from z, and its cost; fixed: over the first states alone."""
        toolbox, system, P = sysid(), self.system, self.P
        low, high = system.z(system.low), system.z(system.high)
        edge = 2e-3 * (high - low)  # the toolbox warns of a start nearer to an end
        z = np.clip(z, low + edge, high - edge)
        unknown = toolbox.ParameterDict()
        for name, value, least, greatest in zip(system.names, z, low, high, strict=True):
            bounded = float(value), float(least), float(greatest)
            unknown.add(toolbox.Parameter(name, *bounded, frozen=fixed))
        s = np.zeros(self.S)
        unknown.add(toolbox.Parameter("first states", s, s - 1e3, s + 1e3))

        def whole(x: np.ndarray) -> np.ndarray:
            return np.concatenate((z, x.ravel())) if fixed else x.ravel()

        _, result = toolbox.optimize(
            unknown,
            lambda x, _: ([self.residuals(whole(x)[None]).T], None, None),
            verbose=False,
            max_iters=most,
            jacobian=lambda x, _: self.jacobian(whole(x), step)[:, P if fixed else 0 :],
            output=io.StringIO(),
            x_scale="jac",
            xtol=TOLERANCE,
            mu_factor=DAMPING,
        )
        x = whole(np.asarray(result.x, float))
        return x, float((self.residuals(x[None]) ** 2).sum())


def _windows(system: System, log: Log, seconds: float) -> list[Window]:
    """Windows of about `seconds`, of equal length."""
    count = max(round(np.ptp(log.t) / seconds), 1)
    edges = np.searchsorted(log.t, np.linspace(log.t[0], log.t[-1], count + 1))
    edges[-1] = len(log.t) - 1
    parts = [slice(a, b + 1) for a, b in pairwise(edges)]
    return [Window(log, at, _rough(system, log, at.start), log.t[at], log.y[at]) for at in parts]


def _rough(system: System, log: Log, row: int) -> np.ndarray:
    """The state [nstate] at a row, by a parabola through the positions around it."""
    s = log.t - log.t[row]
    near = abs(s) <= max(NEAR, 3 * np.median(np.diff(log.t)))
    powers = np.stack((np.ones(near.sum()), s[near], s[near] ** 2), axis=1)
    q, rate, _ = np.linalg.lstsq(powers, log.q[near], rcond=None)[0]
    qvel = np.zeros(system.base.nv)
    mujoco.mj_differentiatePos(system.base, qvel, 1e-3, q, q + 1e-3 * rate)
    return state(system.base, q, qvel)


def fit(
    system: System,
    logs: Sequence[Log],
    check: Log | None = None,
    starts: int = STARTS,
    seed: int = 0,
) -> Found:
    """Parameters that explain logs; check: another log, which says what to think of them.

    Raises:
        UsageError: without the extra `identify`.
    """
    nq, P = system.base.nq, system.size
    sensors = np.concatenate([log.y[:, nq:] for log in logs])
    sigma = np.concatenate((np.full(nq, system.noise), sensors.std(0)))
    short = Problem(system, logs, SHORT, sigma)
    begins = [system.nominal, *system.draw(max(starts - 1, 0), seed)]
    tried = [short.solve(system.z(theta), SECANT, SEARCHED) for theta in begins]
    best = sorted(tried, key=lambda each: each[1])[:FINISHED]
    for step in (SECANT, FINE):  # sigma of the first, too
        long = Problem(system, logs, LONG, sigma)
        ends = [long.solve(x[:P], step, ITERATIONS) for x, _ in best]
        best = [min(ends, key=lambda each: each[1])]
        x, _ = best[0]
        r = long.residuals(x[None])[0]
        squares = sum((part**2).sum(0) for part in long.split(r)) / (len(long.y) / len(sigma))
        sigma = sigma * np.sqrt(np.maximum(squares - long.correlated(r), 1e-12))
    final = Problem(system, logs, LONG, sigma)
    r, J = final.residuals(x[None])[0], final.seen(x)
    known, squares = covariance(system, J.T @ J), final.correlated(r)
    shown, held = final.shown(r), None
    if check is not None:
        problem = Problem(system, [check], LONG, sigma)
        own = bool(squares.mean() <= float(ndtri(LEVEL)) * final.chance)
        held, r = _held(problem, x[:P], known, own)
        shown += problem.shown(r)
    return Found(
        system,
        system.theta(x[:P]),
        np.sqrt(np.diag(known)),
        weak(system, J.T @ J),
        sigma,
        _rms(final, squares),
        held,
        shown,
    )


def _held(problem: Problem, z: np.ndarray, known: np.ndarray, own: bool) -> tuple[Held, np.ndarray]:
    """The verdict of another log, and its residuals.

    known [P, P]: covariance of z; own: whether the logs that were fitted are explained.
    """
    system, P = problem.system, problem.P
    x, _ = problem.solve(z, FINE, 8, fixed=True)
    other, _ = problem.solve(system.z(system.nominal), FINE, 8, fixed=True)
    r, nominal = problem.residuals(np.stack((x, other)))
    found, random = problem.correlated(r), np.random.default_rng(0)
    root = problem.seen(x)[: len(problem.y)] @ np.linalg.cholesky(known)  # [N, P]
    draws = ((root @ random.normal(size=(P, DRAWS))) ** 2).mean(0)
    predicted = draws + problem.chance * random.normal(size=DRAWS)
    explained, widen = bool(own and found.mean() <= np.quantile(predicted, LEVEL)), 1.0
    if not explained:
        alone, _ = problem.solve(z, FINE, ITERATIONS)
        J, apart = problem.seen(alone), z - alone[:P]
        birge = apart @ np.linalg.solve(known + covariance(system, J.T @ J), apart) / P
        widen = float(np.sqrt(max(1.0, found.mean() / draws.mean(), birge)))
    expected = _rms(problem, np.full(len(problem.sigma), draws.mean()))
    errors = _rms(problem, found), _rms(problem, problem.correlated(nominal))
    return Held(*errors, expected, explained, widen), r


def _rms(problem: Problem, squares: np.ndarray) -> float:
    """RMS error of the positions, of squares in units of sigma [n]."""
    n = problem.system.base.nq
    return float(np.sqrt(max((squares[:n] * problem.sigma[:n] ** 2).mean(), 0.0)))


def sysid() -> Any:
    """MuJoCo's toolbox, whose module is empty where a package that it needs is missing."""
    from mujoco import sysid as toolbox

    if getattr(toolbox, "optimize", None) is None:
        raise UsageError(INSTALL)
    return toolbox
