"""What the parts of a method must be, checked before a run: JAX traces them, nothing is compiled.

Each part has the members of the protocol of the field that holds it, and what learners give fits
what parts use. What a part of the user's gives is compared with the protocol, and a whole decision
and update are traced where a method has one; a run traces those of the others anyway.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import jax
import jax.numpy as jnp

from hybrid_rl.core import history, lifting
from hybrid_rl.data.trained import SavedPolicy
from hybrid_rl.errors import SourceOf
from hybrid_rl.fields import FieldError
from hybrid_rl.protocols import Controller, Features, Learner, Model, Objective, UniformLearner
from hybrid_rl.protocols.contract import Contract, has_users, leaves, of_user, parts
from hybrid_rl.types import Params, Spec

FIRST = {Model, Features}  # parts that learners use when they begin
ROLES = {"model": Model, "objective": Objective}  # of a field without a type
OWNED = tuple(name for name in Params._fields if name not in ("decisions", "world"))
LEARNED = {"model", "reward", "policy", "critic"}  # fields of Params with parts of their own


def needs_world(controller: Any) -> bool:
    """Whether a controller plans from the state of the world, where a model in it starts."""
    return any(lifting.is_world(part) for *_, part in parts(controller))


def check_members(agent: Any) -> None:
    """Check that controller and learners have the methods and the fields of their protocols."""
    if agent.replay.num_demonstrated(agent.num_envs):
        agent.episode.check_demonstrations()
    Contract(agent.controller, Controller, agent.spec).check_members()
    owners: dict[str, str] = {}
    for name, learner in agent.learners.items():
        of = Contract(learner, _kind(learner), agent.spec)
        of.check_members()
        if learner.data not in ("uniform", "latest"):
            of.refuse("", f'data is {learner.data!r}; it must be "uniform" or "latest"')
        if not isinstance(learner.owns, tuple) or not {*learner.owns} <= {*OWNED}:
            must = f"it must be a tuple of fields of Params: {', '.join(OWNED)}"
            of.refuse("", f"owns is {learner.owns!r}; {must}")
        for field in learner.owns:
            if field in owners:
                both = f"{owners[field]} and {name}"
                raise ValueError(f"learners: {both} both learn params.{field}; keep one")
            owners[field] = name


def check(agent: Any, controllers: Iterable[Any]) -> None:
    """Check the parts of an Agent, and the controllers that act with what it learns."""
    controllers = list({id(each): each for each in controllers}.values())  # full may be policy
    whole = [*controllers, *agent.learners.values()]
    for of in [*_contracts(whole, agent.seen)]:
        of.check_members()
        if FIRST & {*of.protocol.__mro__} and of_user(of.part):
            of.check()
    learned, learning = {}, []
    for learner in agent.learners.values():
        own = lifting.lifted_spec(agent._lifting(learner), agent.seen)
        of = Contract(learner, _kind(learner), own)
        of.check()
        given = of.values["owned"]
        if {*given} != {*learner.owns}:
            line = f"returned {sorted(given)}; it must be a dict of what it owns, {learner.owns}"
            of.refuse("params", line)
        learned |= given
        learning.append(of)
    owned = {field: learner for learner in agent.learners.values() for field in learner.owns}
    model = getattr(owned.get("model"), "model", None)
    check_parameters(whole, learned, lifting.lifted_spec(model, agent.seen))
    if not has_users(whole):
        return
    params = Params(**learned)._replace(decisions=jax.ShapeDtypeStruct((), jnp.int32))
    memory = jax.eval_shape(lambda: agent.replay.init(agent.spec, agent.num_envs))
    for of in learning:
        of.values["Params"] = params
        of.values["batch"] = jax.eval_shape(
            lambda *given, of=of: agent._batch(given[0], of.part, *given[1:]),
            *(memory, params, of.values["key"]),
        )
        of.trace("update")
    check_acting(agent.episode, controllers, whole, params)


def check_acting(
    episode: Any, controllers: Iterable[Any], whole: Iterable[Any], params: Params
) -> None:
    """Raise PartError unless parts of the user's fit their protocols, and the controllers act."""
    whole, env = [*whole], jax.eval_shape(episode.reset, jax.random.key(0))
    params = params._replace(world=env)
    seen = history.seen(episode.spec, episode.history)
    obs = jax.ShapeDtypeStruct((seen.obs,), env.obs.dtype)
    model = next((part for _, name, _, part in parts(whole) if name == "model" and part), None)
    spec = lifting.lifted_spec(None if needs_world(model) else model, seen)
    for of in _contracts(whole, spec):
        if of_user(of.part) and not (FIRST | {Learner}) & {*of.protocol.__mro__}:
            own = getattr(of.owner, "model", None) or model
            of.values["Params"] = params
            of.values["x"] = jax.eval_shape(
                lambda p, obs, own=own: obs if own is None else lifting.start(own, p, obs),
                *(params, obs),
            )
            of.check()
    for controller in controllers:
        Contract(controller, Controller, episode.spec, values={"Params": params}).check()
        greedy = SourceOf(controller).blamed("greedy", controller.greedy)
        Contract(greedy, Controller, episode.spec, values={"Params": params}).check()


def _kind(learner: Any) -> type:
    """The protocol of a learner."""
    return Learner if getattr(learner, "data", "") == "latest" else UniformLearner


def _contracts(whole: Any, spec: Spec) -> Iterator[Contract]:
    """The contract of each part in these parts with the protocol of its field; inner ones first.

    A user's field without a type has the protocol of its name. Mixtures and worlds have none.
    """
    for owner, name, protocol, part in reversed([*parts(whole)]):
        protocol = protocol or (ROLES.get(name) if of_user(owner) else None)
        if protocol is not None and not any(getattr(part, of, None) for of in ("split", "reset")):
            yield Contract(part, protocol, spec, owner=owner, name=name)


def check_parameters(whole: Any, learned: Mapping[str, Any], spec: Spec) -> None:
    """Raise ValueError for a policy, model or the like that no learner trains, or another form."""
    inside: set[int] = set()  # parts with a field of Params for themselves, and what is in them
    for owner, name, _, part in parts(whole):
        held = id(owner) in inside or isinstance(owner, SavedPolicy)
        own = name in LEARNED and callable(getattr(part, "init", None))
        if held or own:
            inside.add(id(part))
        if held or not own:
            continue
        needs = leaves(jax.eval_shape(lambda key, of=part: of.init(key, spec), jax.random.key(0)))
        has = leaves(learned.get(name))
        uses = "learns with" if callable(getattr(owner, "update", None)) else "acts by"
        line = f"{name}={type(part).__name__}: {type(owner).__name__} {uses} it"
        if needs and name not in learned:
            raise FieldError(owner, name, "no learner trains it", "learner")
        if of_user(owner) or of_user(part):
            continue
        for at in needs:
            if needs[at] != has.get(at):
                differ = f"{needs[at]} in it and {has.get(at)} in the learner's"
                raise ValueError(f"{line}, but {at} is {differ}; give both the same {name}")
