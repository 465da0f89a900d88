"""Learn the features of a linear model by gradients, and K by least squares, in iterations.

    loss = mean |z^_k - z(o_t+k)|^2,   z^_k = K s(z^_k-1, u_t+k-1),  z^_0 = z(o_t),  k = 1 ... H

An iteration is `interval` decisions. At its end, Adam changes the features' weights and K, then K
is the least-squares solution over all decisions in the memory, then the regulator is solved. All
three change in the same decision, since a gain fits no features but those it was solved for.

Source: thesis section 7.4. With H = 1 and K by Adam the loss is eq. (7.12); several steps, least
squares and its prior are ours.
"""

from typing import Any, ClassVar, Literal, NamedTuple

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import least_squares
from hybrid_rl.fields import Count, FieldError, Natural, Positive, part
from hybrid_rl.protocols import Learner, LinearModel
from hybrid_rl.types import Batch, Params, Spec

CHUNK = 128  # decisions that the regression takes at once


class Decisions(NamedTuple):
    """Decisions and their outcomes."""

    obs: Array  # [..., o]
    action: Array  # [..., m]
    ended: Array  # [...] 1 where the episode ended with this decision, else 0
    next_obs: Array  # [..., o]


@struct.dataclass
class EmbeddingState:
    """The state of the learner."""

    model: dict[str, Any]
    optimiser: Any
    memory: Decisions  # [C, ...] a ring
    regulator: Any  # () without one
    metrics: dict[str, Array]  # of the regulator's last solution


