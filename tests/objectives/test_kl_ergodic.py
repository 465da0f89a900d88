"""Ergodic objectives against grids, and known optima."""

from dataclasses import replace
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.stats import norm

from hybrid_rl.core.domain import Box
from hybrid_rl.core.ergodic import Points, divergence
from hybrid_rl.objectives.fourier_ergodic import FourierErgodic
from hybrid_rl.objectives.kl_ergodic import JensenErgodic, KLErgodic
from hybrid_rl.settings import build as config
from hybrid_rl.targets.mixture import Mixture
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import EnvState, Params, Path, Spec

SPEC = Spec(obs=3, act=1, dt=0.1)
MEANS = np.array([[0.3, 0.2], [-0.4, -0.1]])
TARGET = Mixture(tuple(map(tuple, MEANS)), (0.2, 0.3), (1.0, 2.0))
BOX = Box(coordinates=(2, 0), low=(-1.0, -0.8), high=(1.0, 1.2))
KL = KLErgodic(TARGET, BOX, samples=50, variance=(0.05, 0.1), memory=4, floor=1e-3, barrier=2.0)
EACH = {
    "kl": KL,
    "jensen": JensenErgodic(TARGET, BOX, samples=50, variance=(0.1,), barrier=2.0),
    "fourier": FourierErgodic(TARGET, BOX, samples=50, modes=4, barrier=2.0),
}


def walk(length: int, seed: int = 0) -> np.ndarray:
    """States [length, 3], partly outside of the box."""
    return np.cumsum(np.random.default_rng(seed).normal(0, 0.4, (length, 3)), 0)


def after(objective, past: np.ndarray):
    """J of paths that begin at the last of the states `past` [P, 3]; the others are in memory."""
    memory, remember = objective.init(SPEC), remembering(objective)
    for x in past[:-1]:
        memory = remember(memory, jnp.asarray(x))

    @jax.jit
    def value(memory, x, path):
        return objective.prepare(Params(), memory, x, jnp.zeros(1), jax.random.key(0))[0](path)

    return partial(value, memory, jnp.asarray(past[-1]))


def remembering(objective):
    """(memory, x) -> memory after a decision at x, compiled."""

    def remember(memory, x):
        return objective.prepare(Params(), memory, x, jnp.zeros(1), jax.random.key(0))[1]

    return jax.jit(remember)


def p_of(s: np.ndarray) -> np.ndarray:
    """The target's density at s [N, 2], by SciPy."""
    each = [
        w * np.prod(norm.pdf(s, mean, std), -1)
        for w, mean, std in zip((1 / 3, 2 / 3), MEANS, (0.2, 0.3), strict=True)
    ]
    return np.sum(each, 0)


def test_measure_is_the_divergence_on_a_grid() -> None:
    """D(p || q), p normalised over the box, q the mean over path and memory, with a floor."""
    objective = replace(KL, samples=200_000, floor=0.05, barrier=0.0)
    past, path = 0.5 * walk(7, seed=2), 0.5 * walk(6)
    path[0] = past[-1]
    got = -after(objective, past)(Path(jnp.asarray(path), jnp.zeros((5, 1))))
    sides = [np.linspace(a, b, 401) for a, b in zip(BOX.low, BOX.high, strict=True)]
    s = np.stack(np.meshgrid(*[(v[1:] + v[:-1]) / 2 for v in sides], indexing="ij"), -1)
    s, cell = s.reshape(-1, 2), 2.0 / 400 * 2.0 / 400
    counted = np.concatenate([past[2:-1], path])[:, [2, 0]]  # M = 4 states in memory, and the path
    q = np.mean([np.prod(norm.pdf(s, x, np.sqrt([0.05, 0.1])), -1) for x in counted], 0)
    p, q = p_of(s) / (p_of(s).sum() * cell), q + 0.05 / BOX.volume
    assert float(got) == pytest.approx(float(np.sum(p * np.log(p / q)) * cell), rel=0.01)


