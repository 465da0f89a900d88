"""Decisions outside of a compiled loop: actions at observations, and the states that follow."""

import time
from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike

from hybrid_rl.core import batching
from hybrid_rl.errors import UsageError, one_line
from hybrid_rl.protocols import Controller
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.ahead import AheadState
from hybrid_rl.training.history import HistoryState, informed
from hybrid_rl.training.loop import Axis
from hybrid_rl.types import Clock, EnvState, Params, Spec

NONE: Mapping[str, Array] = MappingProxyType({})


class Acting:
    """u [S, N, m] = acting(params [S, ...], obs [S, N, o]) of S learners, in N worlds each.

    The controllers' states and the keys of their random numbers are kept from one decision to the
    next. numbers: of a loop's axis by path [S]; mode: of the controller.
    """

    def __init__(
        self,
        spec: Spec,
        controller: Controller,
        keys: Array,
        numbers: Mapping[str, Array] = NONE,
        mode: str = "full",
    ) -> None:
        """keys: [S, N]."""
        (learners, worlds), self.spec, self._numbers = keys.shape, spec, dict(numbers)
        own = partial(Axis().put, controller, f"controllers.{mode}")
        first = jax.vmap(lambda n: batching.repeat(own(n).init(spec), worlds), axis_size=learners)

        def decide(numbers: Any, params: Params, control: Any, obs: Array, keys: Array) -> tuple:
            keys, now = jnp.moveaxis(jax.vmap(jax.random.split)(keys), 1, 0)
            act = jax.vmap(own(numbers).act, (None, 0, 0, 0))
            u, control, _ = act(params, control, obs, now)
            return u, control, keys

        self._rest = jax.jit(first)(self._numbers)
        self._program: Any = jax.jit(jax.vmap(decide))
        self.begin(keys)

    def compile(self, params: Params) -> None:
        """Compile for parameters like these, before the first decision."""
        obs = np.zeros((*self.keys.shape, self.spec.obs), np.float32)
        like = self._numbers, params, self._rest, obs, self.keys
        self._program = self._program.lower(*like).compile()

    def begin(self, keys: Array | None = None, where: np.ndarray | None = None) -> None:
        """Episodes begin, with these keys if there are any; where: [S, N] bool, only in these."""
        self.keys = self.keys if keys is None else keys
        if where is None:
            self.control = self._rest
        else:
            self.control = batching.where(jnp.asarray(where), self._rest, self.control)

    def __call__(self, params: Params, obs: np.ndarray) -> np.ndarray:
        """The actions [S, N, m] at the observations [S, N, o]."""
        given = self._numbers, params, self.control, obs, self.keys
        u, self.control, self.keys = self._program(*given)
        return np.asarray(u)


class Exploring:
    """The decisions of one learner while it trains, in one world; the first ones at random."""

    params: Params | None = None  # [1, ...]; None: there are none yet

    def __init__(self, agent: Agent, seed: int) -> None:
        """Compile."""
        key = jax.random.fold_in(jax.random.key(seed), int(time.time()))
        self._random_steps = agent.random_steps
        self._random = np.random.default_rng(np.asarray(jax.random.key_data(key)))
        self._acting = Acting(agent.spec, agent.controller, key[None, None])
        many = jax.vmap(jax.vmap(informed, (0, None, None)), (0, None, None))
        self._informed = jax.jit(many)
        self.like = jax.eval_shape(lambda: agent.params(agent.init(key)))  # of the parameters
        self.take(jax.tree.map(lambda leaf: np.zeros(leaf.shape, leaf.dtype), self.like))
        self._acting.compile(self._with(0))
        self(np.zeros(agent.spec.obs), agent.random_steps)  # the first call takes longer
        self.begin()
        self.params = None

    def take(self, params: Params) -> None:
        """Decide with these parameters from now on."""
        self.params = jax.device_put(jax.tree.map(lambda leaf: leaf[None], params))

    def begin(self) -> None:
        """An episode begins."""
        self._acting.begin()

    @property
    def predicts(self) -> bool:
        """Whether it acts at the observation predicted for when its action acts."""
        control = self._acting.control
        return isinstance(
            control.inner if isinstance(control, HistoryState) else control, AheadState
        )

    def informed(self, sent: np.ndarray, lag: float) -> None:
        """What was sent, [K + 1, m] or more, the newest last; how late it acts [decisions]."""
        given = self._acting.control, sent.astype(np.float32), np.float32(lag)
        if isinstance(given[0], AheadState | HistoryState):
            self._acting.control = self._informed(*given)

    def __call__(self, obs: np.ndarray, decisions: int) -> np.ndarray:
        """The action [m] at `obs` [o], after so many decisions of the run."""
        if decisions < self._random_steps:
            return self._random.uniform(-1, 1, self._acting.spec.act).astype(np.float32)
        return self._acting(self._with(decisions), np.array(obs, np.float32)[None, None])[0, 0]

    def _with(self, decisions: int) -> Params:
        """The parameters after so many decisions."""
        assert self.params is not None
        count: Any = np.full(1, decisions, np.int32)
        return self.params._replace(decisions=count)


