"""What controllers and learners of the library use must have the parameters that are learned."""

from collections.abc import Collection, Iterator
from dataclasses import fields, is_dataclass
from functools import partial
from typing import Any

import jax

from hybrid_rl.core.lifting import lifted_spec
from hybrid_rl.data.trained import SavedPolicy
from hybrid_rl.training.traced import leaves, of_user, shapes
from hybrid_rl.types import Spec

OF_PARAMS = {"model", "reward", "policy", "critic"}  # fields of Params with parts of their own


def check_owners(parts: Any, owned: Collection[str], spec: Spec, every: bool = False) -> None:
    """Check that what the library's parts of controllers and learners use has parameters.

    parts: any parts, in lists, dictionaries and each other. owned: the fields of Params that
    learners give. every: also what the user's parts act by, which may have parameters elsewhere.

    Raises:
        ValueError: for a policy, a model or the like that has parameters, which no learner gives.
    """
    for owner, name, part in _used(parts):
        if name in owned or (of_user(owner) and not every):
            continue
        if _parameters(part, spec):
            uses = "learns with" if hasattr(owner, "update") else "acts by"
            line = f"{type(owner).__name__} {uses} it, and no learner of this method trains it"
            remedy = f"leave {name}= out, or choose a method that learns a {name}"
            raise ValueError(f"{name}={type(part).__name__}: {line}; {remedy}")


def check_fit(parts: Any, agent: Any) -> None:
    """Check that what the library's parts of controllers and learners use has such parameters.

    parts: as in `check_owners`. agent: the Agent whose learners learn the parameters.

    Raises:
        ValueError: for a policy, a model or the like whose parameters have other shapes.
    """
    model, learned = None, {}
    for learner in agent.learners.values():
        state = jax.eval_shape(partial(agent._first, learner), jax.random.key(0))
        learned |= jax.eval_shape(learner.params, state)
        model = getattr(learner, "model", None) if "model" in learner.owns else model
    spec = lifted_spec(model, agent.spec)
    for owner, name, part in _used(parts):
        if name not in learned or of_user(owner) or of_user(part):
            continue
        needs, has = _parameters(part, spec), leaves(learned[name])
        for at in needs:
            if needs[at] != has.get(at):
                differ = f"{needs[at]} in it and {has.get(at)} in the learner's"
                line = f"{type(owner).__name__} uses it, but {at} is {differ}"
                raise ValueError(f"{name}={type(part).__name__}: {line}; give both the same {name}")


def _parameters(part: Any, spec: Spec) -> dict[str, str]:
    """Path of each parameter of a part -> its type."""
    return leaves(shapes(part, "init", lambda key: part.init(key, spec), jax.random.key(0)))


def _used(parts: Any) -> Iterator[tuple[Any, str, Any]]:
    """(owner, field, part) of what `parts` use, which may have parameters."""
    if isinstance(parts, dict | list | tuple):
        for each in parts.values() if isinstance(parts, dict) else parts:
            yield from _used(each)
    if not is_dataclass(parts) or isinstance(parts, type | SavedPolicy):
        return
    for name in (field.name for field in fields(parts)):
        part = getattr(parts, name)
        if name in OF_PARAMS and hasattr(part, "init"):
            yield parts, name, part
        else:
            yield from _used(part)
