"""A robot that counts, and moves in this process; a controller that counts."""

import time
from dataclasses import dataclass, replace
from typing import ClassVar

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.outside.actor import Actor
from hybrid_rl.outside.row_log import RowLog

LINE = ["task=robot", "env.make=hybrid_rl.envs.adapters.stand_in:Cartpole", "algo=sac"]
LINE += ["policy.hidden=[8]", "critic.hidden=[8]", "policy_learner.batch_size=4", "total_steps=200"]
LINE += ["random_steps=0", "episode.steps=10", "log_every=20"]


class Counting:
    """A robot whose observation is (episode, step, 0, 0); `fault` at step 4 of episode 2."""

    dt, low, high, obs = 0.004, (0.0,), (2.0,), 4
    safe = (0.5,)
    faults: ClassVar[dict] = {}

    def __init__(self) -> None:
        self.episode, self.count, self.applied, self.stopped = 0, 0, [], 0

    def reset(self) -> None:
        self.episode, self.count = self.episode + 1, 0

    def observe(self) -> tuple:
        self.count += 1
        obs = np.array([self.episode, self.count, 0.0, 0.0])
        fault = self.faults.get((self.episode, self.count), lambda obs: (obs, time.monotonic()))
        return fault(obs)

    def apply(self, action: np.ndarray) -> None:
        self.applied.append(float(action[0]))

    def reward(self, obs: np.ndarray, action: np.ndarray, next_obs: np.ndarray) -> float:
        return float(next_obs[1])

    def terminated(self, obs: np.ndarray) -> bool:
        return self.episode == 3 and obs[1] > 5

    def stop(self) -> None:
        self.stopped += 1


@dataclass(frozen=True)
class Rising:
    """A controller that acts by the number of its decisions in this episode."""

    first: float
    more: float

    def init(self, spec):
        return jnp.full(spec.act, self.first)

    def act(self, params, state, obs, key):
        return state, state + self.more, {}

    def greedy(self):
        return self


def of(agent, kind, **fields):
    """The agent on another robot."""
    return replace(agent, episode=replace(agent.episode, env=Robot(make=kind, **fields)))


def moved(agent, folder, kind, **fields):
    """(actor, its rows) after it moved through five episodes with the first parameters."""

    def reset(robot):
        actor.asked = robot.episode == 5
        kind.reset(robot)

    agent = of(agent, type(kind.__name__, (kind,), {"reset": reset}), **fields)
    actor = Actor(agent, folder, params=agent.params(agent.init(jax.random.key(0))))
    actor.run(seconds=20)
    rows, log = [], RowLog(folder / "rows", agent.spec)
    while (row := log.read(len(rows))) is not None:
        rows.append(row)
    return actor, rows


def broken(fault):
    """A class of robots with a fault."""
    return type("Broken", (Counting,), {"faults": {(2, 4): fault}})


def lost(obs):
    """A connection that is lost."""
    raise ConnectionError("no datagram")
