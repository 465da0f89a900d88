"""One decision of one learner: params -> controller -> environment -> memory -> learners."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.data.replay import Memory, Replay, as_batch
from hybrid_rl.protocols import Controller, Learner, UniformLearner
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import act
from hybrid_rl.types import Batch, EnvState, Params, Spec, Transition


@struct.dataclass
class AgentState:
    """The state of training: environments, controllers, memory, learners, key."""

    env: EnvState  # [E, ...]
    control: Any  # [E, ...]
    memory: Memory
    learners: dict[str, Any]
    key: Array  # []


@dataclass(frozen=True)
class Agent:
    """A method that trains in `num_envs` environments.

    A learner of `latest` data uses each decision once, from the first one on. A learner of
    `uniform` data makes `pretrain` gradient steps before the first decision, on the demonstrations
    in the memory; then `updates` per decision, as soon as the memory holds a batch and, unless the
    learner is `early`, the `random_steps` are over.

    Raises:
        ValueError: for counts out of range, updates that do not divide into decisions, or two
            learners of one field of `Params`.
    """

    episode: Episode
    controller: Controller
    learners: Mapping[str, Any]  # a Learner each; no protocol has both its fields and ClassVars
    replay: Replay
    num_envs: int = 1
    random_steps: int = 0
    pretrain: int = 0  # gradient steps of each learner before the first decision
    first_update: int = 0  # decisions before any learning, where a resumed memory starts empty

    def __post_init__(self) -> None:
        """Check the fields."""
        if not isinstance(self.num_envs, int) or self.num_envs < 1:
            raise ValueError(f"num_envs={self.num_envs}: must be a whole number, 1 or more")
        for name in ("random_steps", "pretrain"):
            value = getattr(self, name)
            if not isinstance(value, int) or value < 0:
                raise ValueError(f"{name}={value}: must be a whole number, 0 or more")
        if self.pretrain and not self.replay.num_demonstrated(self.num_envs):
            raise ValueError(
                f"pretrain={self.pretrain}: the memory has no demonstrations to learn from; "
                "give replay.demonstrations, or 0"
            )
        owners: dict[str, str] = {}
        for name, learner in self.learners.items():
            update_schedule(name, learner, self.num_envs)
            for field in learner.owns:
                if field in owners:
                    both = f"{owners[field]} and {name}"
                    raise ValueError(f"learners: {both} both learn params.{field}; keep one")
                owners[field] = name

    @property
    def spec(self) -> Spec:
        """The environment's sizes and time step."""
        return self.episode.spec

    def check(self, decisions: int) -> None:
        """Raise ValueError if a part refuses a run of so many decisions; no device is used."""
        longest = min(decisions, self.episode.steps * self.num_envs)
        for part in self.learners.values():
            if (check := getattr(part, "check", None)) is not None:
                check(longest)
            jax.eval_shape(lambda init=part.init: init(jax.random.key(0), self.spec))
        jax.eval_shape(lambda: self.controller.init(self.spec))

    def starts(self) -> dict[str, int]:
        """Decisions before the first update of each learner, apart from pretraining."""
        demonstrated = self.replay.num_demonstrated(self.num_envs) * self.num_envs
        return {
            name: 0
            if learner.data == "latest"
            else max(
                0 if learner.early else self.random_steps,
                self.first_update + learner.batch_size + self.num_envs - demonstrated,
            )
            for name, learner in self.learners.items()
        }

    def changes(self) -> set[int]:
        """The numbers of decisions after which the time per decision changes."""
        return {self.random_steps, *self.starts().values()}

    def init(self, key: Array) -> AgentState:
        """The state before the first decision. The key is consumed."""
        run, resetting, *learning, pretraining = jax.random.split(key, 3 + len(self.learners))
        env = jax.vmap(self.episode.reset)(jax.random.split(resetting, self.num_envs))
        memory = self.replay.init(self.spec, self.num_envs)
        learners = {
            name: learner.init(k, self.spec)
            for (name, learner), k in zip(self.learners.items(), learning, strict=True)
        }
        if self.pretrain:
            learners = self._pretrain(learners, memory, pretraining)
        return AgentState(env, self._initial_control(), memory, learners, run)

    def params(self, state: AgentState) -> Params:
        """The parameters of all learners."""
        return self._joined(state.learners)

    def _joined(self, states: dict[str, Any]) -> Params:
        """The parameters of all learners, in these states."""
        fields: dict[str, Any] = {}
        for name, learner in self.learners.items():
            fields |= learner.params(states[name])
        return Params(**fields)

    def _pretrain(self, states: dict[str, Any], memory: Memory, key: Array) -> dict[str, Any]:
        """The learners' states after pretraining. The key is consumed."""

        def one(states: dict[str, Any], key: Array) -> tuple[dict[str, Any], None]:
            params, learned = self._joined(states), dict(states)
            keys = jax.random.split(key, (len(states), 2))
            for (drawing, updating), (name, learner) in zip(
                keys, self.learners.items(), strict=True
            ):
                if learner.data == "uniform":
                    batch = self._sample(memory, learner, drawing)
                    learned[name] = learner.update(states[name], params, batch, updating)[0]
            return learned, None

        return jax.lax.scan(one, states, jax.random.split(key, self.pretrain))[0]

    def _sample(self, memory: Memory, learner: UniformLearner, key: Array) -> Batch:
        """The batch of one update of a `uniform` learner. The key is consumed."""
        return self.replay.sample(memory, self.spec, learner.batches * learner.batch_size, key)

    def step(self, state: AgentState, step: Array) -> tuple[AgentState, dict[str, Array]]:
        """One decision in every environment, `step` [] decisions into the run; metrics name -> [].

        A metric is NaN if it does not apply, infinite if it is not finite. `episode/...` are per
        environment [E].
        """
        keys = jax.random.split(state.key, 3 + 2 * self.num_envs)
        key, at_random, learning = keys[:3]
        deciding, resetting = jnp.split(keys[3:], 2)
        params = self.params(state)._replace(decisions=step)
        u, control, metrics = self._decide(params, state, step, at_random, deciding)
        now = jax.vmap(self.episode.step)(state.env, u)
        new = Transition(state.env.obs, u, now.reward, now.terminated, now.truncated, now.obs)
        memory = self.replay.add(state.memory, new)
        env = jax.vmap(self.episode.auto_reset)(now, resetting)
        control = jax.tree.map(
            lambda first, held: jnp.where(_expanded(now.done, held), first, held),
            self._initial_control(),
            control,
        )
        learners, learned = self._learn(state.learners, params, memory, new, step, learning)
        world = {"reward": now.reward, "obs": now.obs, "action": u, **now.metrics}
        metrics = {
            **masked_mean(metrics, step >= self.random_steps, sparse=True),
            **learned,
            **masked_mean({f"world/{name}": value for name, value in world.items()}, True),
            "episode/done": now.done,
            "episode/return": now.info["return"],
            "episode/length": now.info["decision"],
        }
        return AgentState(env, control, memory, learners, key), metrics

    def learn(self, state: AgentState, new: Transition, step: Array) -> AgentState:
        """`state` after learning from a recorded decision `new` [E, ...], as `step` learns."""
        keys = jax.random.split(state.key, 3 + 2 * self.num_envs)
        params, memory = self.params(state), self.replay.add(state.memory, new)
        learners, _ = self._learn(state.learners, params, memory, new, step, keys[2])
        return state.replace(memory=memory, learners=learners, key=keys[0])

    def _initial_control(self) -> Any:
        """The controller's initial state in every environment [E, ...]."""
        first = self.controller.init(self.spec)
        return jax.tree.map(lambda x: jnp.broadcast_to(x, (self.num_envs, *x.shape)), first)

    def _decide(
        self, params: Params, state: AgentState, step: Array, at_random: Array, keys: Array
    ) -> tuple[Array, Any, dict[str, Array]]:
        """Actions [E, m], controller states [E, ...], metrics [E]; random ones from `at_random`."""

        def plan() -> tuple[Array, Any, dict[str, Array]]:
            return act(self.controller, params, state.control, state.env, keys)

        if not self.random_steps:
            return plan()
        plan = trace_once(plan)
        shapes = jax.eval_shape(plan)
        draw = jax.random.uniform(at_random, shapes[0].shape, minval=-1, maxval=1)
        nothing = _zeros(shapes[2])
        return jax.lax.cond(step < self.random_steps, lambda: (draw, state.control, nothing), plan)

    def _learn(
        self,
        states: dict[str, Any],
        params: Params,
        memory: Memory,
        new: Transition,
        step: Array,
        key: Array,
    ) -> tuple[dict[str, Any], dict[str, Array]]:
        """The learners' states after this decision, and the metrics of their last updates."""
        learned, metrics = {}, {}
        keys = jax.random.split(key, len(states)) if states else []
        starts = self.starts()
        for k, (name, learner) in zip(keys, self.learners.items(), strict=True):
            count, every = update_schedule(name, learner, self.num_envs)

            def one(state: Any, keys: Array, learner: Learner = learner) -> tuple[Any, Any]:
                drawing, updating = keys
                if learner.data == "latest":
                    return learner.update(state, params, as_batch(new), updating)
                batch = self._sample(memory, learner, drawing)
                return learner.update(state, params, batch, updating)

            @trace_once
            def update(state: Any, k: Array, count: int = count, one: Any = one) -> Any:
                pairs = jax.random.split(k, (count, 2))
                state, each = jax.lax.scan(one, state, pairs)
                return state, jax.tree.map(lambda m: m[-1], each)

            nothing = _zeros(jax.eval_shape(update, states[name], k)[1])
            due = (step >= starts[name]) & ((step // self.num_envs) % every == 0)
            learned[name], latest = jax.lax.cond(
                due, update, lambda state, k, nothing=nothing: (state, nothing), states[name], k
            )
            metrics |= masked_mean(latest, due)
        return learned, metrics


def update_schedule(name: str, learner: Learner, num_envs: int) -> tuple[int, int]:
    """(n, k) of a learner: n updates after every k decisions of each environment."""
    if learner.data == "latest":
        return 1, learner.every
    if not isinstance(learner.batch_size, int) or learner.batch_size < 1:
        raise ValueError(
            f"{name}_learner.batch_size={learner.batch_size}: must be a whole number, 1 or more"
        )
    per_round = learner.updates * num_envs
    if per_round >= 1 and float(per_round).is_integer():
        return int(per_round), 1
    if 0 < per_round < 1 and float(1 / per_round).is_integer():
        return 1, int(1 / per_round)
    raise ValueError(
        f"{name}_learner.updates={learner.updates}: with num_envs={num_envs} this gives "
        f"{per_round:g} gradient steps per round; it must be a whole number, or 1 / a whole number"
    )


def trace_once(f: Any) -> Any:
    """`f`, jitted inline, so that repeated calls and `eval_shape` share one trace."""
    return jax.jit(f, inline=True)


def _zeros(shapes: Any) -> Any:
    """Zeros with the shapes that `jax.eval_shape` returned."""
    return jax.tree.map(lambda m: jnp.zeros(m.shape, m.dtype), shapes)


def masked_mean(
    metrics: dict[str, Array], when: Array | bool, sparse: bool = False
) -> dict[str, Array]:
    """The means [] of metrics: NaN unless `when`, infinite if a value is not finite.

    sparse: NaN marks values that do not apply, which the mean omits.
    """

    def mean(value: Array) -> Array:
        finite = jnp.isfinite(value)
        if not sparse:
            return jnp.where(finite.all(), value.mean(), jnp.inf)
        average = jnp.where(finite, value, 0).sum() / finite.sum()
        return jnp.where(jnp.isinf(value).any(), jnp.inf, average)

    return {name: jnp.where(when, mean(value), jnp.nan) for name, value in metrics.items()}


def _expanded(flags: Array, x: Array) -> Array:
    """Flags [E] with trailing axes, to select among x [E, ...]."""
    return flags.reshape(flags.shape + (1,) * (x.ndim - 1))