def test_a_target_may_be_zero_somewhere() -> None:
    """D of p = (1/2, 1/2, 0) from uniform q is log(3/2)."""
    points = Points(jnp.zeros((3, 1)), jnp.log(jnp.array([0.5, 0.5, 0.0])))
    got = divergence(points, jnp.log(jnp.full(3, 1 / 3)), 3.0)
    assert float(got) == pytest.approx(np.log(1.5))


def test_leaving_the_box_has_its_price() -> None:
    """The mean over the path of the squared distance, in sides."""
    x = 0.5 * walk(6)
    x[3, 0] = 1.5  # 0.3 beyond a side of 2
    beyond = x[:, [2, 0]] - np.clip(x[:, [2, 0]], BOX.low, BOX.high)
    path = Path(jnp.asarray(x, jnp.float32), jnp.zeros((5, 1)))

    def value(name: str, barrier: float) -> jax.Array:
        objective = replace(EACH[name], barrier=barrier)
        given = Params(), objective.init(SPEC), path.x[0], jnp.zeros(1), jax.random.key(0)
        return objective.prepare(*given)[0](path)

    costs = jax.jit(lambda: jnp.stack([value(n, 0.0) - value(n, 50.0) for n in EACH]))()
    np.testing.assert_allclose(costs, 50 * np.mean(((beyond / 2) ** 2).sum(-1)), rtol=1e-4)


@pytest.mark.parametrize("name", EACH)
def test_what_is_covered_is_the_measure_of_the_episode_so_far(name) -> None:
    """J without barrier of one path over all states; of the bound, the measure that it bounds."""
    objective, x, key = EACH[name], jnp.asarray(walk(4)), jax.random.key(0)
    if name == "jensen":
        objective = replace(objective, memory=4)
    memory, remember = objective.init(SPEC), remembering(objective)
    for state in x[:-1]:
        memory = remember(memory, state)
    (got,) = jax.jit(lambda m: objective.covered(Params(), m, x[-1], key))(memory).values()
    whole = replace(objective, barrier=0.0)
    if name == "jensen":
        whole = KLErgodic(TARGET, BOX, samples=50, variance=(0.1,), memory=4)
    value = after(whole, x[:1])(Path(x, jnp.zeros((3, 1))))
    assert float(got) == pytest.approx(-float(value), rel=1e-4)


def test_the_bound_depends_only_on_the_mean() -> None:
    """Targets of equal mean give equal gradients towards it; those of the measure differ."""
    x = jnp.array([[0.1, 0.0, 0.2]] * 3)
    grads = {}
    for apart in (0.05, 0.5):
        target = Mixture(((apart, 0.2), (-apart, 0.2)), (0.1, 0.1), (1.0, 1.0))
        for name in ("jensen", "kl"):
            objective = replace(EACH[name], target=target, samples=100_000, barrier=0.0)
            slope = jax.grad(after(objective, x[:1]))(Path(x, jnp.zeros((2, 1))))
            grads[name, apart] = np.asarray(slope.x)[:, [2, 0]]
    wanted = -(np.array([0.2, 0.1]) - [0.0, 0.2]) / 0.1 / 3
    for apart in (0.05, 0.5):
        np.testing.assert_allclose(grads["jensen", apart][0], wanted, atol=0.02)
    assert np.abs(grads["kl", 0.05] - grads["kl", 0.5]).max() > 0.1


def test_fourier_metric_vanishes_on_a_path_that_is_the_target() -> None:
    """A path of samples of p has the coefficients of p; a path at rest does not."""
    objective = replace(EACH["fourier"], samples=100_000, barrier=0.0)
    rng = np.random.default_rng(0)
    which = rng.random(40_000) < 1 / 3
    s = np.where(which[:, None], MEANS[0], MEANS[1])
    s = s + rng.normal(size=s.shape) * np.where(which, 0.2, 0.3)[:, None]
    x = np.zeros((len(s), 3))
    x[:, 2], x[:, 0] = s[:, 0], s[:, 1]
    value = after(objective, x[:1])
    values = [float(value(Path(jnp.asarray(x), jnp.zeros((1, 1))))) for x in (x, 0 * x)]
    assert -1e-3 < values[0] <= 0
    assert values[1] < 100 * values[0]


