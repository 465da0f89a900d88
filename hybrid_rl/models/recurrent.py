"""x = (o, v, h): a model whose state remembers what was seen and done.

    h_t = h_{t-1} + K_t (y_t - h_{t-1}),   K_t, y_t = network(o_t, v_t, u_{t-1})

with v_t = (o_t - o_{t-1}) / dt, 0 < K < 1 and -1 < y < 1, for each of its numbers: a filter whose
gain is learned. Where an observation lacks a velocity or a load, a decision may tell it, or not, as
a foot on the ground tells the speed: then K is large, or small. At a history s of `core.history`,
h is the mean of its y, weighted as above, so that it does not depend on a value before; a
prediction goes one step on, and imagined decisions need no history. A mean stays what it is over
decisions of any number, where a network that is trained over a few may leave its range.

The inner model predicts o' at x. What it makes of h, and what the reward does
(`learners/model.py`), teaches the filter.

Source: a gated recurrent unit whose gates see no state (Feng et al. 2024, "Were RNNs all we
needed?"), without its bias towards 0 at first (as Adam's means, Kingma and Ba 2015). A
deterministic memory in which policies and planners act: Hafner et al. 2019 (PlaNet).
"""

from functools import partial
from typing import Annotated, Any, cast

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.fields import Count, Must, part
from hybrid_rl.networks import MLP, Widths, apply
from hybrid_rl.protocols import Trainable
from hybrid_rl.types import Spec

WHOLE = "be a whole number, 2 or more; give episode.history=32"
Seen = Annotated[int, Must(lambda k: isinstance(k, int) and k > 1, WHOLE)]


@part
class Recurrent:
    """`model`, a single one or an ensemble, at states with a memory of `memory` numbers."""

    model: Trainable
    history: Seen = 32  # observations from which the memory is read, as in the episode
    memory: Count = 32
    hidden: Widths = (64,)  # of the network of K and y

    @property
    def members(self) -> int:
        """Models in the ensemble."""
        return self.model.members

    @property
    def _net(self) -> MLP:
        """K and y of a decision, before they are squashed."""
        return MLP(self.hidden, 2 * self.memory, "silu")

    def init(self, key: Array, spec: Spec) -> dict[str, Any]:
        """Initial parameters. The key is consumed."""
        for_model, for_filter = jax.random.split(key)
        assert spec.newest is not None
        moving = 2 * spec.newest  # o and v
        inner = self.model.init(for_model, spec._replace(obs=moving + self.memory))
        net = self._net.init(for_filter, jnp.zeros(moving + spec.act))
        return {**inner, "weights": {"model": inner["weights"], "filter": net}}

    def observe(self, params: dict[str, Any], obs: Array, next_obs: Array) -> dict[str, Any]:
        """Parameters with statistics of histories [B, s] and successors; h stays as it is."""
        moving = params["state"].mean.size - self.memory
        x = jnp.pad(obs[:, :moving], ((0, 0), (0, self.memory)))
        return self.model.observe(params, x, next_obs)

    def lift(self, params: dict[str, Any], obs: Array) -> Array:
        """x [n] after a history [s]."""
        o, dt = params["change"].mean.size, params["period"]
        rows = obs[o:].reshape(self.history - 1, -1)  # v and u before it, newest first
        newer = partial(jnp.matmul, jnp.tri(len(rows), k=-1), precision="highest")  # their sums
        rows = jnp.concatenate((obs[None, :o] - dt * newer(rows[:, :o]), rows), 1)
        gain, y = self._measured(params, rows)
        weight = jax.nn.log_sigmoid(gain) + newer(jax.nn.log_sigmoid(-gain))
        h = (jax.nn.softmax(weight, 0) * y).sum(0)
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
        gain, y = self._measured(params, row)
        return jnp.concatenate(
            (after[:moving], x[moving:] + jax.nn.sigmoid(gain) * (y - x[moving:]))
        )

    def _measured(self, params: dict[str, Any], rows: Array) -> tuple[Array, Array]:
        """The logits of K, and y [..., memory], of rows (o, v, u) [..., d] of decisions."""
        moving = params["state"].mean.size - self.memory
        state = jax.tree.map(lambda leaf: leaf[:moving] if leaf.ndim else leaf, params["state"])
        x = statistics.normalise(state, rows[..., :moving])
        x = jnp.concatenate((x, rows[..., moving:]), -1)
        gain, y = jnp.split(apply(self._net, params["weights"]["filter"], x), 2, -1)
        return gain, jnp.tanh(y)
