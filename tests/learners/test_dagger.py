"""Queries to a linear teacher: what is asked, when, and what the clone learns from it."""

from dataclasses import dataclass, replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from toys import begun

from hybrid_rl.errors import UsageError
from hybrid_rl.learners.dagger import DAgger, DAggerState, Queried
from hybrid_rl.models.exact import Exact
from hybrid_rl.policies.deterministic import Deterministic
from hybrid_rl.settings import build as config
from hybrid_rl.types import Batch, Params, Spec

SPEC = Spec(obs=3, act=2, dt=0.1)
GAIN = np.array([[0.25, -0.5, 0.125], [-0.125, 0.0625, 0.5]], np.float32)
X: Any = np.random.default_rng(0).normal(size=(40, 3)).astype(np.float32)
POLICY = Deterministic(hidden=(8,))
RECORDING: dict[str, Any] = {"steps": 0, "capacity": 2000}  # without learning


@dataclass(frozen=True)
class Linear:
    """u = GAIN x."""

    def init(self, spec: Spec) -> tuple[()]:
        return ()

    def act(self, params: Params, state: Any, obs: Any, key: Any) -> tuple:
        return jnp.asarray(GAIN) @ obs, state, {}

    def greedy(self) -> "Linear":
        return self


@dataclass(frozen=True)
class Far:
    """A density that grows with the first entry."""

    def log_density(self, params: Params, s: Any) -> Any:
        return s[0]


@dataclass(frozen=True)
class Halved:
    """x' = x / 2 + (u, 0)."""

    def dynamics(self, x: Any, u: Any) -> Any:
        return x / 2 + jnp.append(u, 0.0)


def after(learner: DAgger, x: Any = X) -> DAggerState:
    """The state after decisions at the rows of x."""

    def one(state: DAggerState, at: tuple) -> tuple:
        obs, key = at
        batch = Batch(*[obs[None]] * 7)
        params = Params(**learner.params(state))
        return learner.update(state, params, batch, key)[0], None

    keys = jax.random.split(jax.random.key(0), len(x))
    first = begun(learner, SPEC, 1)
    return jax.jit(lambda s: jax.lax.scan(one, s, (jnp.asarray(x), keys))[0])(first)


@pytest.mark.parametrize("capacity", [64, 16])
def test_dagger_labels_the_states_of_the_run(capacity: int) -> None:
    """The ring is (obs, teacher(obs)), bit for bit; of a full one the oldest are overwritten."""
    labels = after(DAgger(POLICY, Linear(), capacity=capacity)).labels
    assert int(labels.count) == len(X)
    count = min(capacity, len(X))
    last = X[-count:]
    order = np.arange(len(X) - count, len(X)) % capacity
    np.testing.assert_array_equal(labels.obs[order], last)
    wanted = jax.jit(jax.vmap(lambda x: jnp.asarray(GAIN) @ x))(last)
    np.testing.assert_array_equal(labels.action[order], wanted)
    assert not np.asarray(labels.obs[count:]).any()


def test_random_queries_are_spread_by_the_deviations_of_the_first_demonstration() -> None:
    """In units of them, or in those of the observation."""
    x = np.tile(np.array([[1.0, 0.0, 0.0], [-1.0, 4.0, 0.0]], np.float32), (1000, 1))
    for normalise, wanted in ((True, [0.2, 0.4, 0.2]), (False, [0.2, 0.2, 0.2])):
        fields = {"spread": 0.2, "normalise": normalise, "first": 100, **RECORDING}
        learner = DAgger(POLICY, Linear(), **fields)
        state = after(learner, x)
        np.testing.assert_array_equal(state.labels.obs[:100], x[:100])
        away = np.asarray(state.labels.obs[100:]) - x[100:]
        np.testing.assert_allclose(away.std(0), wanted, rtol=0.06)
        np.testing.assert_allclose(away.mean(0), 0, atol=0.04)


def test_a_target_chooses_among_the_candidates() -> None:
    """The largest of ten normal deviations is 1.54 on average; the record has its value."""
    x = np.zeros((2000, 3), np.float32)
    fields = {"candidates": 10, "spread": 0.5, "normalise": False, **RECORDING}
    learner = DAgger(POLICY, Linear(), Far(), **fields)
    state = after(learner, x)
    assert float(state.labels.obs[:, 0].mean()) == pytest.approx(0.5 * 1.5388, rel=0.03)
    np.testing.assert_array_equal(state.information, state.labels.obs[:, 0])