class TrainedPolicy:
    """action = policy(obs): a trained controller without exploration, for one world or N.

    obs is [o], or [N, o] of N worlds side by side; the action is [m] or [N, m], in [-1, 1] or, with
    `span` = (middle [m], half the width [m]), within these bounds. `flat` makes [o] of the
    dictionary that a Gymnasium environment may return. A planner keeps its plan from one call to
    the next, so call `reset` when an episode begins.
    """

    def __init__(
        self,
        spec: Spec,
        controller: Controller,
        params: Params,
        key: int = 0,
        span: tuple[np.ndarray, np.ndarray] | None = None,
        flat: Callable[[Mapping[str, Any]], np.ndarray] | None = None,
    ) -> None:
        self.spec, self._controller, self._span, self._flat = spec, controller, span, flat
        self._params, self._key = jax.tree.map(lambda leaf: leaf[None], params), jax.random.key(key)
        self._resize(1)

    def _resize(self, worlds: int) -> None:
        """Begin in so many worlds, the first of which has the key itself."""
        more = [jax.random.fold_in(self._key, i) for i in range(1, worlds)]
        keys = jnp.stack([self._key, *more])
        self._acting, self._begun = Acting(self.spec, self._controller, keys[None]), False

    def reset(self, where: np.ndarray | None = None) -> None:
        """Begin an episode; where: [N] bool, only in these worlds."""
        self._begun &= where is not None
        self._acting.begin(where=None if where is None else np.asarray(where)[None])

    def __call__(self, obs: np.ndarray | Mapping[str, Any]) -> np.ndarray:
        """The action [m] at obs [o], or actions [N, m] at [N, o].

        Raises:
            ValueError: for observations of another size or that are not finite, or another N than
                since the reset.
        """
        if self._flat is not None and isinstance(obs, Mapping):
            obs = self._flat(obs)
        values = numbers("obs", obs, self.spec.obs, many=True)
        rows, now = np.atleast_2d(values), self._acting.keys.shape[1]
        if len(rows) != now:
            if self._begun:
                line = f"got {len(rows)} observations, the episode began with {now}; call reset()"
                raise UsageError(line)
            self._resize(len(rows))
        self._begun = True
        u = self._acting(self._params, rows[None])[0].reshape(*values.shape[:-1], self.spec.act)
        return u if self._span is None else self._span[0] + self._span[1] * np.clip(u, -1, 1)


def next_state(
    env: EnvState, obs: ArrayLike, reward: ArrayLike, terminated: ArrayLike, truncated: ArrayLike
) -> EnvState:
    """The states [E] after a decision at `env` [E], of which a world outside tells the others."""
    clock = Clock(env.clock.decision + 1, env.clock.total + reward)
    return env.replace(
        obs=obs, reward=reward, terminated=terminated, truncated=truncated, clock=clock
    )


def numbers(
    name: str, given: Any, *shape: int, most: float = np.inf, many: bool = False
) -> np.ndarray:
    """The numbers as float32 [*shape], or with `many` also [N, *shape].

    UsageError for other things, another shape, and numbers that are not finite or beyond +-most.
    """
    try:
        with np.errstate(over="ignore"):
            values = np.array(given, np.float32)
    except (TypeError, ValueError) as error:
        raise UsageError(f"{name}: must be numbers {list(shape)} ({one_line(error)})") from error
    if values.shape != shape and not (many and values.shape[1:] == shape):
        must = f"{list(shape)}{f' or [N, {shape[0]}]' * many}" if shape else "one number"
        raise UsageError(f"{name} is {list(values.shape)}; it must be {must}")
    if (wrong := ~(np.abs(values) <= most + 1e-5) | ~np.isfinite(values)).any():
        entry = f": entry {np.argwhere(wrong)[0, -1]}" if values.ndim else ""
        must = "is not finite" if np.isinf(most) else f"must lie in [{-most:g}, {most:g}]"
        raise UsageError(f"{name}{entry} {must}")
    return values
