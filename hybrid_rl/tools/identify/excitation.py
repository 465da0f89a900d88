"""Commands that make a robot show its parameters, within its limits.

    sines, chirp, steps, babble    the largest amplitude that the limits allow
    fisher                         of TRIED such signals the one that maximises log det (I + I_0),
                                   I the Fisher information of the positions about z
                                   (`information`), I_0 that of the ranges

All of them begin at rest. The nominal model stays within `limits` times each limit, and DRAWS
models of the ranges within EDGE of it: what is within its limits here may not be on the robot.

Source: Fedorov 1972, "Theory of optimal experiments" (the criterion D).
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hybrid_rl import UsageError
from hybrid_rl.tools.identify.information import Weak, covariance, jacobian, weak
from hybrid_rl.tools.identify.simulation import Motion, measured, simulate, start
from hybrid_rl.tools.identify.system import System

DT = 0.01  # [s] between commands
COARSE = 0.2  # [s] between random knots
TRIED = 8  # signals
DRAWS = 32  # models of the ranges that keep the limits, too
EDGE = 0.95  # of a limit, for them
FINEST = 1 / 128  # of an amplitude
Signal = Callable[[np.ndarray, int, np.random.Generator], np.ndarray]  # t [K], nu -> [K, nu]


@dataclass(frozen=True)
class Plan:
    """Commands, and what the nominal model does."""

    t: np.ndarray  # [K]
    ctrl: np.ndarray  # [K, nu]
    q: np.ndarray  # [K, nq]
    deviations: np.ndarray  # [P] std of each coordinate that a log of it will leave
    weak: list[Weak]
    gained: float  # log det (I + I_0)
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
    system: System, how: str = "sines", seconds: float = 4.0, limits: float = 0.8, seed: int = 0
) -> Plan:
    """A plan of `seconds`; how: sines, chirp, steps, babble or fisher.

    Raises:
        UsageError: if the robot leaves its limits even at rest.
    """
    bounds, random = _Limits(system, limits), np.random.default_rng(seed)
    t = DT * np.arange(round(seconds / DT))
    ramp = np.clip(t / COARSE, 0, 1)[:, None]
    names = [*SIGNALS] * (TRIED // len(SIGNALS)) if how == "fisher" else [how]
    signals = [ramp * SIGNALS[name](t, system.base.nu, random) for name in names]
    plans = [bounds.plan(t, bounds.half * signal) for signal in signals]
    return max(plans, key=lambda plan: plan.gained)


class _Limits:
    """What models do by commands, which are differences from those at rest."""

    def __init__(self, system: System, limits: float) -> None:
        self.system, self.limits = system, limits
        self.first, self.rest = start(system)
        model = system.base
        given = model.actuator_ctrllimited.astype(bool)
        self.low = np.where(given, model.actuator_ctrlrange[:, 0], -1.0)
        self.high = np.where(given, model.actuator_ctrlrange[:, 1], 1.0)
        self.half = np.maximum(self.high - self.rest, self.rest - self.low)
        thetas = [system.nominal, *system.draw(DRAWS, seed=1)]
        self.models = [system.model(theta) for theta in thetas]
        self.delays = [system.delay(theta) for theta in thetas]

    def motion(self, t: np.ndarray, ctrl: np.ndarray) -> Motion:
        """The motion by these commands [K, nu]."""
        steps = int(np.ceil((t[-1] + DT) / self.system.base.opt.timestep))
        return Motion(t, np.clip(self.rest + ctrl, self.low, self.high), self.first, 0.0, steps)

    def used(self, t: np.ndarray, ctrl: np.ndarray) -> np.ndarray:
        """[1 + DRAWS] the largest share of a limit, the nominal model's first."""
        model = self.system.base
        x, _ = simulate(self.models, self.delays, [self.motion(t, ctrl)])
        moving = [i for i in range(model.njnt) if model.jnt_type[i] > 1]  # slide or hinge
        low, high, speed = self.system.bounds[:, model.jnt_dofadr[moving]]
        q = x[..., 1 + model.jnt_qposadr[moving]]
        v = x[..., 1 + model.nq + model.jnt_dofadr[moving]]
        with np.errstate(invalid="ignore"):
            middle = np.where(np.isfinite(low + high), (low + high) / 2, 0.0)
            share = np.maximum(abs(q - middle) / ((high - low) / 2), abs(v) / speed)
        share = np.where(np.isnan(share), np.inf, share)  # it has diverged
        return share.max((-1, -2), initial=0.0)

    def keeps(self, t: np.ndarray, ctrl: np.ndarray) -> bool:
        """Whether the nominal model and all draws stay within their limits."""
        own, *others = self.used(t, ctrl)
        return bool(own <= self.limits and max(others) <= max(self.limits, EDGE))

    def plan(self, t: np.ndarray, ctrl: np.ndarray) -> Plan:
        """The plan of the largest multiple of commands, up to 1, that keeps the limits."""
        if not self.keeps(t, 0 * ctrl):
            raise UsageError(f"limits={self.limits:g}: the robot is beyond them at rest")
        low, high = float(self.keeps(t, ctrl)), 1.0
        while high - low > FINEST:
            middle = (low + high) / 2
            low, high = (middle, high) if self.keeps(t, middle * ctrl) else (low, middle)
        motion, system = self.motion(t, low * ctrl), self.system
        x, sensors = simulate(self.models[:1], self.delays[:1], [motion])
        q = measured(system, x, sensors, 0.0, t)[0, :, : system.base.nq]
        J = jacobian(system, system.nominal, motion, t) / system.noise
        known = covariance(system, J.T @ J)
        return Plan(
            t,
            motion.ctrl,
            q,
            np.sqrt(np.diag(known)),
            weak(system, J.T @ J),
            -float(np.linalg.slogdet(known)[1]),
            float(self.used(t, low * ctrl)[0]),
        )
