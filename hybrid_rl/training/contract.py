"""What the parts of a method must be, checked before a run: JAX traces them, nothing is compiled.

A method of the library's parts alone is not checked. Of one with a part of the user's, controllers
and learners are traced, and compared with `protocols.Controller` and `protocols.Learner`: shapes of
actions, states and metrics, the fields of `Params` that a learner owns. What goes wrong is one line
that begins with the user's file, as in `envs.contract` for worlds.
"""

import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl import protocols
from hybrid_rl.errors import FAULTS, Own, PartError, UsageError, one_line, user_line
from hybrid_rl.types import EnvState, Params, Spec

ROLES = {  # kind of a part -> its methods and what they take
    "controller": {"init": ("spec",), "act": ("params", "state", "obs", "key"), "greedy": ()},
    "learner": {
        "init": ("key", "spec"),
        "params": ("state",),
        "update": ("state", "params", "batch", "key"),
    },
}
MODEL = ("init", "lift", "step")  # what makes a part a model
FIELDS = {  # of a learner, by its data
    "uniform": ("batch_size", "batches", "updates", "during_random"),
    "latest": ("every",),
}
OWNED = tuple(name for name in Params._fields if name not in ("decisions", "world"))
OF_WORLD = ("world/reward", "world/obs", "world/action")
OTHERS = {"hybrid_rl", "jax", "jaxlib", *sys.stdlib_module_names}  # packages
COLUMNS = ("step", "seed", "wall_s")  # of a row, beside its metrics


def check_members(controller: Any, learners: Mapping[str, Any]) -> None:
    """Check that parts of the user's have the methods and the fields of their roles.

    Raises:
        PartError: in one line, for what is missing or has another form.
        ValueError: for two learners of one field of `Params`.
    """
    _check_members(controller, "controller")
    owners: dict[str, str] = {}
    for name, learner in learners.items():
        _check_members(learner, "learner")
        for field in learner.owns:
            if field in owners:
                both = f"{owners[field]} and {name}"
                raise ValueError(f"learners: {both} both learn params.{field}; keep one")
            owners[field] = name


def _check_members(part: Any, role: str) -> None:
    """Raise PartError for a method or a field that a part of the user's lacks."""
    if not _of_user(part):
        return
    own = Own(part)
    if isinstance(part, type):
        raise PartError(f"{part.__module__}: {part.__name__} is a class; give {part.__name__}()")
    for method, takes in ROLES[role].items():
        own.takes(method, *takes)
    if role != "learner":
        return
    data, owns = getattr(part, "data", None), getattr(part, "owns", None)
    if data not in FIELDS:
        raise PartError(f'{own.at()}: data is {data!r}; it must be "uniform" or "latest"')
    if not isinstance(owns, tuple) or not {*owns} <= {*OWNED}:
        known = ", ".join(OWNED)
        raise PartError(
            f'{own.at()}: owns is {owns!r}; it must be a tuple, as ("{known[:5]}",), '
            f"of the fields of Params: {known}"
        )
    if lacking := [name for name in FIELDS[data] if not hasattr(part, name)]:
        kind = f'a learner with data = "{data}"'
        raise PartError(
            f"{own.at()} has no {', '.join(lacking)}; {kind} has {', '.join(FIELDS[data])}"
        )


