"""One decision of one learner: params -> controller -> environment -> memory -> learners."""

import math
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple, Self

import jax
import jax.numpy as jnp
from flax import struct
from jax import Array

from hybrid_rl.core import history
from hybrid_rl.core.batching import repeat, where
from hybrid_rl.core.lifting import lifted_batch, lifted_spec
from hybrid_rl.data.replay import Memory, Replay
from hybrid_rl.fields import LARGEST, Count, Natural, part
from hybrid_rl.protocols import Controller, Learner, Model
from hybrid_rl.training import contract
from hybrid_rl.training.contract import needs_world
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.history import acted, remembered
from hybrid_rl.training.metrics import masked_mean, outcome
from hybrid_rl.training.rollout import act
from hybrid_rl.types import Batch, EnvState, Params, Spec, Transition


class Keys(NamedTuple):
    """The random numbers of one decision."""

    next: Array  # [] of the next decision
    at_random: Array  # []
    learning: Array  # []
    deciding: Array  # [E]
    resetting: Array  # [E]

    @classmethod
    def of(cls, key: Array, num_envs: int) -> Self:
        """From the key [] of the state before the decision, which is consumed."""
        keys = jax.random.split(key, 3 + 2 * num_envs)
        return cls(*keys[:3], *jnp.split(keys[3:], 2))


@struct.dataclass
class AgentState:
    """The state of training: environments, controllers, memory, learners, key."""

    env: EnvState  # [E, ...]
    control: Any  # [E, ...]
    memory: Memory
    learners: dict[str, Any]
    key: Array  # []
    numbers: dict[str, Array] = struct.field(default_factory=dict)  # [] of a learner's axis


