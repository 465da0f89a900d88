"""What the parts of a method must be, checked before a run: JAX traces them, nothing is compiled.

What acts must have a learner. A method of the library's parts alone is not checked further. Of one
with a part of the user's, controllers and learners are traced, and compared with
`protocols.Controller` and `protocols.Learner`: shapes of actions, states and metrics, the fields of
`Params` that a learner owns; so is the return J of an objective of the user's. What goes wrong is
one line that begins with the user's file, as in `envs.contract` for worlds.
"""

from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp

from hybrid_rl.core import lifting
from hybrid_rl.core.batching import repeat
from hybrid_rl.errors import PartError, SourceOf
from hybrid_rl.training.owners import check_owners
from hybrid_rl.training.traced import call, leaves, of_user, parts, shapes, trace, users, words
from hybrid_rl.types import EnvState, Params, Path, Spec

ROLES = {  # kind of a part -> its methods and what they take
    "controller": {"init": ("spec",), "act": ("params", "state", "obs", "key"), "greedy": ()},
    "learner": {
        "init": ("key", "spec"),
        "params": ("state",),
        "update": ("state", "params", "batch", "key"),
    },
}
OF_AGENT = {  # field of an Agent -> what such a part has, and how one is made
    "episode": ("env", "Episode(env, steps)"),
    "controller": ("act", "a controller, such as PolicyController(policy)"),
    "learners": ("items", 'a dict, such as {"policy": SAC(policy, critic)}'),
    "replay": ("within", "Replay()"),
}
MODEL = ("init", "lift", "step")  # what makes a part a model
FIELDS = {  # of a learner, by its data
    "uniform": ("batch_size", "batches", "updates", "during_random"),
    "latest": ("every",),
}
OWNED = tuple(name for name in Params._fields if name not in ("decisions", "world"))
OF_WORLD = ("world/reward", "world/obs", "world/action")
COLUMNS = ("step", "seed", "wall_s")  # of a row, beside its metrics


def check_members(agent: Any) -> None:
    """Check that parts of the user's have the methods and the fields of their roles.

    Raises:
        PartError: in one line, for what is missing or has another form.
        ValueError: for a part of another kind, two learners of one field of `Params`, or
            demonstrations whose rewards are not those of the run.
    """
    for name, (has, must) in OF_AGENT.items():
        if not (name == "controller" and of_user(agent.controller)):
            _check_kind(name, getattr(agent, name), has, must)
    if agent.replay.num_demonstrated(agent.num_envs):
        agent.episode.check_demonstrations()
    _check_members(agent.controller, "controller")
    owners: dict[str, str] = {}
    for name, learner in agent.learners.items():
        if not of_user(learner):
            _check_kind(f"learners[{name!r}]", learner, "owns", "a learner, such as SAC")
        _check_members(learner, "learner")
        for field in learner.owns:
            if field in owners:
                both = f"{owners[field]} and {name}"
                raise ValueError(f"learners: {both} both learn params.{field}; keep one")
            owners[field] = name


def _check_kind(name: str, part: Any, has: str, must: str) -> None:
    """Raise ValueError for a class, or for a part that lacks what its kind has."""
    if isinstance(part, type) or not hasattr(part, has):
        kind = part if isinstance(part, type) else type(part)
        raise ValueError(f"Agent: {name} is {kind.__name__}; give {must}")


def _check_members(part: Any, role: str) -> None:
    """Raise PartError for a method or a field that a part of the user's lacks."""
    if not of_user(part):
        return
    own = SourceOf(part)
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
    owned = sum((each.owns for each in agent.learners.values()), ())
    check_owners([*controllers, *agent.learners.values()], owned, agent.spec)
    if not any(users([*controllers, *agent.learners.values()])):
        return
    key = jax.eval_shape(lambda: jax.random.key(0))
    for part in users([*controllers, *agent.learners.values()]):
        if all(hasattr(part, method) for method in MODEL):
            _check_model(part, agent.spec, key)
    states, learned = {}, {}
    for name, learner in agent.learners.items():
        states[name] = shapes(learner, "init", lambda key, of=learner: agent._first(of, key), key)
        given = shapes(learner, "params", learner.params, states[name])
        if not isinstance(given, Mapping) or {*given} != {*learner.owns}:
            got = f"{list(given)}" if isinstance(given, Mapping) else words(given)
            must = f"it must be a dict of what it owns, {list(learner.owns)}"
            raise PartError(f"{SourceOf(learner).at('params')}: returned {got}; {must}")
        learned |= given
    params = Params(**learned)._replace(decisions=jax.ShapeDtypeStruct((), jnp.int32))
    names: dict[str, str] = dict.fromkeys((*COLUMNS, *OF_WORLD), "")
    memory = jax.eval_shape(lambda: agent.replay.init(agent.spec, agent.num_envs))
    for name, learner in agent.learners.items():

        def update(state: Any, params: Params, memory: Any, key: Any, of: Any = learner) -> Any:
            drawing, updating = jax.random.split(key)
            return of.update(state, params, agent._batch(memory, of, params, drawing), updating)

        result = trace(learner, "update", update, states[name], params, memory, key)
        if not isinstance(result, tuple) or len(result) != 2:
            raise PartError(
                f"{SourceOf(learner).at('update')}: {_returned(result, 'state, metrics')}"
            )
        _check_metrics(learner, "update", result[1], names)
        _check_state(learner, "update", states[name], result[0])
    try:
        check_controllers(controllers, agent, params, names)
    except PartError as error:
        if "NoneType" in str(error):  # perhaps what no learner gives
            check_owners(controllers, owned, agent.spec, every=True)
        raise


