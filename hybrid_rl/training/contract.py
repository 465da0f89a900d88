"""What the parts of a method must be, checked before a run: JAX traces them, nothing is compiled.

Each part has the members of the protocol of the field that holds it, and what learners give fits
what parts use. What a part of the user's gives is compared with the protocol, and a whole decision
and update are traced where a method has one; a run traces those of the others anyway.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import jax
import jax.numpy as jnp

from hybrid_rl.core import lifting
from hybrid_rl.data.trained import SavedPolicy
from hybrid_rl.errors import PartError
from hybrid_rl.protocols import (
    Controller,
    Features,
    LatestLearner,
    Model,
    Objective,
    UniformLearner,
)
from hybrid_rl.protocols.contract import (
    Contract,
    has_users,
    leaves,
    of_user,
    parts,
    signatures,
    words,
)
from hybrid_rl.types import Params

LEARNERS = {"uniform": UniformLearner, "latest": LatestLearner}
ROLES = {"model": Model, "objective": Objective}  # of a field without a type
OWNED = tuple(name for name in Params._fields if name not in ("decisions", "world"))
LEARNED = {"model", "reward", "policy", "critic"}  # fields of Params with parts of their own
LOGGED = ("step", "seed", "wall_s", "world/reward", "world/obs", "world/action")  # of every row


def needs_world(controller: Any) -> bool:
    """Whether a controller plans from the state of the world, where a model in it starts."""
    return any(callable(getattr(part, "start", None)) for *_, part in parts(controller))


def check_members(agent: Any) -> None:
    """Check that controller and learners have the methods and the fields of their protocols.

    Raises:
        PartError: in one line, for what is missing or has another form.
        ValueError: for two learners of one field of `Params`, or demonstrations whose rewards are
            not those of the run.
    """
    if agent.replay.num_demonstrated(agent.num_envs):
        agent.episode.check_demonstrations()
    values = {"spec": agent.spec}
    Contract(agent.controller, Controller, values).check_members()
    owners: dict[str, str] = {}
    for name, learner in agent.learners.items():
        of = Contract(learner, LEARNERS.get(getattr(learner, "data", ""), UniformLearner), values)
        of.check_members()
        if learner.data not in LEARNERS:
            line = f'data is {learner.data!r}; it must be "uniform" or "latest"'
            raise PartError(f"{of.source.at()}: {line}")
        if not isinstance(learner.owns, tuple) or not {*learner.owns} <= {*OWNED}:
            must = f"it must be a tuple of fields of Params: {', '.join(OWNED)}"
            raise PartError(f"{of.source.at()}: owns is {learner.owns!r}; {must}")
        for field in learner.owns:
            if field in owners:
                both = f"{owners[field]} and {name}"
                raise ValueError(f"learners: {both} both learn params.{field}; keep one")
            owners[field] = name


def check(agent: Any, controllers: Iterable[Any]) -> None:
    """Check the parts of an Agent, and the controllers that act with what it learns.

    Raises:
        PartError: in one line: the file and line, what a method gives, and what it must give.
        ValueError: for a part whose parameters no learner gives, or gives in another form.
    """
    controllers = list({id(each): each for each in controllers}.values())  # full may be policy
    whole = [*controllers, *agent.learners.values()]
    owned = {field: learner for learner in agent.learners.values() for field in learner.owns}
    contracts = [*_contracts(whole, agent.spec)]
    for of in contracts:
        of.check_members()
    check_owners(whole, owned, agent.spec)
    for of in contracts:
        if {Model, Features} & {*of.protocol.__mro__} and of_user(of.part):
            of.check()
    model = getattr(owned.get("model"), "model", None)
    spec, learned, learning = lifting.lifted_spec(model, agent.spec), {}, []
    for learner in agent.learners.values():
        own = lifting.lifted_spec(agent._lifting(learner), agent.spec)
        of = Contract(learner, LEARNERS[learner.data], {"spec": own}).check("init", "params")
        given = of.values["owned"]
        if not isinstance(given, Mapping) or {*given} != {*learner.owns}:
            line = f"returned {sorted(given)}; it must be a dict of what it owns, {learner.owns}"
            of.refuse("params", line)
        learned |= given
        learning.append(of)
    check_fit(whole, learned, spec)
    params = Params(**learned)._replace(decisions=jax.ShapeDtypeStruct((), jnp.int32))
    names: dict[str, str] = dict.fromkeys(LOGGED, "every row")
    if has_users(whole):
        memory = jax.eval_shape(lambda: agent.replay.init(agent.spec, agent.num_envs))
        for of in learning:
            of.values |= {"Params": params}
            of.values["batch"] = jax.eval_shape(
                lambda *given, of=of: agent._batch(given[0], of.part, *given[1:]),
                *(memory, params, of.values["key"]),
            )
            _check_names(of, of.trace("update", signatures(of.protocol)["update"], True), names)
    check_acting(agent, whole, params, names)


def check_acting(agent: Any, whole: Iterable[Any], params: Params, names: Any = ()) -> None:
    """Raise PartError unless parts fit their protocols, and controllers of the user's act.

    names: of metrics before those of the controllers -> their class.
    """
    whole, env = [*whole], jax.eval_shape(agent.episode.reset, jax.random.key(0))
    params = params._replace(world=env)
    model = next((part for _, name, _, part in parts(whole) if name == "model" and part), None)
    spec = lifting.lifted_spec(model if not needs_world(model) else None, agent.spec)
    for of in _contracts(whole, spec):
        others = {Model, Features, *LEARNERS.values()} & {*of.protocol.__mro__}
        if of_user(of.part) and not others:
            own = getattr(of.owner, "model", None)
            of.values["Params"] = params
            of.values["x"] = jax.eval_shape(
                lambda p, own=own: _start(own, model, p, env.obs), params
            )
            of.check()
    for controller in (each for each in whole if not callable(getattr(each, "update", None))):
        values = {"spec": agent.spec, "Params": params}
        of = Contract(controller, Controller, values)
        of.check_members()
        greedy = of.source.blamed("greedy", controller.greedy)
        if callable(getattr(greedy, "act", None)) is False:
            of.refuse("greedy", f"returned {words(greedy)}; it must be a controller")
        if has_users(whole):
            for each in (controller, greedy):
                of = Contract(each, Controller, values).check("init")
                acted = of.trace("act", signatures(Controller)["act"], True)
                _check_names(of, acted, {**dict(names)} if each is controller else {})


def _contracts(whole: Any, spec: Any) -> Iterator[Contract]:
    """The contract of each part in these parts with the protocol of its field; inner ones first.

    A field of the user's without a type has the protocol of its name.
    """
    for owner, name, protocol, part in reversed([*parts(whole)]):
        protocol = protocol or (ROLES.get(name) if of_user(owner) else None)
        if protocol is not None:
            yield Contract(part, protocol, {"spec": spec}, owner=owner, field=name)


def _start(own: Any, model: Any, params: Params, obs: Any) -> Any:
    """The planning state in which the paths of an objective begin."""
    model = model if own is None else own
    return obs if model is None else lifting.start(model, params, obs)


def _check_names(of: Contract, traced: Any, names: dict[str, str]) -> None:
    """Raise PartError for a metric of the user's with the name of another one."""
    for name in traced.out_info[-1]:
        if name in names and of_user(of.part):
            line = f"metric {name}: {names[name]} has it, too; write mine/{name}"
            raise PartError(f"{of.source.at()}: {line}")
        names[name] = type(of.part).__name__


