"""A world of one's own, checked without a run; for tests of it.

    from hybrid_rl.envs import check

    def test_my_world():
        check(MyWorld())

JAX traces it and compares it with `protocols.Env`; nothing is compiled.
"""

from dataclasses import is_dataclass, replace
from numbers import Integral
from typing import Any

from hybrid_rl.envs.mujoco import physics
from hybrid_rl.errors import GYMNASIUM, SourceOf, WorldError
from hybrid_rl.protocols import BalancedEnv, Env
from hybrid_rl.protocols.contract import Contract, check_instance
from hybrid_rl.types import Spec


def check(env: Any) -> None:
    """Check that runs can use `env`; see `protocols.Env`.

    Raises:
        WorldError: in one line: the file and line of the class or method, what it gives, and what
            it must give.
    """
    if is_dataclass(env) and getattr(env, "physics", None) in physics.IMPLEMENTATIONS:
        given: Any = env  # `replace` is typed for dataclasses alone
        env = replace(given, physics="native")  # MuJoCo C is traced at once
    world = SourceOf(env, WorldError)
    protocol = BalancedEnv if callable(getattr(env, "equilibrium", None)) else Env
    Contract(env, protocol, _spec(world), WorldError).check()


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
