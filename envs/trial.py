"""A world of one's own, checked without a run; for tests of it.

    from hybrid_rl.envs import check

    def test_my_world():
        assert check(MyWorld()) == ()

It is compared with `protocols.Env`, traced twice; then it makes ten random decisions. This takes a
second, of which most is compiling; a world with a field `physics` is simulated by MuJoCo C, which
compiles at once.
"""

from dataclasses import is_dataclass, replace
from functools import partial
from numbers import Integral, Real
from typing import Any

import jax
import numpy as np

from hybrid_rl.envs.mujoco import physics, plausible
from hybrid_rl.envs.mujoco.physics import IMPLEMENTATIONS, PhysicsState
from hybrid_rl.errors import GYMNASIUM, SourceOf, WorldError
from hybrid_rl.protocols import BalancedEnv, Env
from hybrid_rl.protocols.contract import Contract, check_indices, program_text, signatures
from hybrid_rl.types import EnvState, Spec

LARGE = 3000  # lines of a traced step; more would compile for many seconds, and are only traced
LOGGED = ("reward", "obs", "action", "violation")  # world/NAME of every run


def check(env: Any, decisions: int = 10) -> tuple[str, ...]:
    """Check that runs can use `env`; see `protocols.Env`.

    decisions: how many random ones it makes; 0 compiles nothing.

    Returns:
        Warnings about what is valid and probably a mistake, as an episode of one decision.

    Raises:
        WorldError: in one line: the file and line of the class or method, what it gives, and what
            it must give.
    """
    world = SourceOf(env, WorldError)
    if is_dataclass(env) and getattr(env, "physics", None) in IMPLEMENTATIONS:
        given: Any = env  # `replace` is typed for dataclasses alone
        world.blamed("reset", physics.check, given.physics)
        world = SourceOf(replace(given, physics="native"), WorldError)
    _check_spec(world)
    env = world.object
    protocol = BalancedEnv if callable(getattr(env, "equilibrium", None)) else Env
    contract = Contract(env, protocol, {"spec": env.spec}, WorldError)
    contract.check_members()
    reset, step = (
        contract.trace(name, signatures(Env)[name], twice=True) for name in ("reset", "step")
    )
    if protocol is BalancedEnv:
        contract.trace("equilibrium", signatures(BalancedEnv)["equilibrium"])
    if taken := {*LOGGED} & {*contract.values["env"].metrics}:
        contract.refuse("reset", f"metrics have {taken.pop()}, which a run logs itself; rename it")
    notes = tuple(f"{world.at('step')}: {x}" for x in plausible.of_clock(env.spec.dt, step.jaxpr))
    if not decisions or program_text(step).count("\n") > LARGE:
        return notes
    return (*notes, *_decide(world, reset, step, decisions))


def _check_spec(world: SourceOf) -> None:
    """Raise WorldError for an environment of Gymnasium, or without sizes and time step."""
    env, at = world.object, world.at()
    if isinstance(env, type):
        raise WorldError(f"{env.__module__}: {env.__name__} is a class; give {env.__name__}()")
    if any(kind.__module__.split(".")[0] in ("gym", "gymnasium") for kind in type(env).__mro__):
        inner = SourceOf(env.unwrapped, WorldError)
        theirs = type(inner.object).__module__.startswith("gymnasium.")
        at = f"env: {type(inner.object).__name__}" if theirs else inner.at()
        raise WorldError(f"{at} is {GYMNASIUM}")
    spec = world.blamed("spec", getattr, env, "spec", None)
    whole = isinstance(spec, Spec) and all(
        isinstance(size, Integral) and size >= 1 for size in (spec.obs, spec.act)
    )
    if not whole or not isinstance(spec.dt, Real) or not 0 < float(spec.dt) < np.inf:
        must = "it must be Spec(obs=..., act=..., dt=...), two whole numbers above 0 and seconds"
        raise WorldError(f"{at}: spec is {spec}; {must}")


def _decide(world: SourceOf, reset: Any, step: Any, decisions: int) -> tuple[str, ...]:
    """Make random decisions; warnings about their episodes.

    reset, step: traced. Raises WorldError if a number is not finite, or an index out of range.
    """
    resetting, stepping = (traced.lower().compile() for traced in (reset, step))
    rng, keys = np.random.default_rng(0), jax.random.split(jax.random.key(0), decisions + 1)
    (state,), ended, tried = world.blamed("reset", resetting, keys[0]), 0, []
    if not np.isfinite(state.obs).all():
        raise WorldError(f"{world.at('reset')}: returned obs {state.obs}; it must be finite")
    notes = _lines(world, "reset", plausible.of_start, state)
    moved = []
    for i in range(1, decisions + 1):
        action = rng.uniform(-1, 1, world.object.spec.act).astype(np.float32)
        (after,) = world.blamed("step", stepping, state, action)
        tried.append((state, action))
        for name in ("reward", "obs"):
            value = np.asarray(getattr(after, name))
            if not np.isfinite(value).all():
                seen = f"after obs {_numbers(state.obs)} and action {_numbers(action)}"
                at = world.at("step")
                raise WorldError(f"{at}: {name} is {_numbers(value)} at decision {i}, {seen}")
        ended += bool(after.terminated)
        moved.append(after)
        kept = after.replace(info={**state.info, **after.info})
        state = world.blamed("reset", resetting, keys[i])[0] if after.terminated else kept
    for method, examples in (("reset", [(key,) for key in keys[:2]]), ("step", tried[::9])):
        check_indices(world, method, *examples)
    of_controls = partial(plausible.of_controls, np.array([action for _, action in tried]))
    notes += _lines(world, "step", of_controls, *moved)
    if ended == decisions:
        line = f"every episode ended after one decision, of {decisions} tried"
        notes.append(f"{world.at('step')}: {line}")
    return tuple(notes)


def _lines(world: SourceOf, method: str, about: Any, *states: EnvState) -> list[str]:
    """Warnings that `about` gives of states of MuJoCo; of others none."""
    data = [state.data for state in states if isinstance(state.data, PhysicsState)]
    return [f"{world.at(method)}: {line}" for line in about(data)]


def _numbers(value: Any) -> str:
    """An array as a message shows it."""
    text = np.array2string(np.asarray(value), precision=4, threshold=8, separator=", ")
    return " ".join(text.split())
