"""A Gymnasium environment, which is no JAX function: it steps on the host, beside a program.

    External(id="Hopper-v5")                      of Gymnasium's registry, or MODULE:ID
    External(make="my_module:MyEnv")              a class, or a function without arguments
    External(make=MyEnv, kwargs={"mass": 2.0})    the same from Python

Actions u in [-1, 1] are scaled to the bounds of the action space. An observation of dictionaries
or tuples is flattened by Gymnasium's wrapper, in the order of the sorted keys. Methods that learn
their model train on it; those that plan on the true dynamics do not.

Source: Gymnasium's documentation, "Env", "AutoresetMode".
"""

from collections.abc import Sequence
from contextlib import suppress
from functools import cache
from typing import Any, NamedTuple, NoReturn

import gymnasium
import numpy as np
from gymnasium.spaces import Box, Dict, Space, flatdim, flatten
from gymnasium.wrappers import FlattenObservation
from jax import Array

from hybrid_rl.envs.adapters.copies import Copies
from hybrid_rl.envs.adapters.unstepped import Made, import_named, registered
from hybrid_rl.envs.trial import check
from hybrid_rl.errors import FAULTS, UsageError, blame
from hybrid_rl.fields import Positive, part
from hybrid_rl.protocols.contract import of_user
from hybrid_rl.types import EnvState, Spec

ACTIONS = "they must be a Box with finite bounds, of one number or more"
FORMS = "they must be numbers in a form that Gymnasium flattens: Box, Discrete, Dict, Tuple"
DT = 'add env.dt=0.05, the seconds of a decision, or metadata = {"render_fps": 20} to its class'


@part
class External(Made):
    """An environment that Gymnasium makes; to read its spaces one copy is made, and reset."""

    id: str = ""  # in place of `make`
    dt: Positive | None = None  # [s] between decisions; None: what the environment says
    processes: bool = False  # one for each copy; pays where a step takes 1 ms or more
    timeout_s: Positive | None = None  # [s] for a step, in processes; then the run ends

    def __post_init__(self) -> None:
        if not (self.id or self.make):
            raise UsageError("env.id: give an id of Gymnasium, or env.make=MODULE:CLASS")
        super().__post_init__()
        _ = self.known

    @property
    def name(self) -> str:
        """What messages call it."""
        return super().name or self.id

    @property
    def known(self) -> "Known":
        """What one copy of the environment declares."""
        return _known(self)

    @property
    def spec(self) -> Spec:
        """Its sizes, and the time between decisions."""
        return self.known.spec

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The least and the greatest action [m], in the environment's units."""
        space = self.known.space
        return space.low.ravel(), space.high.ravel()

    @property
    def parts(self) -> str:
        """The entries of an observation in their order, if it is a Dict: gear [3], goal [2]."""
        space = self.known.seen
        parts = space.items() if isinstance(space, Dict) else ()
        return ", ".join(f"{name} [{flatdim(each)}]" for name, each in parts)

    def flat(self, obs: Any) -> np.ndarray:
        """What a policy sees, [o], of an observation as the environment returns it."""
        return np.asarray(flatten(self.known.seen, obs))

    def step(self, state: EnvState, action: Array) -> NoReturn:
        """No JAX function."""
        raise UsageError(
            f"{self.name}: steps on the host, so no method can plan on it; choose one that learns "
            "its model, such as algo=hybrid_stochastic, nn_mppi or sac"
        )

    def one(self, render_mode: str | None = None) -> gymnasium.Env:
        """A copy of the environment, with flat observations and without a time limit of its own."""
        given: dict[str, Any] = {**(self.kwargs or {})}
        if render_mode is not None:
            given["render_mode"] = render_mode
        if not self.make:
            options: dict[str, Any] = {"disable_env_checker": True, "max_episode_steps": -1}
            return FlattenObservation(gymnasium.make(registered(self.id), **options, **given))
        env = import_named(self.make)(**given)
        if not isinstance(env, gymnasium.Env):
            raise UsageError(f"env.make={self.name}: returns {env!r}, which is no gymnasium.Env")
        return FlattenObservation(env)

    def copies(
        self, seeds: Sequence[int], steps: int, repeat: int = 1, render_mode: str | None = None
    ) -> Copies:
        """One copy for each seed; steps: decisions until the time limit of each."""
        return Copies(self, seeds, steps, repeat, render_mode)


class Known(NamedTuple):
    """What an environment declares."""

    spec: Spec
    steps: int | None  # the time limit [steps of the environment]
    space: Box  # of actions
    seen: Space  # of observations, as the environment returns them


@cache
def _known(env: External) -> Known:
    """What one copy declares."""
    try:
        one = env.one()
        one.reset(seed=0)  # some declare their spaces there
    except UsageError:
        raise
    except FAULTS as error:
        key = "make" if env.make else "id"
        raise UsageError(f"env.{key}={env.name}: {blame(error)}") from error
    space, obs, seen = one.action_space, one.observation_space, one.env.observation_space
    if not (isinstance(space, Box) and flatdim(space) and space.is_bounded()):
        raise UsageError(f"{env.name}: has actions {space}; {ACTIONS}")
    if not (isinstance(obs, Box) and np.prod(obs.shape) > 0):
        raise UsageError(f"{env.name}: has observations {obs}; {FORMS}")
    dt = env.dt or _time_step(env.name, one)
    limit = None
    if not env.make and one.spec is not None:
        limit = gymnasium.spec(one.spec.id).max_episode_steps  # of the newest version of an env.id
    elif one.has_wrapper_attr("_max_episode_steps"):
        limit = one.get_wrapper_attr("_max_episode_steps")  # of a TimeLimit
    one.close()
    sizes = int(np.prod(obs.shape)), int(np.prod(space.shape))
    return Known(Spec(*sizes, dt), limit, space, seen)


def _time_step(name: str, one: gymnasium.Env) -> float:
    """The seconds between decisions, by `dt` of the environment or its `render_fps`."""
    with suppress(*FAULTS):  # there is neither, or it is no number
        dt = float(getattr(one.unwrapped, "dt", None) or 1 / one.metadata["render_fps"])
        if 0 < dt < np.inf:
            return dt
    raise UsageError(f"{name}: does not say its time step; {DT}")


def check_world(env: Any) -> None:
    """Check a world of the user's."""
    if of_user(env):
        check(env)
