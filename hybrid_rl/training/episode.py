"""Episodes of an environment: time limit, action repeat, resets, and disturbances on request.

A controller sees o + sensor_noise N(0, I); environment, reward and constraint see o. Its action u
arrives `delay` decisions later, as clip(u + action_noise N(0, I)). An expert who is disturbed in
this way demonstrates how to return (Laskey et al. 2017, "DART: noise injection for robust imitation
learning"). With `randomise` each episode has another body (`envs/mujoco/randomised.py`).
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import partial
from numbers import Real
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core.batching import when_any, where
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.envs.mujoco.randomised import Ranges
from hybrid_rl.errors import UsageError
from hybrid_rl.fields import Count, FieldError, Natural, NotNegative, check
from hybrid_rl.protocols import Constraint, Env, Goal
from hybrid_rl.protocols.contract import Contract
from hybrid_rl.training.wrappers import put_around
from hybrid_rl.types import EnvState, Spec

# Environments always compute in full precision, networks perhaps with less on an accelerator.
EXACT = partial(jax.default_matmul_precision, "highest")
OWN = {"steps": Count, "action_repeat": Count, "delay": Natural, "action_noise": NotNegative}


@dataclass(frozen=True)
class Episode:
    """An environment with a time limit.

    The state's `clock` counts decisions and the return from the last reset. An action is repeated
    for `action_repeat` steps of the environment, whose rewards are added until it terminates. With
    a delay the first actions are 0.

    A decision violates the constraint by the environment's next observation, before noise. Then
    `metrics["violation"]` is 1, else 0, the clock counts it, and the reward is reduced by the
    constraint's price; the return is not.

    Raises:
        ValueError: for counts that are no whole numbers or too small, noise of another size, or
            a reward or constraint of the user's that gives no number.
    """

    env: Env
    steps: int = 1000  # decisions until the time limit
    action_repeat: int = 1
    delay: int = 0  # decisions until an action arrives
    sensor_noise: tuple[float, ...] | float = 0.0  # std of the observation: of all entries, or [o]
    action_noise: float = 0.0  # [u] std of what is added to an action when it arrives
    randomise: Ranges | None = None  # of each episode's body; also as {NAME: [low, high]}
    reward: Goal | None = None  # what it pays; None: the environment's own reward
    constraint: Constraint | None = None  # what decisions must not violate

    def __post_init__(self) -> None:
        try:
            for name, kind in OWN.items():
                check(self, name, kind)
        except FieldError as error:
            raise error.at("episode") from error
        for part, protocol in ((self.reward, Goal), (self.constraint, Constraint)):
            if part is not None:
                Contract(part, protocol, self.env.spec).check_examples()
        object.__setattr__(self, "randomise", self._ranges(self.randomise))
        if isinstance(self.sensor_noise, list):  # so that episodes can be hashed
            object.__setattr__(self, "sensor_noise", self.std)
        sizes = (1, self.env.spec.obs)
        numbers = all(isinstance(x, Real) and not isinstance(x, bool) for x in self.std)
        right = numbers and min(self.std, default=0) >= 0
        if len(self.std) not in sizes or not right:
            line = f"must be 1 or {sizes[1]} numbers, each 0 or more"
            raise FieldError(self, "sensor_noise", line).at("episode")

    def _ranges(self, given: Any) -> Ranges | None:
        """Of the bodies, as they were given; None if all have the same."""
        if given is None or isinstance(given, Ranges):
            return given
        names = [each.name for each in fields(Ranges)]
        if not isinstance(given, Mapping) or not {*given} <= {*names}:
            line = f"must be {{NAME: [low, high]}}, with names of {', '.join(names)}"
            raise ValueError(f"episode.randomise={given}: {line}")
        if all(pair is None for pair in given.values()):
            return None
        state = jax.eval_shape(self.env.reset, jax.random.key(0))
        if not isinstance(state.data, PhysicsState):
            line = "only for robots in MuJoCo, whose state.data Physics makes"
            raise ValueError(f"episode.randomise: {line}")
        try:
            return Ranges(**given)
        except FieldError as error:
            raise error.at("episode.randomise") from error

    @property
    def std(self) -> tuple[float, ...]:
        """Of the noise of all entries of the observation, or of each."""
        return tuple(np.atleast_1d(self.sensor_noise).tolist())

    @property
    def world(self) -> Env:
        """The environment with everything that is around it."""
        return put_around(self.env, self)

    @property
    def spec(self) -> Spec:
        """Sizes of the environment, and the time between decisions."""
        return self.world.spec

    def reset(self, key: Array) -> EnvState:
        """The first state of an episode. The key is consumed."""
        with EXACT():
            return self.world.reset(key)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """One decision with action [m]; UsageError for another shape."""
        if jnp.shape(action) != (self.spec.act,):
            shape, right = list(jnp.shape(action)), [self.spec.act]
            raise UsageError(f"the action is {shape}; it must be {right}; vmap steps many")
        with EXACT():
            return self.world.step(state, action)

    @property
    def relabels(self) -> bool:
        """Whether `reward_of` gives what it pays for decisions as they were, without noise."""
        known = self.reward is not None or hasattr(self.env, "reward_of")
        return known and self.action_repeat == 1

    @property
    def own_goal(self) -> Goal | None:
        """What it pays for demonstrations, if that is not the environment's reward alone."""
        changed = self.reward is not None or self.constraint is not None
        return self if changed and self.relabels else None

    def check_demonstrations(self) -> None:
        """Raise ValueError if demonstrations would keep another reward than what this one pays."""
        if (self.reward is None and self.constraint is None) or self.relabels:
            return
        what = "constraint takes" if self.reward is None else "reward pays"
        line = f"what {what} for demonstrations is unknown"
        if self.action_repeat > 1:
            line = f"episode.action_repeat={self.action_repeat}: {line}, as they lack the steps"
            line += " between decisions"
        else:
            line = f"constraint: {line}, as {type(self.env).__name__} has no reward_of"
        raise ValueError(f"{line}; replay.demonstrations=null leaves them out of the memory")

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [], less a violation's price, of action u [m] between observations [o]."""
        goal: Any = self.env if self.reward is None else self.reward
        paid, limit = goal.reward_of(x, u, after), self.constraint
        return paid if limit is None else paid - limit.price * (limit.excess(x, u, after) > 0)

    def auto_reset(self, state: EnvState, key: Array) -> EnvState:
        """`state`, or the first state of a new episode if it is done. The key is consumed.

        Under `vmap` the reset is computed only if some environment is done.
        """

        def reset_done(state: EnvState, key: Array) -> EnvState:
            return where(state.done, self.reset(key), state)

        return when_any(lambda state: state.done, reset_done)(state, key)
