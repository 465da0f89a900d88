"""Why a swimmer stops: planners on its true physics, and noise from both joints' limits.

    python -m scripts.swimmer_causes out=swimmer_causes.json

horizon: return over 1,000 decisions of the cross-entropy method on MuJoCo C, without a critic, by
its horizon. curled: what constant torques earn in 1,000 decisions, and in how many of them no joint
moves; then the largest change of a joint [rad] within 1.6 s, over 300 draws of noise around these
torques, by its standard deviation and the time [s] for which it is held. bursts: the same share,
where uniform torques, held for 0.4 s on average, replace the constant ones so many times a second.
"""

import json
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from mujoco.rollout import Rollout

from hybrid_rl.cli.arguments import Argument, read
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.swimmer import Swimmer

FULL = mujoco.mjtState.mjSTATE_FULLPHYSICS
STEPS, DT = Swimmer.steps, Swimmer.dt
SEEDS = (200, 201)
STILL = 0.05  # [rad/s] below which a joint does not move
CURL = np.ones(2)  # torques that press both joints against their limits
BURST = 0.4  # [s] mean length


class World:
    """A swimmer in MuJoCo C."""

    def __init__(self, seed: int) -> None:
        self.model, self.rng = mjcf.load("swimmer.xml"), np.random.default_rng(seed)
        self.data, self.pool = mujoco.MjData(self.model), Rollout(nthread=1)
        self.data.qpos[:] = self.rng.uniform(-0.1, 0.1, self.model.nq)
        self.began = self.data.qpos[0]

    def step(self, u: np.ndarray) -> None:
        """A decision with torques u [2]."""
        self.data.ctrl[:] = u
        mujoco.mj_step(self.model, self.data, STEPS)

    def earned(self) -> float:
        """The return so far, without the cost of torques."""
        return (self.data.qpos[0] - self.began) / DT

    def imagined(self, u: np.ndarray) -> np.ndarray:
        """qpos [K, T, nq] after each decision of plans u [K, T, 2] from here."""
        now = np.zeros(mujoco.mj_stateSize(self.model, FULL))
        mujoco.mj_getState(self.model, self.data, now, FULL)
        start, control = np.tile(now, (len(u), 1)), np.repeat(np.clip(u, -1, 1), STEPS, 1)
        states: Any = self.pool.rollout(self.model, [self.data], start, control)[0]
        return states[:, STEPS - 1 :: STEPS, 1 : 1 + self.model.nq]


def planned(horizon: int, hold: int, seed: int, decisions: int = 250) -> float:
    """The return in 1,000 decisions of plans of `horizon` decisions, each action for `hold`."""
    world, mean = World(seed), np.zeros((horizon // hold, 2))
    for t in range(decisions):
        if t % hold == 0:
            mean = np.concatenate([mean[1:], np.zeros((1, 2))])
        spread = np.full_like(mean, 0.8)
        for _ in range(2):
            plans = np.clip(mean + spread * world.rng.normal(size=(48, *mean.shape)), -1, 1)
            ends = world.imagined(np.repeat(plans, hold, 1))[:, -1, 0]
            elite = plans[np.argsort(-ends)[:8]]
            mean, spread = elite.mean(0), elite.std(0) + 0.05
        world.step(mean[0])
    return world.earned() * 1000 / decisions


def coloured(rng: np.random.Generator, held: float, shape: tuple[int, ...]) -> np.ndarray:
    """Noise [K, T, 2] of unit variance whose correlation falls as exp(-t / held)."""
    c, e = np.exp(-DT / held) if held else 0.0, rng.normal(size=shape)
    for t in range(1, shape[1]):
        e[:, t] = c * e[:, t - 1] + np.sqrt(1 - c**2) * e[:, t]
    return e


def moved(std: float, held: float, seed: int) -> float:
    """The largest change of a joint [rad] within 40 decisions, mean over 300 draws of noise."""
    world = World(seed)
    for _ in range(150):
        world.step(CURL)
    joints = world.imagined(CURL + std * coloured(world.rng, held, (300, 40, 2)))[:, :, 3:]
    return float(np.abs(joints - world.data.qpos[3:]).max((1, 2)).mean())


def interrupted(rate: float, seed: int) -> tuple[float, float]:
    """The return, and the share of decisions without motion, of bursts `rate` times a second."""
    world, u, active, still = World(seed), CURL, False, 0
    for _ in range(1000):
        if world.rng.random() < (DT / BURST if active else rate * DT):
            active = not active
            u = world.rng.uniform(-1, 1, 2) if active else CURL
        world.step(u)
        still += np.abs(world.data.qvel[3:]).max() < STILL
    return world.earned(), still / 1000


def main() -> None:
    """The command."""
    given, _ = read(__doc__, (Argument("out", "swimmer_causes.json", "the numbers"),))
    found: dict[str, Any] = {"seeds": SEEDS, "horizon": {}, "curled": {}, "bursts": {}}
    for std in (0.1, 0.3, 0.7):
        for held in (0.0, 0.2, 0.4, 0.8):
            each = [round(moved(std, held, seed), 3) for seed in SEEDS]
            found["curled"][f"noise {std}, held {held} s"] = each
    for rate in (0.0, 0.1, 0.5, 2.0):
        pairs = np.round([interrupted(rate, seed) for seed in SEEDS], 2)
        found["bursts"][f"{rate} a second"] = dict(
            zip(("return", "still"), pairs.T.tolist(), strict=True)
        )
    for horizon, hold in ((5, 1), (10, 1), (20, 2)):
        each = [round(planned(horizon, hold, seed), 1) for seed in SEEDS]
        found["horizon"][f"{horizon * DT:.1f} s"] = each
    Path(given["out"]).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
