"""Commands that make a robot show its parameters, within its limits.

    fisher   maximise log det (I + I_0) over knots of the commands, I the Fisher information of the
             positions about z (`information`), I_0 that of the ranges: by cross-entropy search,
             one second after the other, from the best of some signals; that one if it stays best
    sines, chirp, steps, babble    the largest amplitude that the limits allow

All of them begin at rest. The nominal model stays within `limits` times each limit, and DRAWS
models of the ranges within EDGE of it: what is within its limits here may not be on the robot.

Source: Fedorov 1972, "Theory of optimal experiments" (the criterion D).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from hybrid_rl import UsageError
from hybrid_rl.tools.identify.information import (
    Weak,
    columns,
    covariance,
    jacobian,
    mismatch,
    weak,
    widths,
)
from hybrid_rl.tools.identify.simulation import SECANT, Motion, measured, simulate, start
from hybrid_rl.tools.identify.system import System

DT = 0.01  # [s] between commands
KNOT = 0.1  # [s] between knots of the search
COARSE = 0.2  # [s] between random knots
WIDE = 0.75  # std of the first candidates, in amplitudes of the largest babble
SEGMENT, TAIL = 1.0, 0.3  # [s] that are searched together, and then to rest within the limits
CANDIDATES, ROUNDS, KEPT = 24, 6, 6  # of the search in each segment
SHARES = (0.5, 0.75, 1.0, 1.25)  # of the amplitude of the largest babble: of signals it compares
DRAWS = 32  # models of the ranges that keep the limits, too; a quarter of them during the search
EDGE = 0.95  # of a limit, for them
WORST = 0.2  # mismatch of derivatives from which a candidate is not believed
Signal = Callable[[np.ndarray, int, np.random.Generator], np.ndarray]  # t [K], nu -> [K, nu]


@dataclass(frozen=True)
class Plan:
    """Commands, and what the nominal model does."""

    t: np.ndarray  # [K]
    ctrl: np.ndarray  # [K, nu]
    q: np.ndarray  # [K, nq]
    deviations: np.ndarray  # [P] std of each coordinate that a log of it will leave
    weak: list[Weak]
    mismatch: float  # of the derivatives; above WORST they are not to be believed
    reach: float  # the largest share of a limit that the nominal model uses

    def write(self, out: str | Path) -> None:
        """Write it to a file, out.npz."""
        np.savez(out, t=self.t, ctrl=self.ctrl, q=self.q)


def _sines(t: np.ndarray, nu: int, random: np.random.Generator) -> np.ndarray:
    f, phase = random.uniform(0.2, 2.5, (2, 5, nu)) * [[[1.0]], [[2.5]]]
    return np.sin(2 * np.pi * f * t[:, None, None] + phase).sum(1) / 5


def _chirp(t: np.ndarray, nu: int, random: np.random.Generator) -> np.ndarray:
    last, phase = random.uniform(2.0, 4.0, nu), random.uniform(0, 2 * np.pi, nu)
    cycles = 0.2 * t[:, None] + (last - 0.2) / 2 * t[:, None] ** 2 / t[-1]
    return np.sin(2 * np.pi * cycles + phase)


def _steps(t: np.ndarray, nu: int, random: np.random.Generator) -> np.ndarray:
    held = random.uniform(-1, 1, (len(t), nu))
    begins = [np.cumsum(random.uniform(0.2, 0.6, len(t))) for _ in range(nu)]
    return np.stack([held[np.searchsorted(begins[j], t), j] for j in range(nu)], axis=1)


def _babble(t: np.ndarray, nu: int, random: np.random.Generator) -> np.ndarray:
    knots = np.arange(0, t[-1] + 2 * COARSE, COARSE)
    values = random.uniform(-1, 1, (len(knots), nu))
    return np.stack([np.interp(t, knots, column) for column in values.T], axis=1)


SIGNALS: dict[str, Signal] = {"sines": _sines, "chirp": _chirp, "steps": _steps, "babble": _babble}


def excite(
    system: System, how: str = "fisher", seconds: float = 4.0, limits: float = 0.8, seed: int = 0
) -> Plan:
    """A plan of `seconds`; how: fisher, sines, chirp, steps or babble.

    Raises:
        UsageError: if the robot leaves its limits even at rest.
    """
    search = _Search(system, limits, seed)
    t = DT * np.arange(round(seconds / DT))
    ctrl = search.plan(t) if how == "fisher" else search.signal(how, t)
    share = search.largest(t, ctrl)
    return search.judged(t, search.rest + share * ctrl)


class _Search:
    """Limits and information of commands, as differences from those at rest."""

    def __init__(self, system: System, limits: float, seed: int) -> None:
        self.system, self.limits, self.random = system, limits, np.random.default_rng(seed)
        self.first, self.rest = start(system)
        model = system.base
        given = model.actuator_ctrllimited.astype(bool)
        self.low = np.where(given, model.actuator_ctrlrange[:, 0], -1.0)
        self.high = np.where(given, model.actuator_ctrlrange[:, 1], 1.0)
        self.half = self.unit = np.maximum(self.high - self.rest, self.rest - self.low)
        self.models, self.delays = columns(system, system.nominal)
        self.tested = len(self.models)  # the rest are draws
        drawn = system.draw(DRAWS, seed=1)
        self.drawn = [system.model(theta) for theta in drawn]
        self.drawn_delays = [system.delay(theta) for theta in drawn]
        moving = [i for i in range(model.njnt) if model.jnt_type[i] > 1]  # slide or hinge
        self.at_q = 1 + model.jnt_qposadr[moving]
        self.at_v = 1 + model.nq + model.jnt_dofadr[moving]
        self.bounds = system.bounds[:, model.jnt_dofadr[moving]]

    def used(self, x: np.ndarray) -> np.ndarray:
        """[...] the largest share of a limit in states x [..., S, nstate]."""
        low, high, speed = self.bounds
        q, v = x[..., self.at_q], x[..., self.at_v]
        with np.errstate(invalid="ignore"):
            middle = np.where(np.isfinite(low + high), (low + high) / 2, 0.0)
            share = np.maximum(abs(q - middle) / ((high - low) / 2), abs(v) / speed)
        share = np.where(np.isnan(share), np.inf, share)  # it has diverged
        return share.max((-1, -2), initial=0.0)

    def motion(self, t: np.ndarray, ctrl: np.ndarray, begin: float = 0.0) -> Motion:
        """The motion by commands `rest + ctrl` from `begin` to the end of t."""
        steps = int(np.ceil((t[-1] + DT - begin) / self.system.base.opt.timestep))
        u = np.clip(self.rest + ctrl, self.low, self.high)
        return Motion(t, u, self.first, begin, steps)

    def keeps(self, t: np.ndarray, ctrl: np.ndarray) -> bool:
        """Whether the nominal model and all draws stay within their limits."""
        models = [self.models[0], *self.drawn]
        x, _ = simulate(models, [self.delays[0], *self.drawn_delays], [self.motion(t, ctrl)])
        share = self.used(x)
        return bool(share[0] <= self.limits and share[1:].max() <= max(self.limits, EDGE))

    def largest(self, t: np.ndarray, ctrl: np.ndarray) -> float:
        """The largest factor up to 1 on commands that keeps the limits."""
        if self.keeps(t, ctrl):
            return 1.0
        if not self.keeps(t, 0 * ctrl):
            raise UsageError(f"limits={self.limits:g}: the robot is beyond them at rest")
        low, high = 0.0, 1.0
        for _ in range(7):
            middle = (low + high) / 2
            low, high = (middle, high) if self.keeps(t, middle * ctrl) else (low, middle)
        return low

    def judged(self, t: np.ndarray, u: np.ndarray) -> Plan:
        """What commands u [K, nu] will show."""
        motion, system = self.motion(t, u - self.rest), self.system
        x, sensors = simulate(self.models[:1], self.delays[:1], [motion])
        q = measured(system, x, sensors, 0.0, t)[0]
        J, others = jacobian(system, system.nominal, motion, t)
        forces = J.T @ J / system.noise**2
        return Plan(
            t,
            motion.ctrl,
            q[:, : system.base.nq],
            np.sqrt(np.diag(covariance(system, forces))),
            weak(system, forces),
            float(mismatch(system, J, others)),
            float(self.used(x)[0]),
        )

    def signal(self, how: str, t: np.ndarray) -> np.ndarray:
        """[K, nu] a signal of the largest amplitude, from rest, less the commands at rest."""
        ramp = np.clip(t / COARSE, 0, 1)[:, None]
        return self.half * ramp * SIGNALS[how](t, self.system.base.nu, self.random)

    def plan(self, t: np.ndarray) -> np.ndarray:
        """[K, nu] the most informative commands, less those at rest."""
        models = [*self.models, *self.drawn[: DRAWS // 4]]
        delays = [*self.delays, *self.drawn_delays[: DRAWS // 4]]
        firsts = np.stack([self.first] * len(models))
        known = np.diag(1 / widths(self.system) ** 2)
        scored = partial(self._scored, models, delays)
        largest = self.largest(t, self.signal("babble", t))
        self.unit = largest * self.half
        base, best, score = np.zeros((len(t), self.system.base.nu)), -np.inf, -np.inf
        for how in SIGNALS:
            paths = [share * largest * self.signal(how, t) for share in SHARES for _ in range(2)]
            scores, _, _ = scored(t, paths, firsts, known)
            if scores.max() > best:
                base, best = paths[int(np.argmax(scores))], scores.max()
        done = np.zeros_like(base[:0])
        while len(done) < len(t):
            now = t[len(done) : len(done) + round(SEGMENT / DT)]
            done, firsts, gain, score = self._segment(scored, now, base, done, firsts, known)
            known = known + gain
        return done if score > best else base

    def _segment(
        self,
        scored: Callable[..., tuple[np.ndarray, np.ndarray, np.ndarray]],
        now: np.ndarray,
        base: np.ndarray,
        done: np.ndarray,
        firsts: np.ndarray,
        known: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
        """`done` with the best commands for the times `now`; last states, information, score."""
        last = done[-1] if len(done) else np.zeros_like(self.half)
        knots = max(round(len(now) * DT / KNOT), 1)
        at = len(done) + np.arange(1, knots + 1) * len(now) // knots - 1
        mean, std = base[at], WIDE * np.tile(self.unit, (knots, 1))
        best: Any = (None, None, None, -np.inf)
        ends_at = np.clip(1 - KNOT * np.arange(1, knots + 1) / TAIL, 0, 1)
        tops = [mean, ends_at[:, None] * last]
        for _ in range(ROUNDS):
            noise = self.random.normal(size=(CANDIDATES - len(tops), knots, len(self.half)))
            each = np.concatenate((tops, mean + std * noise))
            each = np.clip(each, self.low - self.rest, self.high - self.rest)
            paths = [np.concatenate((done, self._between(last, k, len(now)))) for k in each]
            scores, ends, gains = scored(now, paths, firsts, known)
            order = np.argsort(-scores)
            kept, top = each[order[:KEPT]], order[0]
            mean, std = kept.mean(0), kept.std(0) + 0.02 * self.unit
            if scores[top] > best[-1]:
                best, tops = (paths[top], ends[:, top], gains[top], scores[top]), [each[top]]
        return best

    def _between(self, last: np.ndarray, knots: np.ndarray, count: int) -> np.ndarray:
        """[count, nu] commands by straight lines from `last` through knots [k, nu]."""
        at = np.linspace(0, count, len(knots) + 1)
        all_ = np.concatenate((last[None], knots))
        return np.stack([np.interp(1 + np.arange(count), at, c) for c in all_.T], axis=1)

    def _scored(
        self,
        models: list,
        delays: list[float],
        now: np.ndarray,
        paths: list[np.ndarray],
        firsts: np.ndarray,
        known: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Scores [C], last states [M, C, nstate] and informations [C, P, P] of commands."""
        system, P = self.system, self.system.size
        tail = np.linspace(1, 0, round(TAIL / DT))[:, None]
        whole = [np.concatenate((path, tail * path[-1])) for path in paths]
        t = DT * np.arange(len(whole[0]))
        motions = [self.motion(t, path, now[0]) for path in whole]
        last = round(len(now) * DT / system.base.opt.timestep)
        begins = np.repeat(firsts[:, None], len(paths), axis=1)
        x, sensors = simulate(models, delays, motions, begins)
        x, sensors = (a.reshape(len(models), len(paths), *a.shape[1:]) for a in (x, sensors))
        tested = self.tested
        y = measured(system, x[:tested], sensors[:tested], now[0], now + DT)
        y = y.reshape(*y.shape[:2], -1)  # [1 + P + 1, C, N]
        J = np.moveaxis((y[1:] - y[0]) / SECANT, 0, -1)  # [C, N, P + 1]
        wrong = mismatch(system, J[..., :P], J[..., P])
        J = np.nan_to_num(J[..., :P]) / system.noise
        gains = J.swapaxes(1, 2) @ J
        scores = np.linalg.slogdet(known + gains)[1]
        share = self.used(x)
        over = np.maximum(share[0] - self.limits, 0)
        over += np.maximum(share[tested:].max(0) - max(self.limits, EDGE), 0)
        scores -= 1e3 * np.minimum(over, 1e3) + 1e3 * (over > 0) + 1e2 * (wrong > WORST)
        return scores, x[:, :, last], gains
