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

import math
from functools import cached_property
from typing import Annotated, Any

import numpy as np

from hybrid_rl.envs.adapters.unstepped import Made, Unstepped, import_named
from hybrid_rl.errors import FAULTS, UsageError, blame
from hybrid_rl.fields import Count, FieldError, Must, NotNegative, Positive, check_span, part
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
class Form:
    """The fields of the class of a robot."""

    obs: Count
    dt: Annotated[float, Must(lambda x: 0 < x < math.inf, "be above 0 and finite")]  # [s]
    low: tuple[float, ...]
    high: tuple[float, ...]
    safe: tuple[float, ...] | Annotated[float, Must(math.isfinite, "be finite")] | None

    def __post_init__(self) -> None:
        check_span(self)
        if isinstance(self.safe, tuple) and len(self.safe) != len(self.low):
            raise FieldError(self, "safe", "must be one number, or as many as low")


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
        _ = self.form

    @cached_property
    def kind(self) -> Any:
        """The user's class."""
        return import_named(self.make)

    @cached_property
    def form(self) -> Form:
        """What its class says."""
        needed = {"reset", "observe", "apply", "reward", "stop", *Form.__match_args__} - {"safe"}
        if missing := needed - {*dir(self.kind)}:
            raise UsageError(f"env.make={self.name}: lacks {', '.join(sorted(missing))}")
        try:
            given: Any = (getattr(self.kind, name, None) for name in Form.__match_args__)
            return Form(*given)
        except FieldError as error:
            raise UsageError(f"env.make={self.name}: {error.line}") from error

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        return Spec(int(self.form.obs), len(self.form.low), float(self.form.dt))

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The least and the greatest action [m], in the robot's units."""
        return np.array(self.form.low, np.float32), np.array(self.form.high, np.float32)

    @property
    def safe(self) -> np.ndarray:
        """The safe action [m], from -1 to 1."""
        low, high = self.bounds
        given = (low + high) / 2 if self.form.safe is None else np.array(self.form.safe)
        return np.clip(2 * (given - low) / (high - low) - 1, -1, 1).astype(np.float32)

    def made(self) -> Any:
        """The robot."""
        try:
            return self.kind(**(self.kwargs or {}))
        except FAULTS as error:
            raise UsageError(f"env.make={self.name}: {blame(error)}") from error