def check_owners(whole: Any, owned: Mapping[str, Any], spec: Any) -> None:
    """Raise ValueError for a policy, model or the like with parameters that no learner gives."""
    for owner, name, part in _with_parameters(whole):
        if name not in owned and _parameters(part, spec):
            uses = "learns with" if callable(getattr(owner, "update", None)) else "acts by"
            line = f"{type(owner).__name__} {uses} it, and no learner of this method trains it"
            remedy = f"leave {name}= out, or choose a method that learns a {name}"
            raise ValueError(f"{name}={type(part).__name__}: {line}; {remedy}")


def check_fit(whole: Any, learned: Mapping[str, Any], spec: Any) -> None:
    """Raise ValueError for a policy, model or the like with parameters of another form."""
    for owner, name, part in _with_parameters(whole):
        if name not in learned or of_user(owner) or of_user(part):
            continue
        needs, has = _parameters(part, spec), leaves(learned[name])
        for at in needs:
            if needs[at] != has.get(at):
                differ = f"{needs[at]} in it and {has.get(at)} in the learner's"
                line = f"{type(owner).__name__} uses it, but {at} is {differ}"
                raise ValueError(f"{name}={type(part).__name__}: {line}; give both the same {name}")


def _parameters(part: Any, spec: Any) -> dict[str, str]:
    """Path of each parameter of a part -> its type."""
    return leaves(jax.eval_shape(lambda key: part.init(key, spec), jax.random.key(0)))


def _with_parameters(whole: Any) -> Iterator[tuple[Any, str, Any]]:
    """(owner, field, part) of what has a field of Params for itself; nothing in such a part."""
    inside: set[int] = set()
    for owner, name, _, part in parts(whole):
        if id(owner) in inside or isinstance(owner, SavedPolicy):
            inside.add(id(part))
        elif name in LEARNED and callable(getattr(part, "init", None)):
            inside.add(id(part))
            yield owner, name, part