def check(agent: Any, controllers: Iterable[Any]) -> None:
    """Check the parts of an Agent, and the controllers that act with what it learns.

    Raises:
        PartError: in one line: the file and line, what a method gives, and what it must give.
    """
    controllers = list({id(each): each for each in controllers}.values())  # full may be policy
    if not any(_mine([*controllers, *agent.learners.values()])):
        return
    key = jax.eval_shape(lambda: jax.random.key(0))
    for part in _mine([*controllers, *agent.learners.values()]):
        if all(hasattr(part, method) for method in MODEL):
            _check_model(part, agent.spec, key)
    states, learned = {}, {}
    for name, learner in agent.learners.items():
        states[name] = _shapes(learner, "init", lambda key, of=learner: agent._first(of, key), key)
        given = _shapes(learner, "params", learner.params, states[name])
        if not isinstance(given, Mapping) or {*given} != {*learner.owns}:
            got = f"{list(given)}" if isinstance(given, Mapping) else _words(given)
            must = f"it must be a dict of what it owns, {list(learner.owns)}"
            raise PartError(f"{Own(learner).at('params')}: returned {got}; {must}")
        learned |= given
    params = Params(**learned)._replace(decisions=jax.ShapeDtypeStruct((), jnp.int32))
    names: dict[str, str] = dict.fromkeys((*COLUMNS, *OF_WORLD), "")
    memory = jax.eval_shape(lambda: agent.replay.init(agent.spec, agent.num_envs))
    for name, learner in agent.learners.items():

        def update(state: Any, params: Params, memory: Any, key: Any, of: Any = learner) -> Any:
            drawing, updating = jax.random.split(key)
            return of.update(state, params, agent._batch(memory, of, params, drawing), updating)

        result = _traced(learner, "update", update, states[name], params, memory, key)
        if not isinstance(result, tuple) or len(result) != 2:
            raise PartError(f"{Own(learner).at('update')}: {_returned(result, 'state, metrics')}")
        _check_metrics(learner, "update", result[1], names)
        _check_state(learner, "update", states[name], result[0])
    env = jax.eval_shape(agent.episode.reset, key)
    for controller in controllers:
        _check_members(controller, "controller")
        greedy = _called(controller, "greedy", controller.greedy)
        if not callable(getattr(greedy, "act", None)):
            got = f"returned {_words(greedy)}; it must be a controller"
            raise PartError(f"{Own(controller).at('greedy')}: {got}")
        for each in [controller] if greedy is controller else [controller, greedy]:
            _check_acting(each, agent, params, env, {**names} if each is controller else {})


def _check_model(part: Any, spec: Spec, key: Any) -> None:
    """Raise PartError unless `lift` and `step` of a model give planning states [n]."""
    obs, u = (jax.ShapeDtypeStruct((size,), jnp.float32) for size in (spec.obs, spec.act))
    params = _shapes(part, "init", lambda key: part.init(key, spec), key)
    x = _shapes(part, "lift", part.lift, params, obs)
    after = _shapes(part, "step", part.step, params, x, u)
    if getattr(x, "ndim", 1) != 1:
        raise PartError(f"{Own(part).at('lift')}: returned {_words(x)}; it must be float32[n]")
    if _leaves(x) != _leaves(after):
        must = f"it must be {_words(x)}, as lift returned"
        raise PartError(f"{Own(part).at('step')}: returned {_words(after)}; {must}")


def _check_acting(
    part: Any, agent: Any, params: Params, env: EnvState, names: dict[str, str]
) -> None:
    """Raise PartError unless the controller `part` gives an action, its state and metrics."""
    key = jax.eval_shape(lambda: jax.random.key(0))
    state = _shapes(part, "init", lambda: part.init(agent.spec))

    def act(params: Params, state: Any, env: EnvState, key: Any) -> Any:
        return part.act(params._replace(world=env), state, env.obs, key)

    result = _traced(part, "act", act, params, state, env, key)
    at = Own(part).at("act")
    if not isinstance(result, tuple) or len(result) != 3:
        raise PartError(f"{at}: {_returned(result, 'action, state, metrics')}")
    wanted = jax.ShapeDtypeStruct((agent.spec.act,), jnp.float32)
    if _words(result[0]) != _words(wanted):
        must = f"it must be {_words(wanted)} in [-1, 1]"
        raise PartError(f"{at}: returned the action {_words(result[0])}; {must}")
    _check_state(part, "act", state, result[1])
    _check_metrics(part, "act", result[2], names)


def _check_state(part: Any, method: str, before: Any, after: Any) -> None:
    """Raise PartError unless a state is as `init` gave it, in structure, shapes and types."""
    one, two = _leaves(before), _leaves(after)
    at = Own(part).at(method)
    if one == two and jax.tree.structure(before) != jax.tree.structure(after):
        raise PartError(f"{at}: returned a state of another structure than init")
    for name in (*one, *two):
        if one.get(name) != two.get(name):
            gives = [
                f"state{name} {of[name]}" if name in of else f"no state{name}" for of in (two, one)
            ]
            raise PartError(f"{at}: returned {gives[0]}, and init {gives[1]}; both must be equal")


