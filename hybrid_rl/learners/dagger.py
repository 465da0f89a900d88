"""Interactive imitation learning: query an expert at chosen states (DAgger, DAIL and variants).

Each decision, at the robot's state x:

    x* = x_k of the largest target,   x_k = x + spread * scale * N(0, I),   k = 1 ... candidates
    if a query is due:   labels += (x*, u* = teacher(x*)), or a path of `length` from x*
    Adam steps on    -mean log pi(u* | x*)    over the labels

    DAgger     one candidate, spread 0      RQ-DAgger  one candidate, spread above 0
    DAIL       target: information          oracle     the clone's true error

Source: thesis Algorithm 5 (DAIL) and, with `better` and `length`, Algorithm 12; Ross, Gordon and
Bagnell 2011 (DAgger). The teacher drives for the `first` decisions (conf/algo/dagger.yaml);
they are the first demonstration, on which `first_steps` Adam steps are taken at its end.
"""

from typing import Any, ClassVar, NamedTuple

import jax
import jax.numpy as jnp
import optax
from flax import struct
from jax import Array

from hybrid_rl.core import statistics
from hybrid_rl.core.batching import when_any
from hybrid_rl.fields import Count, FieldError, Natural, NotNegative, Positive, Share, part
from hybrid_rl.protocols import Controller, LearnedPolicy, Model, Target
from hybrid_rl.types import Batch, Params, Spec

RATE = 0.02  # of the running mean of the evidence; our choice


@struct.dataclass
class Labels:
    """What the teacher answered; `count` labels so far, of which the last C are kept."""

    obs: Array  # [C, o]
    action: Array  # [C, m]
    count: Array  # [] int32


@struct.dataclass
class Queried:
    """What targets that choose queries consult."""

    labels: Labels
    scale: Array  # [o] standard deviations of the first demonstration; 1 without one
    evidence: Any  # sum over the labels of what the target asked for; None: nothing


def empty(capacity: int, o: int, m: int) -> Labels:
    """No labels yet."""
    return Labels(jnp.zeros((capacity, o)), jnp.zeros((capacity, m)), jnp.zeros((), jnp.int32))


def add(labels: Labels, obs: Array, action: Array, when: Array) -> Labels:
    """The labels with obs [T, o] and action [T, m] if `when` []; T divides C."""
    slot = labels.count % len(labels.obs)

    def put(ring: Array, new: Array) -> Array:
        old = jax.lax.dynamic_slice_in_dim(ring, slot, len(new))
        return jax.lax.dynamic_update_slice_in_dim(ring, jnp.where(when, new, old), slot, 0)

    count = labels.count + jnp.where(when, len(obs), 0)
    return Labels(put(labels.obs, obs), put(labels.action, action), count)


def draw(labels: Labels, size: int, key: Array) -> tuple[Array, Array]:
    """obs [size, o] and action [size, m], drawn uniformly with replacement; needs a label."""
    filled = jnp.clip(labels.count, 1, len(labels.obs))
    drawn = jax.random.randint(key, (size,), 0, filled)
    return labels.obs[drawn], labels.action[drawn]


class Answer(NamedTuple):
    """Observations and the actions there."""

    obs: Array  # [T, o]
    action: Array  # [T, m]


@struct.dataclass
class DAggerState:
    """The clone, the labels, and a record of queries: query i is in row i mod Q."""

    policy: Any
    optimiser: Any
    labels: Labels
    evidence: Any  # mean over the labels of what the target sums; None: nothing
    seen: statistics.Running  # of the observations of the first demonstration
    rest: Any  # the teacher's state before an answer
    information: Array  # [Q] log density of the target at the last queries; 0 without one
    decision: Array  # [Q] int32 decisions before each of them
    queries: Array  # [] int32
    decisions: Array  # [] int32
    loss: Array  # []


