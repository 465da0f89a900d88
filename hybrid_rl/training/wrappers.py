"""Wrappers of an environment, each an environment itself; `Episode` puts them together.

    Sensed(Late(Disturbed(Constrained(Limited(Repeated(Paid(Randomised(env))))))))

A wrapper keeps what it remembers in the `Clock` of the state. The outer ones see what the inner
ones made: a limit counts rewards before a constraint's price, a constraint judges the action that
arrived and the observation without noise.
"""

import math
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.batching import where
from hybrid_rl.core.lifting import check_coordinates, select
from hybrid_rl.envs import sensor_noise
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.envs.mujoco.randomised import Ranges
from hybrid_rl.fields import Count, Natural, part
from hybrid_rl.protocols import Constraint, Env, Goal
from hybrid_rl.types import Clock, EnvState, PyTree, Sent, Spec

VIOLATED = "violation"  # in `metrics`: 1 where the decision violates the constraint, else 0
SLIGHT = 0.1  # [decisions] later than a whole number of them that an action may act


def whole(lag: Any) -> Any:
    """A lag [decisions], a number or traced, once it is held back until it is whole."""
    return float(math.ceil(lag - SLIGHT)) if isinstance(lag, float) else jnp.ceil(lag - SLIGHT)


@dataclass(frozen=True)
class Around:
    """An environment around another one, from which it differs in nothing yet."""

    env: Env

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        return self.env.spec

    def reset(self, key: Array) -> EnvState:
        """The first state of an episode; outer wrappers use other parts of the key."""
        return jax.tree.map(jnp.asarray, self.env.reset(key))  # of Python's numbers, too

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later. action: [m]."""
        return jax.tree.map(jnp.asarray, self.env.step(state, action))


@dataclass(frozen=True)
class Randomised(Around):
    """Each episode has another body (`envs.mujoco.randomised`)."""

    ranges: Ranges

    def reset(self, key: Array) -> EnvState:
        """The first state, with a body of its own."""
        state = super().reset(key)
        data = self.ranges.draw(state.data, self.spec.act, jax.random.fold_in(key, 7))
        return state.replace(data=data)


@dataclass(frozen=True)
class Paid(Around):
    """The reward is that of a goal."""

    goal: Goal

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later, paid by the goal."""
        now, u = super().step(state, action), jnp.clip(action, -1.0, 1.0)
        return now.replace(reward=self.goal.reward_of(state.obs, u, now.obs))


@dataclass(frozen=True)
class Repeated(Around):
    """An action is repeated, and the rewards are added until the environment terminates."""

    times: int

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        return self.env.spec._replace(dt=self.env.spec.dt * self.times)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after the repeats."""

        def again(_: int, now: EnvState) -> EnvState:
            after = super(Repeated, self).step(now, action)
            after = after.replace(reward=now.reward + after.reward)
            return where(now.terminated, now, after)

        now = super().step(state, action)
        return jax.lax.fori_loop(1, self.times, again, now) if self.times > 1 else now


@dataclass(frozen=True)
class Limited(Around):
    """A time limit, and the clock."""

    steps: int  # decisions

    def reset(self, key: Array) -> EnvState:
        """The first state, with a new clock."""
        return super().reset(key).replace(clock=Clock(jnp.zeros((), jnp.int32), jnp.zeros(())))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later; the clock goes on."""
        now, before = super().step(state, action), state.clock
        clock = before._replace(decision=before.decision + 1, total=before.total + now.reward)
        truncated = (clock.decision >= self.steps) & ~now.terminated
        info = {**state.info, **now.info}  # also what `step` left out
        return now.replace(truncated=truncated, info=info, clock=clock)


@dataclass(frozen=True)
class Constrained(Around):
    """Violations of a constraint are counted, and their price is taken from the reward."""

    limit: Constraint

    def reset(self, key: Array) -> EnvState:
        """The first state, without violations."""
        state = super().reset(key)
        clock = state.clock._replace(violations=jnp.zeros(()))
        return state.replace(metrics={**state.metrics, VIOLATED: jnp.zeros(())}, clock=clock)

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later, judged by the observations before and after it."""
        now, u = super().step(state, action), jnp.clip(action, -1.0, 1.0)
        violated = (self.limit.excess(state.obs, u, now.obs) > 0).astype(now.reward.dtype)
        return priced(now, self.limit, state, violated)


def priced(now: EnvState, limit: Constraint, before: EnvState, violated: Array) -> EnvState:
    """`now` less the price of a violation, 0 or 1, which is counted."""
    return now.replace(
        reward=now.reward - limit.price * violated,
        metrics={**now.metrics, VIOLATED: violated},
        clock=now.clock._replace(violations=before.clock.violations + violated),
    )


@dataclass(frozen=True)
class Disturbed(Around):
    """Gaussian noise is added to each action, which is then clipped."""

    std: float  # [u]

    def reset(self, key: Array) -> EnvState:
        """The first state, with the key of the next noise."""
        state, data = super().reset(key), jax.random.key_data(jax.random.fold_in(key, 6))
        return state.replace(clock=state.clock._replace(disturbing=data))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after the action with noise."""
        now, later = jax.random.split(jax.random.wrap_key_data(state.clock.disturbing))
        noise = self.std * jax.random.normal(now, action.shape, action.dtype)
        clock = state.clock._replace(disturbing=jax.random.key_data(later))
        return super().step(state.replace(clock=clock), jnp.clip(action + noise, -1.0, 1.0))


