"""A world of one's own, checked without a run; for tests of it.

    from hybrid_rl.envs import check

    def test_my_world():
        assert check(MyWorld()) == ()

It is compared with `protocols.Env`, traced twice; then it makes ten random decisions. This takes a
second, of which most is compiling; a world with a field `physics` is simulated by MuJoCo C, which
compiles at once.
"""

from dataclasses import is_dataclass, replace
from numbers import Integral
from typing import Any

import jax
import numpy as np

from hybrid_rl.envs.mujoco import physics
from hybrid_rl.errors import GYMNASIUM, SourceOf, WorldError
from hybrid_rl.protocols import BalancedEnv, Env
from hybrid_rl.protocols.contract import Contract, check_indices, check_instance, program_text
from hybrid_rl.types import Spec

LARGE = 3000  # lines of a traced step; more would compile for many seconds, and are only traced


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
    if is_dataclass(env) and getattr(env, "physics", None) in physics.IMPLEMENTATIONS:
        given: Any = env  # `replace` is typed for dataclasses alone
        world = SourceOf(replace(given, physics="native"), WorldError)
    env = world.object
    protocol = BalancedEnv if callable(getattr(env, "equilibrium", None)) else Env
    traces = Contract(env, protocol, _spec(world), WorldError).check()
    reset, step = traces["reset"], traces["step"]
    if not decisions or program_text(step).count("\n") > LARGE:
        return ()
    return _decide(world, reset, step, decisions)


def _spec(world: SourceOf) -> Spec:
    """Sizes and time step of a world; WorldError without them, as of a gymnasium.Env."""
    check_instance(world.object, WorldError)
    env, at = world.object, world.at()
    if any(kind.__module__.split(".")[0] in ("gym", "gymnasium") for kind in type(env).__mro__):
        raise WorldError(f"{at} is {GYMNASIUM}")
    spec = world.blamed("spec", getattr, env, "spec", None)
    sizes = spec[:2] if isinstance(spec, Spec) else (0,)
    if any(not isinstance(size, Integral) or size < 1 for size in sizes) or not spec.dt > 0:
        must = "it must be Spec(obs=..., act=..., dt=...), two whole numbers above 0 and seconds"
        raise WorldError(f"{at}: spec is {spec}; {must}")
    return spec


def _decide(world: SourceOf, reset: Any, step: Any, decisions: int) -> tuple[str, ...]:
    """Make random decisions; a warning if each of them ended its episode.

    reset, step: traced. Raises WorldError if a number is not finite, or an index out of range.
    """
    resetting, stepping = (traced.lower().compile() for traced in (reset, step))
    rng, keys = np.random.default_rng(0), jax.random.split(jax.random.key(0), decisions + 1)
    state, ended, tried = world.blamed("reset", resetting, keys[0]), 0, []
    if not np.isfinite(state.obs).all():
        raise WorldError(f"{world.at('reset')}: returned obs {state.obs}; it must be finite")
    for i in range(1, decisions + 1):
        action = rng.uniform(-1, 1, world.object.spec.act).astype(np.float32)
        after = world.blamed("step", stepping, state, action)
        tried.append((state, action))
        for name in ("reward", "obs"):
            value = np.asarray(getattr(after, name))
            if not np.isfinite(value).all():
                seen = f"after obs {_numbers(state.obs)} and action {_numbers(action)}"
                line = f"{name} is {_numbers(value)} at decision {i}, {seen}"
                raise WorldError(f"{world.at('step')}: {line}")
        ended += bool(after.terminated)
        kept = after.replace(info={**state.info, **after.info})
        state = world.blamed("reset", resetting, keys[i]) if after.terminated else kept
    check_indices(world, "reset", (keys[0],), (keys[1],))
    check_indices(world, "step", *tried[::9])
    line = f"every episode ended after one decision, of {decisions} tried"
    return (f"{world.at('step')}: {line}",) if ended == decisions else ()


def _numbers(value: Any) -> str:
    """An array as a message shows it."""
    text = np.array2string(np.asarray(value), precision=4, threshold=8, separator=", ")
    return " ".join(text.split())
