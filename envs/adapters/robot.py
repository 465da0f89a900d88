"""A robot, or a simulator that does not wait: what a class of the user's must have, and its part.

    class Arm:
        dt = 0.05                           # [s] between decisions
        low, high = [-1.0], [1.0]           # of the actions
        obs = 4                             # numbers in an observation
        safe = [0.0]                        # the action at which nothing happens; else the middle

        def reset(self): ...                # go to a start; may take seconds
        def observe(self): ...              # newest observation [obs], and its time.monotonic()
        def apply(self, action): ...        # send an action; must return at once
        def reward(self, obs, action, next_obs): ...   # -> number
        def terminated(self, obs): ...      # whether the episode has failed; may be left out
        def stop(self): ...                 # end motion; must not raise

A process of its own calls these methods, one at a time, but for `stop`, which it may also call from
a second thread when another method does not return.
"""

from functools import cached_property
from typing import Any

import numpy as np

from hybrid_rl.envs.adapters.unstepped import Made, Unstepped, import_named
from hybrid_rl.errors import FAULTS, UsageError, blame
from hybrid_rl.fields import Count, NotNegative, Positive, part
from hybrid_rl.types import Spec

PENDING = 8  # actions at most that are sent and have not acted yet


@part
class Outside(Unstepped):
    """A world that the caller steps: an observation of `obs` numbers, `act` of an action."""

    obs: Count = 1
    act: Count = 1
    dt: Positive = 0.05  # [s] between decisions

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        return Spec(self.obs, self.act, self.dt)


@part
class Robot(Made):
    """A robot that learns while it moves. Its sizes are read from its class, without making one."""

    lag: NotNegative | None = None  # [s] from sending an action until it acts; None: is estimated
    rate: Positive | None = None  # greatest change of an action from one decision to the next, of 2
    stale: Positive = 2.0  # periods by which an observation may be older than usual
    silence_s: Positive = 1.0  # [s] without an observation, or in a method, until motion is ended
    alone_s: Positive = 30.0  # [s] that the robot goes on without its learner
    handover_s: Positive = 0.2  # [s] between two sets of parameters that the robot gets

    def __post_init__(self) -> None:
        super().__post_init__()
        _ = self.spec, self.safe

    @cached_property
    def kind(self) -> Any:
        """The user's class."""
        if not self.make:
            raise UsageError("env.make: give MODULE:CLASS of your robot")
        kind = import_named(self.make)
        needed = "reset", "observe", "apply", "reward", "stop", "dt", "low", "high", "obs"
        if missing := {*needed} - {*dir(kind)}:
            raise UsageError(f"env.make={self.name}: lacks {', '.join(sorted(missing))}")
        return kind

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        low, high = self.bounds
        if low.shape != high.shape or not (low.size and (low < high).all()):
            raise UsageError(f"env.make={self.name}: low and high must be lists with low < high")
        dt, obs = (float(self._numbers(name, 0)) for name in ("dt", "obs"))
        if not (dt > 0 and obs > 0 and obs.is_integer()):
            line = "dt and obs must be above 0, and obs a whole number"
            raise UsageError(f"env.make={self.name}: {line}")
        return Spec(int(obs), len(low), dt)

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The least and the greatest action [m], in the robot's units."""
        low, high = (self._numbers(name, 1).astype(np.float32) for name in ("low", "high"))
        return low, high

    @property
    def safe(self) -> np.ndarray:
        """The safe action [m], from -1 to 1."""
        low, high = self.bounds
        middle = (low + high) / 2
        given = getattr(self.kind, "safe", None)
        given = middle if given is None else self._numbers("safe", np.ndim(given))
        if given.shape not in ((), low.shape):
            raise UsageError(f"env.make={self.name}: safe must be one number, or as many as low")
        return np.clip(2 * (given - low) / (high - low) - 1, -1, 1).astype(np.float32)

    def _numbers(self, name: str, axes: int) -> np.ndarray:
        """A field of the class as finite numbers with `axes` axes; UsageError for others."""
        value = getattr(self.kind, name)
        try:
            numbers = np.asarray(value, float)
        except (TypeError, ValueError):  # words, a property
            numbers = np.full(1, np.nan)
        if not np.isfinite(numbers).all() or numbers.ndim != axes:
            must = "finite numbers" if axes else "one finite number"
            raise UsageError(f"env.make={self.name}: {name}={value}: must be {must}")
        return numbers

    def made(self) -> Any:
        """The robot."""
        try:
            return self.kind(**(self.kwargs or {}))
        except FAULTS as error:
            line = blame(error)
            raise UsageError(f"env.make={self.name}: {line}") from error