@part
class EmbeddingLearner:
    """Features and K of a linear model and, with a regulator, its policy.

    Features without weights stay as they are, as do all with steps = 0.
    """

    model: LinearModel
    regulator: Learner | None = None  # solves for the policy after each fit
    interval: int = 200  # decisions of an iteration
    fit: Literal["least_squares", "adam"] = "least_squares"  # of K; adam: as printed
    window: Count = 5  # H [decisions]
    steps: Natural = 100  # of Adam in an iteration
    learning_rate: Positive = 1e-3
    batch_size: Count = 128  # windows in a step
    prior: Positive = 10.0  # weight of K_0 = [I 0] in the regression
    capacity: int = 20_000  # decisions in the memory

    data: ClassVar[str] = "latest"
    every: ClassVar[int] = 1

    def __post_init__(self) -> None:
        steps = ("steps", int(self.fit == "adam"))
        for name, low in (steps, ("interval", self.window), ("capacity", self.interval)):
            if getattr(self, name) < low:
                raise FieldError(self, name, f"must be a whole number, {low} or more")

    @property
    def owns(self) -> tuple[str, ...]:
        """The fields of `Params` that it learns."""
        return ("model",) if self.regulator is None else ("model", *self.regulator.owns)

    def init(self, key: Array, spec: Spec) -> EmbeddingState:
        """K = [I 0] and an empty memory. The key is consumed."""
        of_model, of_regulator, unused = jax.random.split(key, 3)
        model = self.model.init(of_model, spec)
        memory = _nothing(self.capacity, spec)
        optimiser = optax.adam(self.learning_rate).init(_trained(model))
        if self.regulator is None:
            return EmbeddingState(model, optimiser, memory, (), {})
        regulator = self.regulator.init(of_regulator, spec)
        none, flag = _nothing(1, spec), jnp.zeros(1)
        batch = Batch(none.obs, none.action, flag, flag, flag, none.next_obs)
        params = Params(model=model, decisions=jnp.zeros((), jnp.int32))
        shapes = jax.eval_shape(self.regulator.update, regulator, params, batch, unused)[1]
        metrics = jax.tree.map(jnp.zeros_like, shapes)
        return EmbeddingState(model, optimiser, memory, regulator, metrics)

    def params(self, state: EmbeddingState) -> dict[str, Any]:
        """The model, and the policy if there is a regulator."""
        policy = {} if self.regulator is None else self.regulator.params(state.regulator)
        return {"model": state.model, **policy}

    def update(
        self, state: EmbeddingState, params: Params, batch: Batch, key: Array
    ) -> tuple[EmbeddingState, dict[str, Array]]:
        """Store B decisions; at the end of an iteration, fit.

        The loss is the squared error, before the fit, of these decisions' predictions.
        """
        before = params.decisions
        assert before is not None  # in training
        total = before + len(batch.reward)
        ended = jnp.maximum(batch.terminated, batch.truncated)
        new = Decisions(batch.obs, batch.action, ended, batch.next_obs)
        size = self._size(len(batch.reward))
        memory = jax.tree.map(
            lambda ring, x: jax.lax.dynamic_update_slice_in_dim(ring, x, before % size, 0),
            state.memory,
            new,
        )

        def fit(learned: tuple) -> tuple:
            model, optimiser, regulator, metrics = learned
            training, solving = jax.random.split(key)
            if (self.steps and "weights" in model["features"]) or self.fit == "adam":
                draw = self._windows(memory, total, len(batch.reward))
                model, optimiser = self.train(model, optimiser, draw, training)
            model = self.regress(model, memory, jnp.minimum(total, size))
            if self.regulator is not None:
                now = params._replace(model=model)
                regulator, metrics = self.regulator.update(regulator, now, batch, solving)
            return model, optimiser, regulator, metrics

        due = total // self.interval > before // self.interval
        learned = state.model, state.optimiser, state.regulator, state.metrics
        learned = jax.lax.cond(due, fit, lambda same: same, learned)
        model, optimiser, regulator, metrics = learned
        single = jax.tree.map(lambda x: x[:, None], new)
        loss = self.loss(state.model, single)
        after = EmbeddingState(model, optimiser, memory, regulator, metrics)
        return after, {"model/loss": loss, **metrics}

    def _size(self, worlds: int) -> int:
        """The slots of the memory in use: each holds the same world in every round."""
        return self.capacity // worlds * worlds

    def _windows(self, memory: Decisions, total: Array, worlds: int) -> Any:
        """A function of a key that draws windows [batch_size, H, ...] of successive decisions."""
        size = self._size(worlds)
        stored = jnp.minimum(total, size)
        starts = jnp.maximum(stored - (self.window - 1) * worlds, 1)

        def draw(key: Array) -> Decisions:
            start = jax.random.randint(key, (self.batch_size, 1), 0, starts)
            each = total - stored + start + worlds * jnp.arange(self.window)[None]
            return jax.tree.map(lambda ring: ring[each % size], memory)

        return draw

    def loss(self, model: dict[str, Any], windows: Decisions) -> Array:
        """Mean squared error [] of predictions over windows [B, H, ...], up to an episode's end."""

        def errors(window: Decisions) -> tuple[Array, Array]:
            def step(z: Array, u: Array) -> tuple[Array, Array]:
                z = self.model.step(model, z, u)
                return z, z

            lift = jax.vmap(self.model.lift, (None, 0))
            start = self.model.lift(model, window.obs[0])
            predicted = jax.lax.scan(step, start, window.action, unroll=True)[1]
            error = jnp.mean((predicted - lift(model, window.next_obs)) ** 2, -1)
            one = jnp.ones(1, error.dtype)
            return error, jnp.cumprod(jnp.concatenate([one, 1 - window.ended[:-1]]))

        error, counts = jax.vmap(errors)(windows)
        return jnp.sum(error * counts) / jnp.sum(counts)

    def train(self, model: Any, optimiser: Any, draw: Any, key: Array) -> tuple[Any, Any]:
        """The model after gradient steps on windows from `draw`, and the optimiser's state."""
        adam = optax.adam(self.learning_rate)

        def step(carry: tuple, key: Array) -> tuple[tuple, None]:
            trained, optimiser = carry
            windows = draw(key)
            grads = jax.grad(lambda trained: self.loss(_with(model, trained), windows))(trained)
            change, optimiser = adam.update(grads, optimiser, trained)
            return (optax.apply_updates(trained, change), optimiser), None

        keys = jax.random.split(key, self.steps)
        (trained, optimiser), _ = jax.lax.scan(step, (_trained(model), optimiser), keys)
        return _with(model, trained), optimiser

    def regress(self, model: dict[str, Any], memory: Decisions, stored: Array) -> dict[str, Any]:
        """The model with its spread, and K if it is to be fitted, from `stored` [] decisions."""

        def add(i: Array, factor: least_squares.Factor) -> least_squares.Factor:
            slots = i * CHUNK + jnp.arange(CHUNK)
            part = jax.tree.map(lambda ring: ring[slots % len(ring)], memory)
            s, change = least_squares.rows(self.model, model, part)
            known = (slots < stored)[:, None]
            return least_squares.fold(factor, s * known, change * known)

        K = model["K"]
        none = least_squares.begin(jnp.zeros_like(K), self.prior)
        factor = jax.lax.fori_loop(0, -(-stored // CHUNK), add, none)
        change, spread = least_squares.solve(factor)
        if self.fit == "least_squares":
            K = jnp.eye(*K.shape) + change
        return {**model, "K": K, "spread": spread}


def _trained(model: dict[str, Any]) -> dict[str, Any]:
    """What gradient steps change: K, and the features' weights if they have any."""
    weights = {name: w for name, w in model["features"].items() if name == "weights"}
    return {"K": model["K"], **weights}


def _with(model: dict[str, Any], trained: dict[str, Any]) -> dict[str, Any]:
    """`model` with what was trained."""
    weights = {name: w for name, w in trained.items() if name == "weights"}
    features = {**model["features"], **weights}
    return {**model, "K": trained["K"], "features": features}


def _nothing(size: int, spec: Spec) -> Decisions:
    """Decisions [size, ...] of zeros."""
    obs = jnp.zeros((size, spec.obs))
    return Decisions(obs, jnp.zeros((size, spec.act)), jnp.zeros(size), obs)