@dataclass(frozen=True)
class Late(Around):
    """Actions arrive later, in the order in which they were sent; the first are 0.

    One that arrives within a decision acts from then on, and until then the one before. Of several
    only the newest acts. In MuJoCo that is true to a step of the physics; a world that has one step
    a decision, or steps in another way, gets the mean of both actions, by their shares.
    """

    delay: float  # [s]
    jitter: float = 0.0  # [s] most that an action is later than that, uniform
    loss: float = 0.0  # probability that an action never arrives
    lag: float | None = None  # [s] known, before which none acts; None: as in `Episode`
    longest: float = 0.0  # [s] that an action takes; 0: no longer than these say

    def reset(self, key: Array) -> EnvState:
        """The first state, with no action sent."""
        state, count = super().reset(key), int(self._longest) + 1 + bool(self.longest)
        random, drawing = self.longest or self.jitter or self.loss, jax.random.fold_in(key, 8)
        none, waits = jnp.zeros((count, self.spec.act)), jnp.full(count, jnp.inf)
        sent = Sent(none, waits, none[0], none[0], jax.random.key_data(drawing) if random else None)
        data = _held(state.data, 0) if self._steps(state) else state.data
        return state.replace(data=data, clock=state.clock._replace(sent=sent))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after the actions that act."""
        sent, steps = self._send(state.clock.sent, action), self._steps(state)
        now = sent.waits < 1
        last, any_ = len(now) - 1 - jnp.argmax(now[::-1]), now.any()
        arriving = jnp.where(any_, sent.actions[last], sent.acting)
        share = jnp.where(any_, jnp.maximum(sent.waits[last], 0), 0)  # of the one before
        if steps:
            share = jnp.round(share * steps) / steps
        acted = share * sent.acting + (1 - share) * arriving
        waits = jnp.where(now, jnp.inf, sent.waits - 1)
        sent = sent._replace(waits=waits, acting=arriving, acted=acted)
        state = state.replace(clock=state.clock._replace(sent=sent))
        if not steps:
            return super().step(state, acted)
        held = jnp.round(share * steps).astype(jnp.int32)
        return super().step(state.replace(data=_held(state.data, held)), arriving)

    def _send(self, sent: Sent, action: Array) -> Sent:
        """`sent` with one action more, the oldest of which cannot arrive any more."""
        wait, drawing = jnp.float32(self._decisions(self.delay)), sent.drawing
        if drawing is not None:
            key, losing, later = jax.random.split(jax.random.wrap_key_data(drawing), 3)
            wait = wait + self._decisions(self.jitter) * jax.random.uniform(key)
            before = jnp.where(jnp.isfinite(sent.waits), sent.waits, -jnp.inf).max()
            lost = jax.random.uniform(losing) < self.loss
            wait = jnp.where(lost, jnp.inf, jnp.maximum(wait, before))
            drawing = jax.random.key_data(later)
        actions = jnp.concatenate((sent.actions[1:], action[None]))
        waits = jnp.append(sent.waits[1:], jnp.maximum(wait, self._released))
        return sent._replace(actions=actions, waits=waits, drawing=drawing)

    def _decisions(self, time: float) -> float:
        return round(time / self.spec.dt, 6)

    @property
    def _released(self) -> float:
        """When a robot releases an action that has arrived [decisions], made whole."""
        return whole((self.delay + self.jitter if self.lag is None else self.lag) / self.spec.dt)

    @property
    def _longest(self) -> float:
        """Of an action [decisions]."""
        longest = self._decisions(self.longest)
        return longest or max(self._released, self._decisions(self.delay + self.jitter))

    def _steps(self, state: EnvState) -> int:
        """Steps of the physics in a decision; 0: actions arrive between decisions, or no MuJoCo."""
        if not self.longest and self._longest.is_integer() and not self.jitter:
            return 0
        kept = filter(_simulated, jax.tree.leaves(state.data, is_leaf=_simulated))
        times = [mjcf.load(each.asset).opt.timestep for each in kept]
        steps = round(self.spec.dt / times[0]) if times else 0
        return steps if steps > 1 else 0


def _simulated(leaf: Any) -> bool:
    return isinstance(leaf, PhysicsState)


def _held(data: PyTree, steps: Array | int) -> PyTree:
    """`data` whose physics keep the controls of before for so many [] steps."""

    def one(leaf: Any) -> Any:
        held = jnp.asarray(steps, jnp.int32)
        return leaf.replace(held=held) if _simulated(leaf) else leaf

    return jax.tree.map(one, data, is_leaf=_simulated)


@part
class Sensed(Around):
    """A controller sees entries of the observation, with Gaussian noise; the environment, all."""

    std: tuple[float, ...] = (0.0,)  # one of all entries, or one each
    observe: Count | tuple[Natural, ...] | None = None  # the first entries, or these; None: all

    def __post_init__(self) -> None:
        check_coordinates("episode.observe", self._entries, self.env.spec.obs)

    @property
    def _entries(self) -> tuple[int, ...] | None:
        return tuple(range(self.observe)) if isinstance(self.observe, int) else self.observe

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        size = self.env.spec.obs if self._entries is None else len(self._entries)
        return self.env.spec._replace(obs=size)

    def reset(self, key: Array) -> EnvState:
        """The first state, as it is seen."""
        return self._seen(super().reset(key), jax.random.fold_in(key, 5))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state one decision later, as it is seen."""
        key = jax.random.wrap_key_data(state.clock.sensing)
        return self._seen(super().step(state.replace(obs=state.clock.true_obs), action), key)

    def _seen(self, state: EnvState, key: Array) -> EnvState:
        obs, later = sensor_noise.added(state.obs, self.std, key)
        clock = state.clock._replace(true_obs=state.obs, sensing=later)
        return state.replace(obs=select(obs, self._entries), clock=clock)