@pytest.mark.parametrize("name", ["kl", "fourier"])
def test_a_share_of_the_target_is_uniform(name) -> None:
    """With share 1 the target does not matter; with less, J is that of the mixed density."""

    class Mixed:
        def log_density(self, params, s):
            p = jnp.exp(TARGET.log_density(params, s)) / TOTAL
            return jnp.log(0.7 * p + 0.3 / BOX.volume)

    grid = np.stack(np.meshgrid(np.linspace(-1, 1, 401), np.linspace(-0.8, 1.2, 401)), -1)
    TOTAL = p_of(grid.reshape(-1, 2)).mean() * BOX.volume  # of the density in the box
    path = Path(jnp.asarray(walk(6)), jnp.zeros((5, 1)))
    many = replace(EACH[name], samples=100_000, barrier=0.0)
    mixed = float(after(replace(many, share=0.3), walk(1))(path))
    assert mixed == pytest.approx(float(after(replace(many, target=Mixed()), walk(1))(path)), 0.01)
    assert abs(mixed / float(after(many, walk(1))(path)) - 1) > 0.03
    coverage = [
        float(after(replace(EACH[name], share=1.0, target=target), walk(1))(path))
        for target in (TARGET, Mixture(((0.9, 0.9),), (0.1,), (1.0,)))
    ]
    assert coverage[0] == coverage[1]


FORGOTTEN = [(0.0, [0, 0, 0]), (0.5, [0.125, 0.25, 0.5]), (1.0, [1, 1, 1])]


@pytest.mark.parametrize(("forget", "weights"), FORGOTTEN)
def test_earlier_states_are_forgotten(forget, weights) -> None:
    """Three earlier states with their weights, and the path; with 1 the mean is over all states."""
    objective, x = replace(EACH["fourier"], forget=forget), jnp.asarray(walk(6))
    memory, remember = objective.init(SPEC), remembering(objective)
    for state in x[:3]:
        memory = remember(memory, state)
    got = objective.average(memory, Path(x[3:], jnp.zeros((2, 1))))
    features = np.asarray(objective.features(x[:, jnp.array([2, 0])]))
    all_weights = np.array([*weights, 1, 1, 1])
    np.testing.assert_allclose(got, all_weights @ features / all_weights.sum(), atol=1e-5)


def explored(task: str, algo: str, steps: int) -> EnvState:
    """States of an episode of a method with its defaults."""
    run = config.build(config.load([f"task={task}", f"algo={algo}", f"episode.steps={steps + 1}"]))
    walk = jax.jit(rollout_with_actions, static_argnums=(0, 1, 4))
    episode, controller = run.agent.episode, run.controllers["full"]
    return walk(episode, controller, Params(), jax.random.key(0), steps)[1]


@pytest.mark.parametrize("algo", ["kle3", "fourier_ergodic"])
def test_the_methods_visit_both_hills_of_their_target_with_their_defaults(algo) -> None:
    """The regulator alone would rest in the trough between them."""
    x = np.asarray(explored("point_mass", algo, 300).obs)[:, :2]
    near = [(np.linalg.norm(x - hill, axis=1) < 0.2).mean() for hill in (0.3, 0.7)]
    assert min(near) > 0.25


def test_the_defaults_explore_around_an_unstable_equilibrium() -> None:
    """The rods stay up, and the cart spends its time at the hills, where no regulator leads."""
    states = explored("cart_double_pendulum", "kle3", 500)
    assert not np.any(states.done)
    assert np.abs(states.obs[:, 1:3]).max() < 0.3
    assert np.mean(states.obs[200:, 0] > 0.2) > 0.5