def check_controllers(
    controllers: Iterable[Any], agent: Any, params: Params, names: dict[str, str]
) -> None:
    """Raise PartError unless controllers act, and objectives give numbers; names: of metrics."""
    env = jax.eval_shape(agent.episode.reset, jax.random.key(0))
    for owner in (*agent.learners.values(), *controllers):
        _check_objectives(owner, agent, params, env)
    for controller in controllers:
        _check_members(controller, "controller")
        greedy = call(controller, "greedy", controller.greedy)
        if not callable(getattr(greedy, "act", None)):
            got = f"returned {words(greedy)}; it must be a controller"
            raise PartError(f"{SourceOf(controller).at('greedy')}: {got}")
        for each in [controller] if greedy is controller else [controller, greedy]:
            _check_acting(each, agent, params, env, {**names} if each is controller else {})


def _check_model(part: Any, spec: Spec, key: Any) -> None:
    """Raise PartError unless `lift` and `step` of a model give planning states [n]."""
    obs, u = (jax.ShapeDtypeStruct((size,), jnp.float32) for size in (spec.obs, spec.act))
    params = shapes(part, "init", lambda key: part.init(key, spec), key)
    x = shapes(part, "lift", part.lift, params, obs)
    after = shapes(part, "step", part.step, params, x, u)
    if getattr(x, "ndim", 1) != 1:
        raise PartError(f"{SourceOf(part).at('lift')}: returned {words(x)}; it must be float32[n]")
    if leaves(x) != leaves(after):
        must = f"it must be {words(x)}, as lift returned"
        raise PartError(f"{SourceOf(part).at('step')}: returned {words(after)}; {must}")


def _check_acting(
    part: Any, agent: Any, params: Params, env: EnvState, names: dict[str, str]
) -> None:
    """Raise PartError unless the controller `part` gives an action, its state and metrics."""
    key = jax.eval_shape(lambda: jax.random.key(0))
    state = shapes(part, "init", lambda: part.init(agent.spec))

    def act(params: Params, state: Any, env: EnvState, key: Any) -> Any:
        return part.act(params._replace(world=env), state, env.obs, key)

    result = trace(part, "act", act, params, state, env, key)
    at = SourceOf(part).at("act")
    if not isinstance(result, tuple) or len(result) != 3:
        raise PartError(f"{at}: {_returned(result, 'action, state, metrics')}")
    wanted = jax.ShapeDtypeStruct((agent.spec.act,), jnp.float32)
    if words(result[0]) != words(wanted):
        must = f"it must be {words(wanted)} in [-1, 1]"
        raise PartError(f"{at}: returned the action {words(result[0])}; {must}")
    _check_state(part, "act", state, result[1])
    _check_metrics(part, "act", result[2], names)


def _check_objectives(owner: Any, agent: Any, params: Params, env: EnvState) -> None:
    """Raise PartError unless the user's objectives in a controller or a learner give numbers.

    J [], and with `reward_to_go` S [T+1], of T decisions without motion.
    """
    key, every = jax.eval_shape(lambda: jax.random.key(0)), [*parts(owner)]
    model = next((each for each in every if all(hasattr(each, name) for name in MODEL)), None)
    T = next((each.horizon for each in every if isinstance(getattr(each, "horizon", None), int)), 5)
    for part in (each for each in users(owner) if hasattr(each, "prepare")):

        def judged(params: Params, env: EnvState, key: Any, name: str, of: Any = part) -> Any:
            params, u = params._replace(world=env), jnp.zeros((T, agent.spec.act))
            x = env.obs if model is None else lifting.start(model, params, env.obs)
            path = Path(repeat(x, T + 1), u)
            if name != "prepare":
                return getattr(of, name)(params, path)
            return of.prepare(params, of.init(agent.spec), x, u[0], key)[0](path)

        for name, size in (("prepare", ()), ("reward_to_go", (T + 1,))):
            if not hasattr(part, name):
                continue
            got = shapes(part, name, partial(judged, name=name), params, env, key)
            must = words(jax.ShapeDtypeStruct(size, jnp.float32))
            if words(got) != must:
                what = "J of a path" if name == "prepare" else "it"
                line = f"{what} is {words(got)}; it must be {must}, with T = {T} decisions"
                raise PartError(f"{SourceOf(part).at(name)}: {line}")


def _check_state(part: Any, method: str, before: Any, after: Any) -> None:
    """Raise PartError unless a state is as `init` gave it, in structure, shapes and types."""
    one, two = leaves(before), leaves(after)
    at = SourceOf(part).at(method)
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
        raise PartError(f"{SourceOf(part).at(method)}: returned metrics {words(metrics)}; {must}")
    for name in metrics:
        if name in names and of_user(part):
            line = f"metric {name}: {names[name] or 'every row'} has it, too; write mine/{name}"
            raise PartError(f"{SourceOf(part).at(method)}: {line}")
        names[name] = type(part).__name__


def _returned(result: Any, must: str) -> str:
    """What a method returned that must return several things."""
    got = f"a tuple of {len(result)}" if isinstance(result, tuple) else words(result)
    return f"returned {got}; it must be ({must})"
