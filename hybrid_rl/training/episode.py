"""Episodes of an environment: time limit, action repeat, resets, and disturbances on request.

A controller sees o + sensor_noise N(0, I), or some entries of it, and with `history` how they came
about (`core/history.py`); environment, reward and constraint see o. Its action u
arrives `delay` + `jitter` U(0, 1) seconds later, as clip(u + action_noise N(0, I)), or is lost, and
never overtakes another. If the method knows of that, the robot releases it no sooner than whole
decisions after its observation (`wrappers.whole`). What acted in a decision is
`state.clock.sent.acted`. An expert who is disturbed in this way demonstrates how to return (Laskey
et al. 2017, "DART: noise injection for robust imitation learning"). With `randomise` each episode
has another body (`envs/mujoco/randomised.py`).
"""

from collections.abc import Mapping
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.core.batching import when_any, where
from hybrid_rl.envs.adapters.unstepped import Unstepped
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.envs.mujoco.randomised import Ranges
from hybrid_rl.errors import UsageError
from hybrid_rl.fields import Count, FieldError, Fraction, Natural, NotNegative, part
from hybrid_rl.protocols import Constraint, Env, Goal
from hybrid_rl.protocols.contract import Contract
from hybrid_rl.training import wrappers
from hybrid_rl.types import EnvState, Spec

# Environments always compute in full precision, networks perhaps with less on an accelerator.
EXACT = partial(jax.default_matmul_precision, "highest")


@part
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
    steps: Count = 1000  # decisions until the time limit
    action_repeat: Count = 1
    delay: NotNegative = 0.0  # [s] until an action arrives
    jitter: NotNegative = 0.0  # [s] most that it is later than that; never before another
    loss: Fraction = 0.0  # probability that it never arrives: the last that did goes on acting
    lag: NotNegative | None = None  # [s] that it knows; None: delay + jitter
    longest: NotNegative = 0.0  # [s] longest lag to be ready for; a sweep of lags raises it
    sensor_noise: NotNegative | tuple[NotNegative, ...] = 0.0  # std of the observation, or [o]
    action_noise: NotNegative = 0.0  # [u] std of what is added to an action when it arrives
    observe: Count | tuple[Natural, ...] | None = None  # the first entries, or these; None: all
    history: Count = 1  # observations that an agent sees at a time
    randomise: Ranges | None = None  # of each episode's body; also as {NAME: [low, high]}
    reward: Goal | None = None  # what it pays; None: the environment's own reward
    constraint: Constraint | None = None  # what decisions must not violate

    def __post_init__(self) -> None:
        for paid, protocol in ((self.reward, Goal), (self.constraint, Constraint)):
            if paid is not None:
                Contract(paid, protocol, self.env.spec).check()
        if len(self.std) not in (1, self.env.spec.obs):
            line = f"must be one number, or {self.env.spec.obs} of them"
            raise FieldError(self, "sensor_noise", line)
        if isinstance(self.randomise, Mapping):
            try:
                object.__setattr__(self, "randomise", Ranges(**self.randomise))
            except (FieldError, TypeError) as error:
                line = f".{error.line}" if isinstance(error, FieldError) else f": {error}"
                raise ValueError(f"episode.randomise{line}") from error
        if self.randomise == Ranges():
            object.__setattr__(self, "randomise", None)
        first = jax.eval_shape(self.env.reset, jax.random.key(0)) if self.randomise else None
        if first is not None and not isinstance(first.data, PhysicsState):
            raise FieldError(self, "randomise", "only robots in MuJoCo have other bodies")
        _ = self.world

    @property
    def std(self) -> tuple[float, ...]:
        """Of the noise of all entries of the observation, or of each."""
        return tuple(np.atleast_1d(self.sensor_noise).tolist())

    @property
    def late(self) -> bool:
        """Whether actions arrive late, or not at all."""
        return bool(self.longest or self.delay or self.jitter or self.loss)

    @property
    def known_lag(self) -> float:
        """The lag [decisions] that the method knows, from an observation until its action acts.

        It is whole, as actions are held back, or rounded in a world that is late by itself.
        """
        lag = self._lag / self.spec.dt
        return wrappers.whole(lag) if self.late else float(round(lag))

    @property
    def knows_lag(self) -> bool:
        """Whether the method knows that its actions act late."""
        return bool(self.longest or self._lag) if self.lag is None else self.lag > 0

    @property
    def _lag(self) -> float:
        """Of known delay [s]."""
        return self.delay + self.jitter if self.lag is None else self.lag

    @property
    def world(self) -> Env:
        """The environment with everything that is around it (see `wrappers`)."""
        env = self.env if self.randomise is None else wrappers.Randomised(self.env, self.randomise)
        env = env if self.reward is None else wrappers.Paid(env, self.reward)
        env = wrappers.Limited(wrappers.Repeated(env, self.action_repeat), self.steps)
        env = env if self.constraint is None else wrappers.Constrained(env, self.constraint)
        env = wrappers.Disturbed(env, self.action_noise) if self.action_noise else env
        if self.late:
            env = wrappers.Late(env, self.delay, self.jitter, self.loss, self.lag, self.longest)
        seen = any(self.std) or self.observe is not None
        return wrappers.Sensed(env, self.std, self.observe) if seen else env

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
        summed = self.action_repeat > 1 and not isinstance(self.env, Unstepped)
        return known and not summed and self.observe is None

    @property
    def own_goal(self) -> Goal | None:
        """What it pays for demonstrations, if that is not the environment's reward alone."""
        changed = self.reward is not None or self.constraint is not None
        return self if changed and self.relabels else None

    def check_demonstrations(self) -> None:
        """Raise ValueError if demonstrations would keep another reward than what this one pays."""
        if (self.reward is not None or self.constraint is not None) and not self.relabels:
            line = "their rewards are unknown with episode.action_repeat, or without reward_of of "
            raise ValueError(f"replay.demonstrations: {line}the world; give null")

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [], less a violation's price, of action u [m] between observations [o]."""
        goal: Any = self.env if self.reward is None else self.reward
        paid, limit = goal.reward_of(x, u, after), self.constraint
        return paid if limit is None else paid - limit.price * (limit.excess(x, u, after) > 0)

    def auto_reset(self, state: EnvState, key: Array) -> EnvState:
        """`state`, or the first state of a new episode if it is done. The key is consumed.

        Under `vmap` the reset is computed only if some environment is done.
        """
        reset = when_any(lambda s: s.done, lambda s, key: where(s.done, self.reset(key), s))
        return reset(state, key)
