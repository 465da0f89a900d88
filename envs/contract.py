"""What an environment must be, checked without a run; for tests of worlds of your own.

    from hybrid_rl.envs import check

    def test_my_world():
        assert check(MyWorld()) == ()

`reset` and `step` are traced, twice, and their results compared with `spec` and with each other;
then both are compiled and make ten random decisions. This takes a second, of which most is
compiling; a world with a field `physics` is simulated by MuJoCo C, which compiles at once.
"""

import re
from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass, replace
from functools import partial
from numbers import Integral, Real
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.extend.core import ClosedJaxpr, Jaxpr

from hybrid_rl.envs.indices import check as check_indices
from hybrid_rl.envs.mujoco import mjcf, native, physics, plausible
from hybrid_rl.envs.mujoco.physics import IMPLEMENTATIONS, PhysicsState
from hybrid_rl.errors import GYMNASIUM, SourceOf, WorldError
from hybrid_rl.types import EnvState, Spec

LARGE = 3000  # lines of a traced step; more would compile for many seconds, and are only traced
LOGGED = ("reward", "obs", "action", "violation")  # world/NAME of every run
SIGNATURES = {"reset": ("key",), "step": ("state", "action")}


def check(env: Any, decisions: int = 10) -> tuple[str, ...]:
    """Check that runs can use `env`; see `protocols.Env`.

    decisions: how many random ones it makes; 0 compiles nothing.

    Returns:
        Lines about what is allowed and seldom meant, such as an episode of one decision.

    Raises:
        WorldError: in one line: the file and line of the class or method, what it gives, and what
            it must give.
    """
    simulated = is_dataclass(env) and getattr(env, "physics", None) in IMPLEMENTATIONS
    given: Any = env  # `replace` is typed for dataclasses alone
    if simulated:
        SourceOf(env, WorldError).blamed("reset", physics.check, given.physics)
    world = SourceOf(replace(given, physics="native") if simulated else env, WorldError)
    _check_members(world)
    key = jax.random.key(0)
    reset = _traced(world, "reset", key)
    action = jax.ShapeDtypeStruct((world.object.spec.act,), jnp.float32)
    step = _traced(world, "step", reset.out_info, action)
    _check_trees(world, reset.out_info, step.out_info)
    text, clock = _text(step), _clock(world, step)
    if text.count("\n") > LARGE:
        return clock
    again = _traced(world, "reset", key), _traced(world, "step", reset.out_info, action)
    for method, first, second in (("reset", _text(reset), again[0]), ("step", text, again[1])):
        if first != _text(second):
            raise WorldError(
                f"{world.at(method)}: gives other numbers when it is traced again: what NumPy or "
                "Python draws is a constant of the compiled program; use jax.random, with a key "
                "in state.info"
            )
    return (*clock, *(_decide(world, *again, decisions) if decisions else ()))


def _traced(world: SourceOf, method: str, *arguments: Any) -> Any:
    """`method` traced by JAX, whose result is a valid EnvState."""

    def call(*given: Any) -> EnvState:
        result = getattr(world.object, method)(*given)
        _check_state(world, method, result)
        return result

    return world.blamed(method, jax.jit(call).trace, *arguments)


def _check_members(world: SourceOf) -> None:
    """Raise WorldError if `spec`, `reset` or `step` is missing or has another form."""
    env, at = world.object, world.at()
    if isinstance(env, type):
        raise WorldError(f"{env.__module__}: {env.__name__} is a class; give {env.__name__}()")
    if any(kind.__module__.split(".")[0] in ("gym", "gymnasium") for kind in type(env).__mro__):
        inner = SourceOf(env.unwrapped, WorldError)
        theirs = type(inner.object).__module__.startswith("gymnasium.")
        at = f"env: {type(inner.object).__name__}" if theirs else inner.at()
        raise WorldError(f"{at} is {GYMNASIUM}")
    spec = world.blamed("spec", getattr, env, "spec", None)
    if not isinstance(spec, Spec):
        has = "has no spec" if spec is None else f"has a spec that is a {type(spec).__name__}"
        raise WorldError(f"{at} {has}; write spec = Spec(obs=..., act=..., dt=...)")
    for name in ("obs", "act"):
        size = getattr(spec, name)
        if not isinstance(size, Integral) or size < 1:
            raise WorldError(f"{at}: spec.{name} is {size!r}; it must be a whole number, 1 or more")
    if not isinstance(spec.dt, Real) or not 0 < spec.dt < np.inf:
        raise WorldError(f"{at}: spec.dt is {spec.dt!r}; it must be a number of seconds above 0")
    for method, takes in SIGNATURES.items():
        world.takes(method, *takes)
    if hasattr(env, "equilibrium"):
        rest = world.blamed("equilibrium", jax.eval_shape, env.equilibrium)
        sizes = [getattr(each, "shape", ()) for each in rest] if isinstance(rest, tuple) else []
        if sizes != [(spec.obs,), (spec.act,)]:
            must = f"must return two arrays, obs [{spec.obs}] and action [{spec.act}] at rest"
            raise WorldError(f"{world.at('equilibrium')}: {must}")