@part
class DAgger:
    """Queries to a teacher, and gradient steps on its answers.

    Query i begins at row `first` + i `length` of the labels.
    """

    policy: LearnedPolicy
    teacher: Controller | None  # without memory: its state is the initial one at each answer
    target: Target | None = None  # of the state to ask at; None: the only candidate
    candidates: Count = 1
    spread: NotNegative = 0.0
    normalise: bool = True  # spread in standard deviations of the first demonstration
    oracle: bool = False  # asks where the clone errs most
    model: Model | None = None  # of the paths of long answers
    length: Count = 1  # decisions of an answer
    first: Natural = 0  # decisions of the first demonstration
    spacing: Count = 1  # decisions between two queries
    most: Count | None = None  # queries; None: no limit
    better: bool = False  # asks only if the target exceeds that at the last query
    steps: Natural = 1  # Adam steps per decision
    first_steps: Natural = 200  # at the end of the first demonstration
    learning_rate: Positive = 3e-3
    batch_size: Count = 64
    edge: Share = 0.99  # bound of the imitated actions
    capacity: Count = 20_000  # labels that are kept

    data: ClassVar[str] = "latest"
    owns: ClassVar[tuple[str, ...]] = ("policy", "labels")
    every: ClassVar[int] = 1

    def __post_init__(self) -> None:
        if self.teacher is None:
            line = "expert=null: this task has no expert that teaches; give expert=NAME of"
            raise ValueError(f"{line} conf/expert")
        if self.target is None and (self.better or (self.candidates > 1 and not self.oracle)):
            raise FieldError(self, "target", "is needed to compare candidates, or queries")
        if self.length > 1 and (self.model is None or self.first):
            raise FieldError(self, "length", "needs a model of the world, and first=0")
        if self.capacity % self.length:
            raise FieldError(self, "capacity", f"must be a multiple of length={self.length}")

    @property
    def _teacher(self) -> Controller:
        assert self.teacher is not None  # as __post_init__ has checked
        return self.teacher

    def init(self, key: Array, spec: Spec) -> DAggerState:
        """An untrained clone without labels. The key is consumed."""
        rest = self._teacher.init(spec)
        policy, evidence = self.policy.init(key, spec), getattr(self.target, "evidence", None)
        if evidence is not None:  # zeros in the shape of what the target sums over the labels
            shapes = jax.eval_shape(evidence, Params(policy=policy), jnp.zeros(spec.obs))
            evidence = jax.tree.map(jnp.zeros_like, shapes)
        count, zero = self.most or self.capacity // self.length, jnp.zeros((), jnp.int32)
        return DAggerState(
            policy,
            optax.adam(self.learning_rate).init(policy),
            empty(self.capacity, spec.obs, spec.act),
            evidence,
            statistics.init(spec.obs),
            rest,
            jnp.zeros(count),
            jnp.zeros(count, jnp.int32),
            zero,
            zero,
            jnp.zeros(()),
        )

    def params(self, state: DAggerState) -> dict[str, Any]:
        """The policy, and what targets consult about the labels."""
        evidence = jax.tree.map(lambda mean: state.labels.count * mean, state.evidence)
        return {
            "policy": state.policy,
            "labels": Queried(state.labels, state.seen.scale, evidence),
        }

    def update(
        self, state: DAggerState, params: Params, batch: Batch, key: Array
    ) -> tuple[DAggerState, dict[str, Array]]:
        """Queries at the latest states where they are due, then Adam steps. The key is consumed."""
        asking, learning, summing = jax.random.split(key, 3)
        keys, before = jax.random.split(asking, len(batch.obs)), state.decisions

        def ask(state: DAggerState, at: tuple[Array, Array]) -> tuple[DAggerState, None]:
            return self._ask(self._see(state, at[0]), params, *at), None

        state = jax.lax.scan(ask, state, (batch.obs, keys))[0]
        steps = jnp.where(before < self.first, self.first_steps, self.steps * len(batch.obs))
        state = self.fit(state, jnp.where(state.decisions < self.first, 0, steps), learning)
        state = self._sum(state, params, summing)
        metrics = {
            "dagger/policy_loss": state.loss,
            "dagger/labels": state.labels.count,
            "dagger/queries": state.queries,
        }
        return state, metrics

    def _see(self, state: DAggerState, obs: Array) -> DAggerState:
        """The state with `obs` [o] in the statistics, during the first demonstration."""
        if not self.first:
            return state
        leading = state.decisions < self.first
        new = statistics.update(state.seen, obs[None]), self.policy.observe(state.policy, obs[None])
        old = state.seen, state.policy
        seen, policy = jax.tree.map(lambda new, old: jnp.where(leading, new, old), new, old)
        return state.replace(seen=seen, policy=policy)

    def _ask(self, state: DAggerState, params: Params, obs: Array, key: Array) -> DAggerState:
        """The state after one decision at obs [o], with the answer if a query was due."""
        drawing, answering = jax.random.split(key)
        x, value = self._query(state, params, obs, drawing)
        leading = state.decisions < self.first
        due = self._due(state, value) & ~leading
        x = jnp.where(leading, obs, x)
        rings = state.labels.obs, state.labels.action
        none = Answer(*(jnp.zeros((self.length, ring.shape[1])) for ring in rings))
        needed = when_any(lambda asked: asked[0], self._answer)
        asked, made = needed((due | leading, none), (params, state.rest, x, answering))
        slot = jnp.where(due, state.queries % len(state.decision), len(state.decision))
        return state.replace(
            labels=add(state.labels, made.obs, made.action, asked),
            information=state.information.at[slot].set(value, mode="drop"),
            decision=state.decision.at[slot].set(state.decisions, mode="drop"),
            queries=state.queries + due,
            decisions=state.decisions + 1,
        )

    def _query(
        self, state: DAggerState, params: Params, obs: Array, key: Array
    ) -> tuple[Array, Array]:
        """The state x* [o] to ask at, near obs [o], and log density [] of the target there."""
        drawing, labelling = jax.random.split(key)
        scale = state.seen.scale if self.normalise else jnp.ones(obs.size)
        near = obs[None]
        if self.spread > 0:
            noise = jax.random.normal(drawing, (self.candidates, obs.size))
            near = near + self.spread * scale[None] * noise
        if self.target is None and not self.oracle:
            return near[0], jnp.zeros(())
        values = jax.vmap(lambda x: self._value(state, params, x, labelling))(near)
        best = jnp.argmax(values)
        return near[best], values[best]

    def _value(self, state: DAggerState, params: Params, x: Array, key: Array) -> Array:
        """What is to be large [] at x [o]: the target, or for an oracle the clone's error."""
        if self.target is not None:
            return self.target.log_density(params, x)
        u = self._path(params, state.rest, x, 1, key).action[0]
        return jnp.sum((self.policy.mean(state.policy, x) - u) ** 2)

    def _due(self, state: DAggerState, value: Array) -> Array:
        """[] bool: a query may be asked now, where the target is `value` []."""
        last = (state.queries - 1) % len(state.decision)
        none = state.queries == 0
        due = none | (state.decisions - state.decision[last] >= self.spacing)
        if self.better:
            due &= none | (value > state.information[last])
        return due & (state.queries < len(state.decision)) if self.most else due

    def _answer(self, asked: tuple[Array, Answer], argument: tuple) -> tuple[Array, Answer]:
        """`asked` with the teacher's answer if it is due."""
        due, none = asked
        params, rest, x, key = argument
        new = self._path(params, rest, x, self.length, key)
        return due, jax.tree.map(lambda new, none: jnp.where(due, new, none), new, none)

    def _path(self, params: Params, rest: Any, obs: Array, length: int, key: Array) -> Answer:
        """`length` decisions of the teacher from obs [o] and its state `rest`, along the model.

        The observation is the first part of the model's planning state. The key is consumed.
        """

        def decide(carry: tuple[Array, Any], key: Array) -> tuple[tuple[Array, Any], Answer]:
            x, held = carry
            u, held, _ = self._teacher.act(params, held, x, key)
            after = x
            if length > 1:
                assert self.model is not None  # as __post_init__ has checked
                after = self.model.step(params.model, self.model.lift(params.model, x), u)[: x.size]
            return (after, held), Answer(x, u)

        return jax.lax.scan(decide, (obs, rest), jax.random.split(key, length))[1]

    def fit(self, state: DAggerState, steps: Array | int, key: Array) -> DAggerState:
        """The state after `steps` [] Adam steps on the labels, none if there are no labels."""
        adam = optax.adam(self.learning_rate)

        def one(i: Array, carry: tuple) -> tuple:
            policy, optimiser, _ = carry
            x, u = draw(state.labels, self.batch_size, jax.random.fold_in(key, i))
            u = jnp.clip(u, -self.edge, self.edge)
            value, grads = jax.value_and_grad(
                lambda policy: -self.policy.log_prob(policy, x, u).mean()
            )(policy)
            change, optimiser = adam.update(grads, optimiser, policy)
            return optax.apply_updates(policy, change), optimiser, value

        steps = jnp.where(state.labels.count > 0, steps, 0)
        policy, optimiser, loss = jax.lax.fori_loop(
            0, steps, one, (state.policy, state.optimiser, state.loss)
        )
        return state.replace(policy=policy, optimiser=optimiser, loss=loss)

    def _sum(self, state: DAggerState, params: Params, key: Array) -> DAggerState:
        """The state with the running mean of the target's evidence, over a batch of labels."""
        evidence = getattr(self.target, "evidence", None)
        if state.evidence is None or evidence is None:
            return state
        params = params._replace(policy=state.policy)
        x = draw(state.labels, self.batch_size, key)[0]
        each = jax.vmap(lambda x: evidence(params, x))(x)
        rate = jnp.maximum(1 / state.decisions, RATE)
        mean = jax.tree.map(lambda m, each: m + rate * (each.mean(0) - m), state.evidence, each)
        return state.replace(evidence=mean)