def test_an_oracle_asks_where_the_clone_errs_most() -> None:
    """Its queries have a larger error than those at random."""
    x = np.zeros((500, 3), np.float32)
    plain = DAgger(POLICY, Linear(), spread=1.0, normalise=False, steps=0, capacity=500)
    errors = []
    for learner in (plain, replace(plain, candidates=10, oracle=True)):
        state = after(learner, x)
        clone = POLICY.mean(state.policy, state.labels.obs)
        errors.append(np.square(clone - state.labels.action).sum(1).mean())
    assert errors[1] > 1.5 * errors[0]


def records() -> list[int]:
    """The rows of X whose first entry exceeds that of all before."""
    first = X[:, 0]
    return [i for i in range(len(X)) if i == 0 or first[i] > first[:i].max()]


@pytest.mark.parametrize(
    ("fields", "decisions"),
    [
        ({"most": 7}, range(7)),
        ({"spacing": 15, "most": 9}, [0, 15, 30]),
        ({"target": Far(), "better": True}, records()),
    ],
)
def test_some_decisions_are_asked_about(fields: dict, decisions: Any) -> None:
    """The first ones, those that are spaced, or those that exceed the one before."""
    state = after(DAgger(POLICY, Linear(), **fields))
    count = int(state.queries)
    np.testing.assert_array_equal(state.decision[:count], list(decisions))
    np.testing.assert_array_equal(state.labels.obs[:count], X[list(decisions)])
    assert int(state.labels.count) == count


@pytest.mark.parametrize("members", [1, 3])
def test_a_long_answer_is_a_path_of_the_teacher(members: int) -> None:
    """Through the model, from the state that was asked about; for one learner and for several."""
    world: Any = Halved()
    model = Exact(world)
    learner = DAgger(POLICY, Linear(), model=model, length=5, spacing=20, most=2, capacity=10)
    x = jnp.broadcast_to(jnp.asarray(X), (members, *X.shape))
    state = jax.tree.map(lambda each: each[-1], jax.vmap(lambda x: after(learner, x))(x))
    x, rows = X[0], []
    for _ in range(5):
        u = GAIN @ x
        rows.append(x)
        x = x / 2 + np.append(u, 0)
    np.testing.assert_allclose(state.labels.obs[:5], rows, rtol=1e-5, atol=1e-6)
    np.testing.assert_array_equal(state.labels.obs[5], X[20])
    assert int(state.labels.count) == 10


def test_the_clone_learns_the_teacher() -> None:
    """After more steps on the labels; a linear clone is exact."""
    learner = DAgger(Deterministic(hidden=(), squash="clip"), Linear(), learning_rate=0.01, edge=1)
    state = jax.jit(learner.fit, static_argnums=1)(after(learner, X / 4), 3000, jax.random.key(2))
    layer = state.policy["weights"]["Dense_0"]
    np.testing.assert_allclose(layer["kernel"], GAIN.T, atol=1e-2)
    np.testing.assert_allclose(layer["bias"], 0, atol=1e-2)


def test_no_step_is_taken_before_the_first_demonstration_ends() -> None:
    """Nor without a label."""
    learner = DAgger(POLICY, Linear(), first=40, first_steps=30)
    before, end = after(learner, X[:39]), after(learner)
    weights = begun(learner, SPEC, 1).policy["weights"]
    jax.tree.map(np.testing.assert_array_equal, before.policy["weights"], weights)
    assert int(end.optimiser[0].count) == 30
    assert int(end.queries) == 0
    state = learner.fit(begun(learner, SPEC, 1), 10, jax.random.key(0))
    assert int(state.optimiser[0].count) == 0


@dataclass(frozen=True)
class Summed:
    """A target that wants x x' of the labels, and compares with it."""

    def evidence(self, params: Params, x: Any) -> Any:
        return jnp.outer(x, x)

    def log_density(self, params: Params, s: Any) -> Any:
        assert isinstance(params.labels, Queried)
        return -(s @ params.labels.evidence @ s)


def test_the_evidence_is_a_sum_over_the_labels() -> None:
    """Its running mean over batches, times the number of labels, for labels of two kinds."""
    x = np.tile(np.array([[1.0, 0.0, 2.0], [0.0, -3.0, 1.0]], np.float32), (500, 1))
    learner = DAgger(POLICY, Linear(), Summed(), steps=0, batch_size=256, capacity=1000)
    labels = learner.params(after(learner, x))["labels"]
    np.testing.assert_allclose(labels.evidence, x.T @ x, rtol=0.05, atol=0.05 * 4500)


def test_a_task_without_an_expert_is_refused() -> None:
    with pytest.raises(UsageError, match="expert=null: this task has no expert"):
        config.build(config.load(["task=pendulum", "algo=dagger"]))
