"""Behaviour cloning recovers a known policy and does not depend on experience."""

from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.learners.bc import BehaviourCloning, CloningState
from hybrid_rl.policies.deterministic import Deterministic
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.types import Batch, Params, Spec, Transition

SPEC = Spec(obs=3, act=2, dt=0.1)
GAIN = np.array([[0.5, -0.3, 0.2], [-0.4, 0.1, 0.6]])
STD = 0.2  # of the expert's noise before tanh


@dataclass(frozen=True)
class Shown:
    """Decisions of an expert with u = tanh(GAIN x + noise)."""

    count: int = 4000

    def load(self) -> Transition:
        """Its decisions; only states and actions are numbers."""
        rng = np.random.default_rng(0)
        x = rng.normal(size=(self.count, 3)).astype(np.float32)
        z = x @ GAIN.T + STD * rng.normal(size=(self.count, 2))
        nothing = np.full(self.count, np.nan, np.float32)
        return Transition(x, np.tanh(z).astype(np.float32), nothing, nothing, nothing, x * np.nan)


def train(learner: BehaviourCloning, steps: int, fill: float = jnp.nan) -> CloningState:
    """The state after `steps` updates, with a batch of experience that is all `fill`."""
    shapes = {"obs": (3,), "next_obs": (3,), "action": (2,), "next_action": (2,)}
    batch = Batch(*(jnp.full((4, *shapes.get(name, ())), fill) for name in Batch._fields))

    def one(state: CloningState, key: jax.Array) -> tuple:
        return learner.update(state, Params(), batch, key)[0], None

    keys = jax.random.split(jax.random.key(1), steps)
    return jax.jit(lambda s: jax.lax.scan(one, s, keys)[0])(learner.init(jax.random.key(0), SPEC))


def test_a_linear_policy_is_recovered() -> None:
    """Its mean, and the standard deviation of its noise."""
    policy = TanhGaussian(hidden=(32,), log_std_activation="relu")
    known = train(BehaviourCloning(policy, Shown(), learning_rate=3e-3), 3000).policy
    x = np.random.default_rng(1).normal(size=(500, 3)).astype(np.float32)
    mu, sigma = policy.gaussian(known, x)
    assert np.abs(np.asarray(mu) - x @ GAIN.T).mean() < 0.05
    assert float(sigma.mean()) == pytest.approx(STD, rel=0.1)


def test_experience_does_not_change_the_policy() -> None:
    """The result is equal bit for bit for a batch of NaN and one of numbers."""
    learner = BehaviourCloning(TanhGaussian(hidden=(8,)), Shown(100))
    one, other = train(learner, 20, jnp.nan), train(learner, 20, 7.0)
    jax.tree.map(np.testing.assert_array_equal, one, other)
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(one))


def test_actions_at_the_edge_are_bounded() -> None:
    """An action of exactly 1 has a finite likelihood."""

    @dataclass(frozen=True)
    class Closed(Shown):
        def load(self) -> Transition:
            shown = super().load()
            return shown._replace(action=np.ones_like(shown.action))

    policy = TanhGaussian(hidden=(8,))
    state = train(BehaviourCloning(policy, Closed(50), edge=0.9, learning_rate=0.01), 2000)
    mean = policy.mean(state.policy, jnp.asarray(Closed(50).load().obs))
    np.testing.assert_allclose(mean, 0.9, atol=0.05)


def test_matrices_decay_and_nothing_else() -> None:
    """After one step by rate x decay x first matrix; biases and statistics as without decay."""
    policy, rate = TanhGaussian(hidden=(4,), normalise=True), 0.01
    first, plain = (
        train(BehaviourCloning(policy, Shown(100), learning_rate=rate), n) for n in (0, 1)
    )
    decayed = train(BehaviourCloning(policy, Shown(100), learning_rate=rate, weight_decay=0.5), 1)
    trees = (jax.tree.leaves_with_path(state.policy) for state in (first, plain, decayed))
    kinds = set()
    for (path, w0), (_, w), (_, w_decayed) in zip(*trees, strict=True):
        decay = rate * 0.5 if getattr(path[-1], "key", None) == "kernel" else 0.0
        kinds.add(decay)
        np.testing.assert_allclose(w_decayed, w - decay * w0, rtol=1e-5, atol=1e-7)
    assert len(kinds) == 2


def test_the_mean_of_the_weights_acts() -> None:
    """It is the recursion in NumPy over the weights of a learner without it."""
    policy = TanhGaussian(hidden=(4,), normalise=True)
    plain = [train(BehaviourCloning(policy, Shown(100)), steps) for steps in range(4)]
    learner = BehaviourCloning(policy, Shown(100), average=0.2)
    got = learner.params(train(learner, 3))["policy"]
    each = [jax.tree.leaves(state.policy) for state in plain]
    for leaf, path in zip(jax.tree.leaves(got), zip(*each, strict=True), strict=True):
        wanted = np.asarray(path[0], np.float64)
        for new in path[1:]:
            wanted = wanted + 0.2 * (np.asarray(new) - wanted)
        np.testing.assert_allclose(leaf, wanted, rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize(
    "fields", [{"edge": 1.0}, {"learning_rate": 0.0}, {"average": 0.0}, {"weight_decay": -1.0}]
)
def test_bad_fields_are_refused(fields: dict) -> None:
    """The error names the field."""
    with pytest.raises(ValueError, match=f"{next(iter(fields))}"):
        BehaviourCloning(TanhGaussian(hidden=(8,)), Shown(), **fields)


def test_a_saturation_above_the_edge_is_refused() -> None:
    """It would have no effect: no action is left that counts as clipped."""
    BehaviourCloning(Deterministic(saturation=0.95), Shown(), edge=0.95)
    line = r"saturation=0\.95: must be at most cloning_learner\.edge=0\.9,"
    with pytest.raises(ValueError, match=line):
        BehaviourCloning(Deterministic(saturation=0.95), Shown(), edge=0.9)
