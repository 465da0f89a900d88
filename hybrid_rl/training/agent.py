"""One decision of one learner: world -> memory -> learners -> params -> controller -> world."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.data.replay import Memory, Replay
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Batch, Controller, EnvState, Learner, Params, Spec, Transition


@struct.dataclass
class AgentState:
    """All that evolves: a learner, its worlds, its memory, its key."""

    env: EnvState  # [E, ...]
    control: Any  # [E, ...]
    memory: Memory
    learners: dict[str, Any]
    key: Array  # []


@dataclass(frozen=True)
class Agent:
    """A method at work in `num_envs` worlds.

    Each learner makes `updates` gradient steps a decision once the memory holds a batch, and,
    unless it is `early`, `random_steps` decisions were drawn uniformly; and `pretrain` of them
    before the first decision, on what the memory was given.

    Raises:
        ValueError: for counts out of range, or updates that do not divide into decisions.
    """

    episode: Episode
    controller: Controller
    learners: Mapping[str, Learner]
    replay: Replay
    num_envs: int = 1
    random_steps: int = 0
    pretrain: int = 0  # gradient steps of each learner before the first decision
    first_update: int = 0  # decisions before any learning, where the memory starts empty later on

    def __post_init__(self) -> None:
        """Check the fields."""
        if not isinstance(self.num_envs, int) or self.num_envs < 1:
            raise ValueError(f"num_envs={self.num_envs}: must be a whole number, 1 or more")
        for name in ("random_steps", "pretrain"):
            value = getattr(self, name)
            if not isinstance(value, int) or value < 0:
                raise ValueError(f"{name}={value}: must be a whole number, 0 or more")
        if self.pretrain and not self.replay.given(self.num_envs):
            raise ValueError(
                f"pretrain={self.pretrain}: there is nothing to learn from before the first "
                "decision; give replay.demonstrations, or 0"
            )
        for name, learner in self.learners.items():
            update_schedule(name, learner, self.num_envs)

    @property
    def spec(self) -> Spec:
        """The world's sizes and rate."""
        return self.episode.spec

    def starts(self) -> dict[str, int]:
        """Decisions before the first gradient step of each learner, a head start left out."""
        given = self.replay.given(self.num_envs) * self.num_envs
        return {
            name: max(
                0 if learner.early else self.random_steps,
                self.first_update + learner.batch_size + self.num_envs - given,
            )
            for name, learner in self.learners.items()
        }

    def changes(self) -> set[int]:
        """Decisions after which a decision takes another time: with planning, with learning."""
        return {self.random_steps, *self.starts().values()}

    def init(self, key: Array) -> AgentState:
        """The state before the first decision. The key is consumed."""
        run, world, *learning, ahead = jax.random.split(key, 3 + len(self.learners))
        env = jax.vmap(self.episode.reset)(jax.random.split(world, self.num_envs))
        memory = self.replay.init(self.spec, self.num_envs)
        learners = {
            name: learner.init(k, self.spec)
            for (name, learner), k in zip(self.learners.items(), learning, strict=True)
        }
        if self.pretrain:
            learners = self._pretrain(learners, memory, ahead)
        return AgentState(env, self.initial_control(), memory, learners, run)

    def params(self, state: AgentState) -> Params:
        """What all learners know."""
        return self._known(state.learners)

    def _known(self, states: dict[str, Any]) -> Params:
        """The same, from the learners' states."""
        known: dict[str, Any] = {}
        for name, learner in self.learners.items():
            known |= learner.params(states[name])
        return Params(**known)

    def _pretrain(self, states: dict[str, Any], memory: Memory, key: Array) -> dict[str, Any]:
        """The learners after their head start. The key is consumed."""

        def one(states: dict[str, Any], key: Array) -> tuple[dict[str, Any], None]:
            params, learned = self._known(states), {}
            keys = jax.random.split(key, (len(states), 2))
            for (drawing, updating), (name, learner) in zip(
                keys, self.learners.items(), strict=True
            ):
                batch = self._recall(memory, learner, drawing)
                learned[name] = learner.update(states[name], params, batch, updating)[0]
            return learned, None

        return jax.lax.scan(one, states, jax.random.split(key, self.pretrain))[0]

    def _recall(self, memory: Memory, learner: Learner, key: Array) -> Batch:
        """What one update of `learner` takes. The key is consumed."""
        return self.replay.sample(memory, self.spec, learner.batches * learner.batch_size, key)

    def step(self, state: AgentState, step: Array) -> tuple[AgentState, dict[str, Array]]:
        """One decision in every world, `step` [] decisions into the run; metrics name -> [].

        A metric is NaN where there is nothing to tell, infinite where it is not finite.
        `episode/...` are per world [E].
        """
        keys = jax.random.split(state.key, 3 + 2 * self.num_envs)
        key, at_random, recalling = keys[:3]
        deciding, renewing = jnp.split(keys[3:], 2)
        params = self.params(state)._replace(decisions=step)
        u, control, metrics = self._decide(params, state, step, at_random, deciding)
        now = jax.vmap(self.episode.step)(state.env, u)
        new = Transition(state.env.obs, u, now.reward, now.terminated, now.truncated, now.obs)
        memory = self.replay.add(state.memory, new)
        env = jax.vmap(self.episode.auto_reset)(now, renewing)
        control = jax.tree.map(
            lambda rest, held: jnp.where(_like(now.done, held), rest, held),
            self.initial_control(),
            control,
        )
        learners, learned = self._learn(state.learners, params, memory, step, recalling)
        world = {"reward": now.reward, "obs": now.obs, "action": u, **now.metrics}
        metrics = {
            **masked_mean(metrics, step >= self.random_steps),
            **learned,
            **masked_mean({f"world/{name}": value for name, value in world.items()}, True),
            "episode/done": now.done,
            "episode/return": now.info["return"],
            "episode/length": now.info["decision"],
        }
        return AgentState(env, control, memory, learners, key), metrics

    def initial_control(self) -> Any:
        """The controller's first state in every world [E, ...]."""
        rest = self.controller.init(self.spec)
        return jax.tree.map(lambda x: jnp.broadcast_to(x, (self.num_envs, *x.shape)), rest)

    def _decide(
        self, params: Params, state: AgentState, step: Array, at_random: Array, keys: Array
    ) -> tuple[Array, Any, dict[str, Array]]:
        """Actions [E, m], controller states [E, ...], metrics [E], from one key and keys [E]."""
        act = jax.vmap(self.controller.act, in_axes=(None, 0, 0, 0))

        def plan() -> tuple[Array, Any, dict[str, Array]]:
            return act(params, state.control, state.env.obs, keys)

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
        step: Array,
        key: Array,
    ) -> tuple[dict[str, Any], dict[str, Array]]:
        """Every learner's state after this decision, and the metrics of their last steps."""
        learned, metrics = {}, {}
        keys = jax.random.split(key, len(states)) if states else []
        starts = self.starts()
        for k, (name, learner) in zip(keys, self.learners.items(), strict=True):
            count, every = update_schedule(name, learner, self.num_envs)

            def one(state: Any, keys: Array, learner: Learner = learner) -> tuple[Any, Any]:
                drawing, updating = keys
                batch = self._recall(memory, learner, drawing)
                return learner.update(state, params, batch, updating)

            @trace_once
            def update(state: Any, k: Array, count: int = count, one: Any = one) -> Any:
                rows = jax.random.split(k, (count, 2))
                state, each = jax.lax.scan(one, state, rows, unroll=count if count <= 4 else 1)
                return state, jax.tree.map(lambda m: m[-1], each)

            nothing = _zeros(jax.eval_shape(update, states[name], k)[1])
            due = (step >= starts[name]) & ((step // self.num_envs) % every == 0)
            learned[name], of_this = jax.lax.cond(
                due, update, lambda state, k, nothing=nothing: (state, nothing), states[name], k
            )
            metrics |= masked_mean(of_this, due)
        return learned, metrics


def update_schedule(name: str, learner: Learner, num_envs: int) -> tuple[int, int]:
    """(gradient steps at a time, rounds of decisions between them) for `learner.updates`."""
    if not isinstance(learner.batch_size, int) or learner.batch_size < 1:
        raise ValueError(
            f"{name}_learner.batch_size={learner.batch_size}: must be a whole number, 1 or more"
        )
    a_round = learner.updates * num_envs
    if a_round >= 1 and float(a_round).is_integer():
        return int(a_round), 1
    if 0 < a_round < 1 and float(1 / a_round).is_integer():
        return 1, int(1 / a_round)
    raise ValueError(
        f"{name}_learner.updates={learner.updates}: with num_envs={num_envs} this gives "
        f"{a_round:g} gradient steps a round; it must be a whole number, or one over one"
    )


def trace_once(f: Any) -> Any:
    """`f`, which is traced once however often its shapes are asked for and it is called."""
    return jax.jit(f, inline=True)


def _zeros(shapes: Any) -> Any:
    """Zeros in the shapes of `jax.eval_shape`."""
    return jax.tree.map(lambda m: jnp.zeros(m.shape, m.dtype), shapes)


def masked_mean(metrics: dict[str, Array], when: Array | bool) -> dict[str, Array]:
    """Means []: NaN unless `when`, infinite where some number is not finite."""
    return {
        name: jnp.where(when, jnp.where(jnp.isfinite(value).all(), value.mean(), jnp.inf), jnp.nan)
        for name, value in metrics.items()
    }


def _like(flags: Array, x: Array) -> Array:
    """Flags [E] with trailing axes, to select among x [E, ...]."""
    return flags.reshape(flags.shape + (1,) * (x.ndim - 1))