@part
class Agent:
    """A method that trains in `num_envs` environments.

    A learner of `latest` data uses each decision once, from the first one on. A learner of
    `uniform` data makes `pretrain` gradient steps before the first decision, on what the memory
    holds; then `updates` per decision, as soon as the memory holds a batch and, unless the learner
    is `during_random`, the `random_steps` are over. Where a model is learned, learners get its
    planning states in place of observations, but for the model's own learner.

    Raises:
        ValueError: for counts out of range, updates that do not divide into decisions, or two
            learners of one field of `Params`.
    """

    episode: Episode
    controller: Controller
    learners: Mapping[str, Any]  # a Learner each; no protocol has both its fields and ClassVars
    replay: Replay
    num_envs: Count = 1
    random_steps: Natural = 0
    pretrain: Natural = 0  # gradient steps of each learner before the first decision
    first_update: int = 0  # decisions before any learning; < 0: so many are in the memory already
    frozen: tuple[str, ...] = ()  # learners that make no updates

    def __post_init__(self) -> None:
        if self.pretrain and not (self.given or self.replay.num_demonstrated(self.num_envs)):
            raise ValueError(
                f"pretrain={self.pretrain}: the memory is empty; give replay.demonstrations, a run "
                "with a memory, or 0"
            )
        if unknown := [name for name in self.frozen if name not in self.learners]:
            known = ", ".join(self.learners) or "none"
            raise ValueError(f"freeze={unknown}: the method's learners are {known}")
        contract.check_members(self)
        for name, learner in self.learners.items():
            update_schedule(name, learner, self.num_envs)

    @property
    def spec(self) -> Spec:
        """The environment's sizes and time step."""
        return self.episode.spec

    @property
    def seen(self) -> Spec:
        """The sizes for what learns and acts, which sees a history of observations."""
        return history.seen(self.spec, self.episode.history)

    @property
    def given(self) -> int:
        """Decisions of each environment in the memory that another run made."""
        return max(-self.first_update, 0) // self.num_envs

    def check(self, controllers: Iterable[Controller] = ()) -> None:
        """Raise ValueError if a part refuses a run; no device is used.

        controllers: others that act with what it learns.
        """
        contract.check(self, [self.controller, *controllers])
        jax.eval_shape(lambda: self.controller.init(self.spec))
        if not self.learners and needs_world(self.controller):  # not every planner can
            jax.eval_shape(lambda: self.step(self.init(jax.random.key(0)), jnp.int32(0)))

    def starts(self) -> dict[str, int]:
        """Decisions before the first update of each learner, apart from pretraining."""
        demonstrated = self.replay.num_demonstrated(self.num_envs) * self.num_envs
        return {
            name: 0
            if learner.data == "latest"
            else max(
                0 if learner.during_random else self.random_steps,
                self.first_update + learner.batch_size + self.num_envs - demonstrated,
            )
            for name, learner in self.learners.items()
        }

    def changes(self) -> set[int]:
        """The numbers of decisions after which the time per decision changes."""
        return {self.random_steps, *self.starts().values()}

    def init(self, key: Array) -> AgentState:
        """The state before the first decision; a given memory comes later. The key is consumed."""
        run, resetting, *learning, pretraining = jax.random.split(key, 3 + len(self.learners))
        env = jax.vmap(self.episode.reset)(jax.random.split(resetting, self.num_envs))
        memory = self.replay.init(self.spec, self.num_envs, self.episode.own_goal)
        learners = {
            name: learner.init(k, lifted_spec(self._lifting(learner), self.seen))
            for (name, learner), k in zip(self.learners.items(), learning, strict=True)
        }
        state = AgentState(env, self.first_control(), memory, learners, run)
        return state if self.given else self.pretrained(state, pretraining)

    def params(self, state: AgentState) -> Params:
        """The parameters of all learners."""
        fields: dict[str, Any] = {}
        for name, learner in self.learners.items():
            fields |= learner.params(state.learners[name])
        return Params(**fields)

    def pretrained(self, state: AgentState, key: Array) -> AgentState:
        """`state` after the gradient steps before the first decision. The key is consumed."""
        if not self.pretrain:
            return state

        def one(state: AgentState, key: Array) -> tuple[AgentState, None]:
            params, learned = self.params(state), dict(state.learners)
            keys = jax.random.split(key, (len(learned), 2))
            for (drawing, updating), (name, learner) in zip(
                keys, self.learners.items(), strict=True
            ):
                if learner.data == "uniform" and name not in self.frozen:
                    batch = self._batch(state.memory, learner, params, drawing)
                    learned[name] = learner.update(learned[name], params, batch, updating)[0]
            return state.replace(learners=learned), None

        return jax.lax.scan(one, state, jax.random.split(key, self.pretrain))[0]

    def _batch(self, memory: Memory, learner: Learner, params: Params, key: Array) -> Batch:
        """The batch of one update. The key is consumed by that of a `uniform` learner."""
        if learner.data == "latest":
            return Batch(*self.replay.newest(memory, self.spec, self.episode.history))
        size = learner.batches * learner.batch_size
        of = memory, self.spec, size, key, self.episode.history, self.given
        batch = self.replay.sample(*of)
        return lifted_batch(self._lifting(learner), params.model, batch)

    def _lifting(self, learner: Learner) -> Model | None:
        """The learned model in whose planning states a learner gets batches; None: observations.

        The model's own learner and those of `latest` data get observations.
        """
        owners: list[Any] = [each for each in self.learners.values() if "model" in each.owns]
        observes = not owners or owners[0] is learner or learner.data == "latest"
        return None if observes else owners[0].model

    def step(self, state: AgentState, step: Array) -> tuple[AgentState, dict[str, Array]]:
        """One decision in every environment, `step` [] decisions into the run; metrics name -> [].

        A metric is NaN if it does not apply, infinite if it is not finite. `episode/...` are per
        environment [E].
        """
        keys = Keys.of(state.key, self.num_envs)
        u, state, planned = self.decide(state, step, keys)
        now = jax.vmap(self.episode.step)(state.env, u)
        state, learned = self.learn(self.observe(state, u, now, keys=keys), step, keys)
        return state, {**planned, **learned, **outcome(u, now)}

    def decide(
        self, state: AgentState, step: Array, keys: Keys | None = None
    ) -> tuple[Array, AgentState, dict[str, Array]]:
        """Actions [E, m] at `state.env`, `step` [] decisions into the run; metrics name -> [].

        They are random for `random_steps` decisions. The controllers' states [E, ...] change. keys:
        of this decision; None, as in `observe` and `learn`: drawn from `state.key`.
        """
        keys = Keys.of(state.key, self.num_envs) if keys is None else keys
        params = self.params(state)._replace(decisions=step)

        def plan() -> tuple[Array, Any, dict[str, Array]]:
            return act(self.controller, params, state.control, state.env, keys.deciding)

        if self.random_steps:
            plan = trace_once(plan)
            shapes = jax.eval_shape(plan)
            draw = jax.random.uniform(keys.at_random, shapes[0].shape, minval=-1, maxval=1)
            control = jax.vmap(remembered)(state.control, state.env.obs, draw)
            first = draw, control, jax.tree.map(jnp.zeros_like, shapes[2])
            u, control, metrics = jax.lax.cond(step < self.random_steps, lambda: first, plan)
        else:
            u, control, metrics = plan()
        metrics = masked_mean(metrics, step >= self.random_steps, sparse=True)
        return u, state.replace(control=control), metrics

    def observe(
        self,
        state: AgentState,
        action: Array,
        now: EnvState,
        after: EnvState | None = None,
        keys: Keys | None = None,
    ) -> AgentState:
        """`state` after action [E, m] led from `state.env` to `now` [E, ...].

        The memory gets the decision, with the action that acted by the known lag, and where an
        episode is done, another one begins. A world that resets itself gives `after` [E, ...]:
        `now`, or the first state of the next episode.
        """
        action = jax.vmap(acted)(state.control, action)
        new = Transition(state.env.obs, action, now.reward, now.terminated, now.truncated, now.obs)
        if after is None:
            keys = Keys.of(state.key, self.num_envs) if keys is None else keys
            after = jax.vmap(self.episode.auto_reset)(now, keys.resetting)
        return state.replace(
            env=after,
            control=where(now.done, self.first_control(), state.control),
            memory=self.replay.add(state.memory, new),
        )

    def learn(
        self, state: AgentState, step: Array, keys: Keys | None = None
    ) -> tuple[AgentState, dict[str, Array]]:
        """`state` after learning from the memory, and the metrics of the last updates, name -> [].

        The newest decision in the memory is that of `step` []. The next one gets other keys.
        """
        keys = Keys.of(state.key, self.num_envs) if keys is None else keys
        params = self.params(state)._replace(decisions=step)
        learned, metrics, starts = {}, {}, self.starts()
        each = jax.random.split(keys.learning, len(starts)) if starts else []
        for k, (name, learner) in zip(each, self.learners.items(), strict=True):
            if name in self.frozen:
                learned[name] = state.learners[name]
                continue
            count, every = update_schedule(name, learner, self.num_envs)

            def one(own: Any, keys: Array, learner: Learner = learner) -> tuple[Any, Any]:
                drawing, updating = keys
                batch = self._batch(state.memory, learner, params, drawing)
                return learner.update(own, params, batch, updating)

            @trace_once
            def update(own: Any, k: Array, count: int = count, one: Any = one) -> Any:
                own, rows = jax.lax.scan(one, own, jax.random.split(k, (count, 2)))
                return own, jax.tree.map(lambda m: m[-1], rows)

            before = state.learners[name]
            nothing = jax.tree.map(jnp.zeros_like, jax.eval_shape(update, before, k)[1])
            due = (step >= starts[name]) & ((step // self.num_envs) % every == 0)
            learned[name], latest = jax.lax.cond(
                due, update, lambda own, k, nothing=nothing: (own, nothing), before, k
            )
            metrics |= masked_mean(latest, due)
        return state.replace(learners=learned, key=keys.next), metrics

    def first_control(self) -> Any:
        """The controller's initial state in every environment [E, ...]."""
        return repeat(self.controller.init(self.spec), self.num_envs)


def update_schedule(name: str, learner: Learner, num_envs: int) -> tuple[int, int]:
    """(n, k) of a learner: n updates after every k decisions of each environment."""
    if learner.data == "latest":
        return 1, learner.every
    per_round = learner.updates * num_envs
    count = max(per_round, 1 / per_round) if per_round > 0 else math.nan
    if count <= LARGEST and float(count).is_integer():
        return (int(count), 1) if per_round >= 1 else (1, int(count))
    raise ValueError(
        f"{name}_learner.updates={learner.updates}: with num_envs={num_envs} this gives "
        f"{per_round:g} gradient steps per round; it must be a whole number, or 1 / a whole "
        f"number, of at most {LARGEST}"
    )


def trace_once(f: Any) -> Any:
    """`f`, jitted inline, so that repeated calls and `eval_shape` share one trace."""
    return jax.jit(f, inline=True)