def _check_state(world: SourceOf, method: str, state: Any) -> None:
    """Raise WorldError unless `state`, which `method` returned, is an EnvState of the spec."""
    at, o = world.at(method), world.object.spec.obs
    if not isinstance(state, EnvState):
        got = "None" if state is None else type(state).__name__
        got = f"a tuple of {len(state)}, as Gymnasium's do" if isinstance(state, tuple) else got
        raise WorldError(f"{at}: returned {got}; it must be an EnvState")
    size = jnp.size(state.obs) if _is_array(state.obs) else 0
    flag = "write a comparison, or jnp.zeros((), bool)"
    for name, shape, kind, remedy in (
        ("obs", (o,), jnp.floating, f"return {o} numbers, or write Spec(obs={size}, ...)"),
        ("reward", (), jnp.floating, "sum it, or take its entry; a whole number is no float"),
        ("terminated", (), jnp.bool_, flag),
        ("truncated", (), jnp.bool_, flag),
    ):
        value = getattr(state, name)
        number = name == "reward" and type(value) is float
        if number or (
            _is_array(value) and value.shape == shape and jnp.issubdtype(value.dtype, kind)
        ):
            continue
        wanted = "bool" if kind is jnp.bool_ else "float32"
        has = f", as spec.obs is {o}" if name == "obs" else ""
        must = f"it must be {wanted}{list(shape)}{has}"
        raise WorldError(f"{at}: returned {name} {_described(value)}; {must}: {remedy}")
    for name in ("metrics", "info"):
        if not isinstance(value := getattr(state, name), Mapping):
            raise WorldError(f"{at}: returned {name} {_described(value)}; it must be a dict")
    for name, value in state.metrics.items():
        if name in LOGGED:
            raise WorldError(f"{at}: metrics have {name}, which a run logs itself; rename it")
        if not isinstance(value, Real) and getattr(value, "shape", None) != ():
            has = _described(value) if _is_array(value) else type(value).__name__
            line = f"returned the metric {name} {has}; it must be one number"
            raise WorldError(f"{at}: {line}: give each entry a name")


def _check_trees(world: SourceOf, first: EnvState, after: EnvState) -> None:
    """Raise WorldError if `step` and `reset` give states of different form.

    `info` may lack entries in `step`, as episodes keep them.
    """
    after = after.replace(info={**first.info, **after.info})
    one, two, structure = _leaves(first), _leaves(after), jax.tree.structure
    if one == two and structure(first) == structure(after):
        return
    at, kind = world.at("step"), type(world.object).__name__
    if one == two:  # a list for a tuple, or None for nothing
        raise WorldError(f"{at}: returned a state of another structure than {kind}.reset")
    if isinstance(first.data, PhysicsState) and one.get("data.ctrl") != two.get("data.ctrl"):
        have, given = (
            0 if each is None else len(each) for each in (first.data.ctrl, after.data.ctrl)
        )
        raise WorldError(
            f"{at}: gives the physics {given} controls, and its model has {have} actuators; "
            f"spec.act is {world.object.spec.act}"
        )
    name = next(name for name in (*one, *two) if one.get(name) != two.get(name))
    gives = [f"{name} {each[name]}" if name in each else f"no {name}" for each in (two, one)]
    raise WorldError(f"{at}: returned {gives[0]}, and {kind}.reset {gives[1]}; both must be equal")