def _check_metrics(part: Any, method: str, metrics: Any, names: dict[str, str]) -> None:
    """Raise PartError unless metrics are numbers by name, with names that no other part has.

    names: those before, with their class; gets the new ones.
    """
    if not isinstance(metrics, Mapping):
        must = "it must be a dict of numbers"
        raise PartError(f"{Own(part).at(method)}: returned metrics {_words(metrics)}; {must}")
    for name in metrics:
        if name in names and _of_user(part):
            line = f"metric {name}: {names[name] or 'every row'} has it, too; write mine/{name}"
            raise PartError(f"{Own(part).at(method)}: {line}")
        names[name] = type(part).__name__


def _traced(part: Any, method: str, call: Callable[..., Any], *arguments: Any) -> Any:
    """Shapes of what `call` returns, traced twice.

    Raises:
        PartError: if the two differ, as NumPy or Python drew numbers.
    """

    def judged(*arguments: Any) -> Any:
        result = call(*arguments)
        metrics = result[-1] if isinstance(result, tuple) else None
        for name, value in metrics.items() if isinstance(metrics, Mapping) else ():
            if not isinstance(value, (jax.Array, np.generic, np.ndarray, int, float)):
                line = f"metric {name} is {_words(value)}; it must be a number, float32[]"
                raise PartError(f"{Own(part).at(method)}: {line}")
        return result

    programs = [jax.jit(partial(judged)) for _ in range(2)]  # two functions: neither is kept
    both = [_called(part, method, each.trace, *arguments) for each in programs]
    first, second = (f"{each.jaxpr}{[*map(str, each.jaxpr.consts)]}" for each in both)
    if _of_user(part) and first != second:
        raise PartError(
            f"{Own(part).at(method)}: gives other numbers when it is traced again: what NumPy or "
            "Python draws is a constant of the compiled program; use jax.random, with the key"
        )
    return both[0].out_info


def _shapes(part: Any, method: str, call: Callable[..., Any], *arguments: Any) -> Any:
    """Shapes of what `call` returns."""
    return _called(part, method, jax.eval_shape, call, *arguments)


def _called(part: Any, method: str, call: Callable[..., Any], *arguments: Any) -> Any:
    """What `call` returns; its errors name the user's part and the line."""
    mine = Own(next(_mine(part), part))
    try:
        return call(*arguments)
    except UsageError:
        raise
    except FAULTS as error:
        line = user_line(error)
        if line is None and isinstance(error, AttributeError) and _of_user(error.obj):
            line = f"{Own(error.obj).at()} has no {error.name}{_where(error.name)}"
        line = line or f"{mine.at()}: {one_line(error)}"
        raise PartError(f"{line.rstrip('.')}; in {type(part).__name__}.{method}") from error


def _where(method: str | None) -> str:
    """The protocols that say what a method is."""
    kinds = {name: getattr(protocols, name) for name in protocols.__all__}
    has = {
        name: {*dir(kind), *getattr(kind, "__annotations__", ())} for name, kind in kinds.items()
    }
    names = [name for name in has if method in has[name]]
    return f"; see {', '.join(f'protocols.{name}' for name in names)}" if names else ""


def _of_user(part: Any) -> bool:
    """Whether the class of a part is of the user's code."""
    kind = part if isinstance(part, type) else type(part)
    return kind.__module__.partition(".")[0] not in OTHERS


def _mine(part: Any) -> Iterator[Any]:
    """The parts of the user's in a part, itself first; of worlds none."""
    if isinstance(part, list | tuple | dict):
        for each in part.values() if isinstance(part, dict) else part:
            yield from _mine(each)
    elif is_dataclass(part) and not hasattr(part, "reset"):
        if _of_user(part):
            yield part
        for field in fields(part):
            yield from _mine(getattr(part, field.name, None))


def _leaves(tree: Any) -> dict[str, str]:
    """Path of each leaf -> its type, such as float32[2]."""
    paths = jax.tree_util.tree_leaves_with_path(tree)
    return {jax.tree_util.keystr(path): _words(leaf) for path, leaf in paths}


def _words(value: Any) -> str:
    """float32[2], or the kind of a Python value."""
    if hasattr(value, "shape") and hasattr(value, "dtype"):
        return f"{value.dtype}{list(value.shape)}"
    return "None" if value is None else f"a {type(value).__name__}"


def _returned(result: Any, must: str) -> str:
    """What a method returned that must return several things."""
    got = f"a tuple of {len(result)}" if isinstance(result, tuple) else _words(result)
    return f"returned {got}; it must be ({must})"
