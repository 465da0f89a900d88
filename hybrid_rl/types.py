"""Data structures that parts exchange; their protocols are in hybrid_rl.protocols.

Shapes, used in the whole project:

    o observation   n planning state   m action   T planning horizon [decisions]
    K samples       B batch            E parallel environments   C capacity
    v search state                     N points

Everything is written for ONE environment and ONE sample; `jax.vmap` adds E, K, B and the seeds.
Actions u lie in [-1, 1]^m; an environment scales them to its own units. J is a return and is
maximised. A key is always the last argument and is consumed.

A model lifts an observation [o] to a planning state x [n]. Policies, critics, rewards and
objectives see x. Where the model is the world itself, x is an EnvState, of which policies and
critics see the observation.
"""

import re
from collections.abc import Callable
from dataclasses import field
from typing import Any, NamedTuple

import jax.numpy as jnp
from flax import struct
from jax import Array

PyTree = Any
NAME = re.compile(r"(?!\.+$)[A-Za-z0-9_.-]+")  # of a task or a method


class Spec(NamedTuple):
    """Sizes and time step of an environment."""

    obs: int  # o
    act: int  # m
    dt: float  # [s] between two decisions
    state: int | None = None  # n; None: the observation is the planning state
    newest: int | None = None  # of o, if the rest is the history before it (core.history)

    @property
    def n(self) -> int:
        """The size of the planning state."""
        return self.obs if self.state is None else self.state


class Sent(NamedTuple):
    """Actions that were sent, the newest last, and what they do; times in decisions."""

    actions: Array  # [L, m]
    waits: Array  # [L] until each arrives; infinite: it has arrived, was overtaken or is lost
    acting: Array  # [m] the last one that arrived
    acted: Array  # [m] the mean of those that acted in the last decision, by their shares of it
    drawing: Array | None = None  # data of the key of what is random; None: nothing


class Clock(NamedTuple):
    """What an episode counts and remembers since its reset; None: what it has no use for."""

    decision: Array  # [] int32
    total: Array  # [] the return: rewards without discount, and without a constraint's price
    violations: Array | None = None  # [] of the constraint
    sent: Sent | None = None  # actions that arrive late
    true_obs: Array | None = None  # the whole observation, without noise
    sensing: Array | None = None  # data of the key of the next noise of the sensors
    disturbing: Array | None = None  # data of the key of the next noise of an action


def _no() -> Array:
    return jnp.zeros((), bool)


@struct.dataclass
class EnvState:
    """The state of an environment between two decisions (a superset of Brax's fields)."""

    data: PyTree  # the physical state
    obs: Array  # [o]
    reward: Array  # []
    terminated: Array = field(default_factory=_no)  # [] bool: the task ended, no reward follows
    truncated: Array = field(default_factory=_no)  # [] bool: only the time limit ended the episode
    metrics: dict[str, Array] = field(default_factory=dict)  # name -> [], logged; or success
    info: dict[str, Array] = field(default_factory=dict)  # the task's own memory
    clock: Any = None  # the Clock of the episode; None: of a world alone

    @property
    def done(self) -> Array:
        """[] bool: the episode is over, for either reason."""
        return self.terminated | self.truncated


class Transition(NamedTuple):
    """One decision and its outcome."""

    obs: Array  # [o]
    action: Array  # [m]
    reward: Array  # []
    terminated: Array  # [] bool
    truncated: Array  # [] bool
    next_obs: Array  # [o] the true next observation, also where the episode ends


class Batch(NamedTuple):
    """B transitions for a learner."""

    obs: Array  # [B, o]
    action: Array  # [B, m]
    reward: Array  # [B]
    terminated: Array  # [B] 0 or 1
    truncated: Array  # [B] 0 or 1
    next_obs: Array  # [B, o]
    next_action: Array | None = None  # [B, m] executed at next_obs; arbitrary if the episode ended


class Imagined(NamedTuple):
    """B trajectories of a policy in a model, of H decisions and one more."""

    x: Array  # [H+1, B, n]
    u: Array  # [H+1, B, m]
    log_prob: Array  # [H+1, B] log pi(u|x)
    reward: Array  # [H, B]
    continues: Array  # [H, B] the probability that the episode continues


class Path(NamedTuple):
    """A trajectory, real or imagined."""

    x: Any  # [T+1, n]; EnvState [T+1, ...] on the world itself
    u: Array  # [T, m]


class Room(NamedTuple):
    """What the regulator of an unstable system leaves to corrections of its action."""

    most: float  # [u] of a correction
    time: float  # [decisions] time constant of the closed loop


class Considered(NamedTuple):
    """The candidates of a planner in one decision."""

    paths: Path  # [K, ...]
    chosen: Array  # [] the number of the one that acts, or that weighs most


class Params(NamedTuple):
    """Read-only view of everything that is learned; each field has one learner at most."""

    model: PyTree = None  # f(x, u)
    reward: PyTree = None  # r(x, u, x')
    policy: PyTree = None  # pi(x)
    critic: PyTree = None  # Q(x, u)
    belief: PyTree = None  # about the world: a Gaussian process, support vectors, particles
    labels: PyTree = None  # of a teacher, so far
    information: PyTree = None  # of the decisions so far about the parameters of the model
    scale: PyTree = None  # [] of returns
    decisions: Array | None = None  # [] of the run so far; None outside of training
    world: EnvState | None = None  # the state of the environment, for plans on the world itself


Return = Callable[[Path], Array]  # path -> J []
Step = Callable[[Array, Array], Array]  # x [n], u [m] -> the next x [n]
Reward = Callable[[Array, Array, Array], Array]  # x [n], u [m], the next x [n] -> r []
