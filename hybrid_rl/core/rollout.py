"""Roll-outs of a model, which all planners share, and the price of where its members disagree.

    u_t, c_{t+1} = act(c_t, x_t, a_t),   x_{t+1} = f(x_t, u_t)            a_t: what was planned
    S = J(x, u) - sum_t (price d_t + cost_t)            -inf where that is not finite

d_t is the mean over the entries of the state of the ensemble's disagreement, in running standard
deviations of the change. Without this price plans lead to where the model is wrong.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core.batching import prepend, repeat
from hybrid_rl.protocols import Model
from hybrid_rl.types import EnvState, Path, Return

UNROLLED = 32  # longest loop that a GPU unrolls completely [decisions]
TURNS = 4  # steps in a turn of other loops
Act = Callable[[Any, Any, Any], tuple[Array, Any, Any]]  # c, x, a -> u, the next c, a note


class Rolled(NamedTuple):
    """A path of a model."""

    path: Path  # x [T+1, ...]; u [T, ...]
    steps: Any  # [T, ...] notes of the steps
    acts: Any  # [T, ...] notes of the actions


class Priced(NamedTuple):
    """A path of a model with members."""

    score: Array  # [] S
    value: Array  # [] J
    disagreement: Array  # [] sum_t d_t
    path: Path  # x [T+1, n]; u [T, m]
    notes: Any  # [T, ...]


def scan_unroll(length: int, x: Any = None) -> int:
    """The unroll factor of a loop of `length` steps from x; 1 on a world, which compiles slowly.

    Each turn of a loop costs a GPU launches; XLA takes minutes to compile 120 steps, though. On a
    CPU longer turns are slower, and where a step uses its state twice, XLA computes each of them
    again for every use of its result: 2^length times.
    """
    if isinstance(x, EnvState):
        return 1
    whole = length <= UNROLLED and jax.default_backend() != "cpu"
    return length if whole else min(length, TURNS)


def roll(
    step: Callable[[Any, Array], tuple[Any, Any]], act: Act, x: Any, along: Any, carry: Any = None
) -> Rolled:
    """The path from x, any tree of arrays, along the plan `along` [T, ...], any tree.

    `step(x, u)` gives the next x and a note, `act(carry, x, a)` an action, its next carry and a
    note.
    """

    def forward(state: tuple[Any, Any], a: Any) -> tuple[Any, Any]:
        x, carry = state
        u, carry, acted = act(carry, x, a)
        after, stepped = step(x, u)
        return (after, carry), (after, u, stepped, acted)

    length = len(jax.tree.leaves(along)[0])
    unroll = scan_unroll(length, x)
    xs, us, steps, acts = jax.lax.scan(forward, (x, carry), along, unroll=unroll)[1]
    return Rolled(Path(prepend(x, xs), us), steps, acts)


def predict_members(model: Model, params: Any, x: Array, u: Array) -> tuple[Array, Array, Array]:
    """The next state [n], the disagreement [n] or [], and every member's next state [members, n].

    A model that is no ensemble counts as one member. params: of the model.
    """
    each = getattr(model, "predictions", None)
    if each is not None:
        return each(params, x, u)
    after = model.step(params, x, u)
    return after, jnp.zeros(()), repeat(after, 1)


def priced(
    model: Model,
    params: Any,
    value: Return,
    price: float,
    policy: Callable[[Any, Array], Array],
    x: Any,
    plan: Array,
    member: Array | None = None,
    note: Callable[[Any, Array, Any], tuple[Any, Any]] = lambda x, u, each: (0.0, None),
) -> Priced:
    """The path from x [n] of the actions u_t = policy(x_t, a_t) for the plan a [T, m].

    By the mean of the ensemble, or by one `member`. params: of the model. value: J. note: cost []
    and a note of x, u and the next states [members, n] by all members.
    """

    def step(x: Any, u: Array) -> tuple[Any, tuple[Array, Any]]:
        after, apart, each = predict_members(model, params, x, u)
        noted = jnp.mean(apart), note(x, u, each)
        return after if member is None else each[member], noted

    def act(carry: None, x: Any, a: Array) -> tuple[Array, None, None]:
        return policy(x, a), None, None

    path, (apart, (costs, notes)), _ = roll(step, act, x, plan)
    J, disagreement = value(path), apart.sum()
    score = J - price * disagreement - costs.sum()
    return Priced(jnp.where(jnp.isfinite(score), score, -jnp.inf), J, disagreement, path, notes)