def _clock(world: SourceOf, step: Any) -> tuple[str, ...]:
    """A note if MuJoCo C simulates another time in a decision than spec.dt; `step`: traced.

    None where that is not certain, as physics steps stand in a loop or a branch.
    """
    dt, calls = world.object.spec.dt, list(_physics(step.jaxpr.jaxpr))
    for asset in {asset for asset, _, _ in calls}:
        each = [n for name, n, _ in calls if name == asset]
        h, n = mjcf.load(asset).opt.timestep, sum(each)
        sure = all(once for name, _, once in calls if name == asset)
        if sure and not np.isclose([h * n, *(h * one for one in each)], dt, rtol=1e-3).any():
            steps = f"{n} physics steps of {h:g} s, {h * n:g} s in all"
            line = f"{world.at('step')}: makes {steps}, and spec.dt is {dt:g} s"
            return (f"{line}; write dt={h * n:g}, or other steps",)
    return ()


def _physics(program: Jaxpr, once: bool = True) -> Iterator[tuple[str, int, bool]]:
    """Model, physics steps, and whether it is made once, of each call of MuJoCo C in a program."""
    for each in program.eqns:
        if each.primitive.name == "ffi_call":
            called = native.call_of(each.params["target_name"])
            yield from [(called.asset, called.steps, once)] if called and called.steps else []
        straight = each.primitive.name in ("jit", "pjit") or each.params.get("branches_platforms")
        for inner in jax.tree.leaves(list(each.params.values())):
            if isinstance(inner, ClosedJaxpr | Jaxpr):
                inside = inner.jaxpr if isinstance(inner, ClosedJaxpr) else inner
                yield from _physics(inside, once and bool(straight))


def _decide(world: SourceOf, reset: Any, step: Any, decisions: int) -> tuple[str, ...]:
    """Make random decisions; notes about their episodes.

    reset, step: traced. Raises WorldError if a number is not finite, or an index out of range.
    """
    resetting, stepping = (each.lower().compile() for each in (reset, step))
    rng, keys = np.random.default_rng(0), jax.random.split(jax.random.key(0), decisions + 1)
    state, ended, tried = world.blamed("reset", resetting, keys[0]), 0, []
    if not np.isfinite(state.obs).all():
        raise WorldError(f"{world.at('reset')}: returned obs {state.obs}; it must be finite")
    notes = _lines(world, "reset", plausible.of_start, state)
    moved = []
    for i in range(1, decisions + 1):
        action = rng.uniform(-1, 1, world.object.spec.act).astype(np.float32)
        after = world.blamed("step", stepping, state, action)
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
        state = world.blamed("reset", resetting, keys[i]) if after.terminated else kept
    for method, examples in (("reset", [(key,) for key in keys[:2]]), ("step", tried[::9])):
        world.blamed(method, check_indices, getattr(world.object, method), *examples)
    of_controls = partial(plausible.of_controls, np.array([action for _, action in tried]))
    notes += _lines(world, "step", of_controls, *moved)
    if ended == decisions:
        line = f"every episode ended after one decision, of {decisions} tried"
        notes.append(f"{world.at('step')}: {line}")
    return tuple(notes)


def _lines(world: SourceOf, method: str, about: Any, *states: EnvState) -> list[str]:
    """Notes that `about` gives of states of MuJoCo; of others none."""
    data = [state.data for state in states if isinstance(state.data, PhysicsState)]
    return [f"{world.at(method)}: {line}" for line in about(data)]


def _text(traced: Any) -> str:
    """The program that JAX traced, with its constants."""
    program = traced.jaxpr
    constants = "\n".join(map(str, program.consts))
    return re.sub(r" at 0x\w+", "", f"{program}\n{constants}")


def _leaves(tree: Any) -> dict[str, str]:
    """Path of each leaf -> its type, such as float32[2]."""
    paths = jax.tree_util.tree_leaves_with_path(tree)
    return {
        jax.tree_util.keystr(path, simple=True, separator="."): _described(leaf)
        for path, leaf in paths
    }


def _is_array(value: Any) -> bool:
    return hasattr(value, "shape") and hasattr(value, "dtype")


def _described(value: Any) -> str:
    """float32[2], or the Python value."""
    if _is_array(value):
        return f"{value.dtype}{list(value.shape)}"
    return "None" if value is None else f"{value!r} of Python ({type(value).__name__})"


def _numbers(value: Any) -> str:
    """An array as a message shows it."""
    text = np.array2string(np.asarray(value), precision=4, threshold=8, separator=", ")
    return " ".join(text.split())
