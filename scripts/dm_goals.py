"""dm_control's cheetah, walker and hopper, and TD-MPC2's new tasks for them as goals.

    export PYTHONPATH=scripts
    echo "_target_: dm_goals.CheetahBackwards" > my_conf/reward/backwards.yaml
    python -m hybrid_rl.train task=gymnasium env.make=dm_goals:cheetah episode.steps=500 \
        episode.action_repeat=2 random_steps=1000
    python -m hybrid_rl.evaluate run=DIR config_dir=my_conf reward=backwards
    python -m hybrid_rl.train run=DIR config_dir=my_conf reward=backwards total_steps=10000

Observations are dm_control's, and what the goals need of the physics. A decision has two steps, and
a goal pays twice what the second of them earns. Sources: Tassa et al. 2018, "DeepMind Control
Suite"; the tasks of Hansen et al. 2024, "TD-MPC2: scalable, robust world models for continuous
control".
"""

from collections.abc import Callable
from typing import Any

import gymnasium
import jax.numpy as jnp
import numpy as np
from dm_control import suite  # pyright: ignore[reportMissingImports]
from jax import Array
from shimmy.dm_control_compatibility import (  # pyright: ignore[reportMissingImports]
    DmControlCompatibilityV0,
)

from hybrid_rl import part

Measured = Callable[[Any], list[float]]


class Seen(gymnasium.ObservationWrapper):
    """A task's observations, flat, and what `measured` gives of the physics."""

    def __init__(self, domain: str, task: str, measured: Measured) -> None:
        made = DmControlCompatibilityV0(suite.load(domain, task))
        flat = gymnasium.wrappers.FlattenObservation(made)
        super().__init__(flat)
        self._physics, self._measured = made.unwrapped._env.physics, measured
        size = gymnasium.spaces.flatdim(flat.observation_space) + len(measured(self._physics))
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (size,))

    def observation(self, obs: np.ndarray) -> np.ndarray:
        """The observation of this step."""
        return np.concatenate([obs, self._measured(self._physics)])


def cheetah() -> Seen:
    """Its speed [m/s], heights of torso and feet [m] come last."""
    parts = ["torso", "bfoot", "ffoot"]
    return Seen("cheetah", "run", lambda p: [p.speed(), *p.named.data.xpos[parts, "z"]])


def walker() -> Seen:
    """Its speed [m/s], height [m] and the torso's cosine come last."""
    seen = ("horizontal_velocity", "torso_height", "torso_upright")
    return Seen("walker", "run", lambda p: [getattr(p, name)() for name in seen])


def hopper() -> Seen:
    """Its speed [m/s] and height [m] come last."""
    return Seen("hopper", "hop", lambda p: [p.speed(), p.height()])


def linear(x: Array, bound: float, margin: float, at_margin: float = 0.0) -> Array:
    """1 where x >= bound, down to `at_margin` at bound - margin, and on to 0."""
    return jnp.clip(1 - (1 - at_margin) * (bound - x) / margin, 0, 1)


def gaussian(x: Array, bound: float, margin: float) -> Array:
    """1 where x >= bound, 0.1 at bound - margin."""
    return jnp.exp(-jnp.log(10.0) * (jnp.maximum(bound - x, 0) / margin) ** 2)


@part
class CheetahBackwards:
    """cheetah-run-backwards."""

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """Of the speed."""
        return 2 * linear(-after[-4], 8.0, 8.0)


@part
class CheetahJump:
    """cheetah-jump."""

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """Of heights, and of standing still."""
        speed, torso, *feet = after[-4:]
        still = linear(-jnp.abs(speed), -0.5, 0.5)
        one, other = ((5 * gaussian((torso + z) / 2, 1.2, 0.6) + still) / 6 for z in feet)
        return one + other


@part
class WalkerBackwards:
    """walker-run-backwards."""

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """Of the speed, and of standing upright."""
        speed, height, upright = after[-3:]
        stand = (3 * gaussian(height, 1.2, 0.6) + (1 + upright) / 2) / 4
        return 2 * stand * (5 * linear(-speed, 8.0, 4.0, 0.5) + 1) / 6


@part
class HopperBackwards:
    """hopper-hop-backwards."""

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """Of the speed, where it stands."""
        speed, height = after[-2:]
        return 2 * linear(-speed, 1.0, 0.5, 0.5) * ((height >= 0.6) & (height <= 2))

    def smoothed(self, x: Array, u: Array, after: Array) -> Array:
        """The same with a slope below the height of standing."""
        return 2 * gaussian(after[-1], 0.6, 0.1) * linear(-after[-2], 1.0, 0.5, 0.5)
