"""x = (o, v, h): a model whose state remembers what was seen and done.

    h_t = GRU(h_{t-1}, (o_t, v_t, u_{t-1})),   v_t = (o_t - o_{t-1}) / dt

An observation that lacks velocities or a load says more together with all that came before it than
with the last few: the network learns what to keep. The state at a history s of `core.history` is
that after its k - 1 decisions, from h = 0; a prediction takes one step more, so that imagined
decisions need no history. The inner model predicts o' at x; `h` learns what helps it, and what
tells the reward (`learners/model.py`).

Source: Cho et al. 2014, "Learning phrase representations using RNN encoder-decoder" (the GRU);
Hafner et al. 2019, "Learning latent dynamics for planning from pixels": a deterministic memory, in
which policies and planners act, learned by predictions alone.
"""

from typing import Any, cast

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.fields import Count, FieldError, part
from hybrid_rl.networks import MLP, apply
from hybrid_rl.protocols import Trainable
from hybrid_rl.types import Spec


@part
class Recurrent:
    """`model`, a single one or an ensemble, at states with a memory of `memory` numbers."""

    model: Trainable
    history: Count  # observations from which the memory is read
    memory: Count = 64

    def __post_init__(self) -> None:
        if self.history < 2:
            raise FieldError(self, "history", "must be 2 or more; give episode.history=16")

    @property
    def members(self) -> int:
        """Models in the ensemble."""
        return self.model.members

    @property
    def _gates(self) -> MLP:
        """The linear maps of a GRU, of what resets, what keeps and what is new."""
        return MLP((), 3 * self.memory)

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial parameters. The key is consumed."""
        for_model, for_cell = jax.random.split(key)
        assert spec.newest is not None
        moving = 2 * spec.newest  # o and v
        inner = self.model.init(for_model, spec._replace(obs=moving + self.memory))
        of_row, of_h = jax.random.split(for_cell)
        cell = {
            "row": self._gates.init(of_row, jnp.zeros(moving + spec.act)),
            "h": self._gates.init(of_h, jnp.zeros(self.memory)),
        }
        return {**inner, "weights": {"model": inner["weights"], "cell": cell}}

    def observe(self, params: dict[str, Any], obs: Array, next_obs: Array) -> dict[str, Any]:
        """Parameters with statistics of o and v in histories [B, s] and successors; h has none."""
        old = params["state"]
        moving = old.mean.size - self.memory
        x = jnp.pad(obs[:, :moving], ((0, 0), (0, self.memory)))
        new = self.model.observe(params, x, next_obs)
        state = jax.tree.map(
            lambda new, old: jnp.concatenate((new[:moving], old[moving:])) if new.ndim else new,
            new["state"],
            old,
        )
        return {**new, "state": state}

    def lift(self, params: dict[str, Any], obs: Array) -> Array:
        """x [n] after a history [s]."""
        o, dt = params["change"].mean.size, params["dt"]
        rows = obs[o:].reshape(self.history - 1, -1)  # v and u before it, newest first
        seen = obs[None, :o] - dt * (jnp.cumsum(rows[:, :o], 0) - rows[:, :o])
        rows = jnp.concatenate((seen, rows), 1)

        def onward(h: Array, row: Array) -> tuple[Array, None]:
            return self._remembered(params, h, row), None

        h = jax.lax.scan(onward, jnp.zeros(self.memory), self._seen(params, rows), reverse=True)[0]
        return jnp.concatenate((obs[: 2 * o], h))

    def step(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Mean of the next planning state [n]."""
        return self._after(params, x, u, self.model.step(self._inner(params), x, u))

    def draw(self, params: dict[str, Any], x: Array, u: Array, noise: Array, key: Array) -> Array:
        """Next planning states [B, n] for noise [B, n] ~ N(0, I). The key is consumed."""
        after = self.model.draw(self._inner(params), x, u, noise, key)
        return jax.vmap(self._after, (None, 0, 0, 0))(params, x, u, after)

    def predictions(self, params: dict[str, Any], x: Array, u: Array) -> tuple[Array, Array, Array]:
        """Mean of the next planning state [n], `disagreement` [o], every member's [members, n]."""
        mean, disagreement, each = cast(Any, self.model).predictions(self._inner(params), x, u)
        after = jax.vmap(self._after, (None, None, None, 0))(params, x, u, each)
        return self._after(params, x, u, mean), disagreement, after

    def disagreement(self, params: dict[str, Any], x: Array, u: Array) -> Array:
        """Standard deviation [o] of the members' predictions, in running std of the change."""
        return cast(Any, self.model).disagreement(self._inner(params), x, u)

    def loss(
        self, params: dict[str, Any], obs: Array, action: Array, next_obs: Array, key: Array
    ) -> Array:
        """Mean loss [] of transitions [members * B, ...]. The key is consumed."""
        x = jax.vmap(self.lift, (None, 0))(params, obs)
        return self.model.loss(self._inner(params), x, action, next_obs, key)

    def _inner(self, params: dict[str, Any]) -> dict[str, Any]:
        """The parameters of the inner model."""
        return {**params, "weights": params["weights"]["model"]}

    def _after(self, params: dict[str, Any], x: Array, u: Array, after: Array) -> Array:
        """The state [n] after x [n] and u [m], where the inner model says `after`: with its h."""
        moving = x.size - self.memory
        row = jnp.concatenate((after[:moving], u))
        h = self._remembered(params, x[moving:], self._seen(params, row))
        return jnp.concatenate((after[:moving], h))

    def _seen(self, params: dict[str, Any], rows: Array) -> Array:
        """What the gates get of rows (o, v, u) [..., d] of decisions: [..., 3 memory]."""
        moving = params["state"].mean.size - self.memory
        state = jax.tree.map(lambda leaf: leaf[:moving] if leaf.ndim else leaf, params["state"])
        x = statistics.normalise(state, rows[..., :moving])
        x = jnp.concatenate((x, rows[..., moving:]), -1)
        return apply(self._gates, params["weights"]["cell"]["row"], x)

    def _remembered(self, params: dict[str, Any], h: Array, seen: Array) -> Array:
        """The memory after h, by what is `seen` [3 memory]."""
        kept = jnp.split(apply(self._gates, params["weights"]["cell"]["h"], h), 3)
        reset, keep, new = jnp.split(seen, 3)
        keep = jax.nn.sigmoid(keep + kept[1])
        new = jnp.tanh(new + jax.nn.sigmoid(reset + kept[0]) * kept[2])
        return (1 - keep) * new + keep * h
