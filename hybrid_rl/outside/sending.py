"""Actions that leave a compiled program before it ends.

    u = send(u, ticket, axis)    in the program
    u = sent.next(result)        on the host, meanwhile

The program does not wait for the host. Each device sends those of its own learners.
"""

from functools import cache
from itertools import count
from queue import Empty, SimpleQueue
from typing import Any, Self

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.experimental import io_callback

from hybrid_rl.envs.mujoco import xla_callback

TARGET = "hybrid_rl.outside.sending"
POLL_S = 1.0  # [s] after which it is asked whether the program failed before it sent
_boxes: dict[int, SimpleQueue] = {}  # of open mailboxes, by ticket
_tickets = count()


def send(u: Array, ticket: Array, axis: str) -> Array:
    """`u` [S, E, m], once the host has it; axis: of the mesh, over which S is sharded.

    On a CPU the program must use the result, or XLA drops the call: JAX does not know its effect,
    with which a call of the program would take a millisecond longer.
    """
    m = u.shape[-1]
    marks = jnp.stack([jax.lax.axis_index(axis), ticket]).astype(u.dtype)
    flat = u.reshape(-1, m)
    x = jnp.concatenate([flat, jnp.broadcast_to(marks, (len(flat), 2))], axis=1)
    like = jax.ShapeDtypeStruct(x.shape, x.dtype)
    if jax.default_backend() == "cpu":
        _registered()
        y = jax.ffi.ffi_call(TARGET, like)(x)
    else:
        y = io_callback(_posted, like, x)
    return y[:, :m].reshape(u.shape)


class Mailbox:
    """Gets what programs send with its `ticket`; what comes after its block is dropped."""

    def __init__(self, parts: int) -> None:
        """parts: devices that send."""
        self.ticket = next(_tickets) % 2**24  # a whole number in float32
        self.parts, self._box = parts, SimpleQueue()

    def __enter__(self) -> Self:
        _boxes[self.ticket] = self._box
        return self

    def __exit__(self, *_: object) -> None:
        del _boxes[self.ticket]

    def next(self, result: Any) -> np.ndarray:
        """The actions [S * E, m] of the next program, whose result is `result`.

        Raises what the program raised before it sent.
        """
        parts: list[np.ndarray] = []
        while len(parts) < self.parts:
            try:
                parts.append(self._box.get(timeout=POLL_S))
            except Empty:
                leaves = jax.tree.leaves(result)
                if all(leaf.is_ready() for leaf in leaves) and self._box.empty():
                    jax.block_until_ready(leaves)
                    raise RuntimeError("a program ended without sending its actions") from None
        parts.sort(key=lambda part: part[0, -1])
        return np.concatenate(parts)[:, :-1]


@cache
def _registered() -> None:
    def post(x: np.ndarray, y: np.ndarray) -> None:
        y[:] = _posted(x)

    xla_callback.register(TARGET, post)


def _posted(x: Any) -> np.ndarray:
    """x [N, m + 2], after its actions and the part were put into the box of its ticket."""
    x = np.array(x)
    box = _boxes.get(int(x[0, -1]))
    if box is not None:
        box.put(x[:, :-1])
    return x
