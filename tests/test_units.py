"""Units change nothing: with all lengths a thousand times larger or smaller, paths are the same."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl import config
from hybrid_rl.beliefs.pose_particles import PoseParticles
from hybrid_rl.core.domain import Box
from hybrid_rl.data.replay import unpack
from hybrid_rl.envs.analytic.contact_plane import ContactPlane
from hybrid_rl.maps.known import KnownMap
from hybrid_rl.training.loop import Loop
from hybrid_rl.types import Spec

OBJECTS = ((0.3, 0.6, 0.0, 0.12, 0.12, 0.12), (0.7, 0.4, 0.4, 0.1, 0.08, 0.02))
PLANNER = ["explorer.horizon=3", "explorer.iterations=1", "belief.iterations=10"]
METHODS = {
    "ergodic_mapping": ["fourier_exploration.samples=64", "fourier_exploration.modes=4"],
    "kle3_mapping": ["exploration.samples=64"],
}
DECISIONS = 40


def scaled(factor: float) -> tuple[tuple[float, ...], ...]:
    """The objects with all lengths times `factor`; the third number is an angle."""
    units = [factor, factor, 1.0, factor, factor, factor]
    return tuple(tuple(float(a * b) for a, b in zip(each, units, strict=True)) for each in OBJECTS)


def lengths(algo: str, factor: float) -> list[str]:
    """Overrides of all lengths of a mapping method."""
    each = {
        "env.objects": [list(shape) for shape in scaled(factor)],
        "env.low": [0.0, 0.0],
        "env.high": [1.2 * factor, factor],
        "env.radius": 0.03 * factor,
        "env.acceleration": 2.0 * factor,
        "belief.length": 0.08 * factor,
        "belief.apart": 0.01 * factor,
    }
    if algo == "kle3_mapping":
        each["exploration.variance"] = [0.005 * factor**2]
    return [f"{key}={value}" for key, value in each.items()]


def path(algo: str, factor: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions [T, 2] and measured contacts [T] of a trial."""
    line = ["task=contact_plane", f"algo={algo}", *PLANNER, *METHODS[algo]]
    sizes = [f"total_steps={DECISIONS}", f"episode.steps={DECISIONS}", "belief.capacity=40"]
    agent = config.build(config.load([*line, *sizes, *lengths(algo, factor)])).agent
    loop = Loop(agent, (3,), stride=DECISIONS)
    state = loop.init()
    state, _ = loop.compile(state)(state, jnp.int32(0), jnp.int32(DECISIONS))
    made: Any = unpack(state.memory.rows[0, :DECISIONS, 0], agent.spec)
    return np.asarray(made.next_obs[:, :2]), np.asarray(made.reward)


@pytest.mark.parametrize(("algo", "factor"), [("ergodic_mapping", 1e3), ("kle3_mapping", 1e-3)])
def test_a_mapping_robot_in_other_units_takes_the_same_path(algo: str, factor: float) -> None:
    """Within a hundredth of the side after contacts, which amplify the rounding of float32."""
    (s, y), (other, felt) = path(algo, 1.0), path(algo, factor)
    assert y.any()
    np.testing.assert_array_equal(felt, y)
    np.testing.assert_allclose(other / factor, s, atol=0.01)
    assert np.abs(s - s[0]).max() > 0.3


def test_robots_in_other_units_start_at_the_same_positions() -> None:
    """Also where the first candidates are in an object."""
    starts = []
    for factor in (1.0, 1e-3):
        world = ContactPlane(scaled(factor), radius=0.03 * factor, high=(1.2 * factor, factor))
        keys = jax.random.split(jax.random.key(0), 64)
        starts.append(np.asarray(jax.jit(jax.vmap(world.reset))(keys).obs) / factor)
    np.testing.assert_allclose(*starts, rtol=1e-5)


def test_particles_in_other_units_are_the_same() -> None:
    """The posterior after measurements with a contact, with moves and leaps."""
    rng = np.random.default_rng(0)
    s, y = rng.uniform(0.1, 0.9, (12, 2)), np.zeros(12)
    y[5] = 1.0

    def particles(factor: float) -> tuple[np.ndarray, np.ndarray]:
        world: Any = ContactPlane(
            scaled(factor), radius=0.03 * factor, low=(0.0, 0.0), high=(1.2 * factor, factor)
        )
        known: Any = KnownMap(world, width=0.02 * factor)
        box = Box((0, 1), world.low, world.high)
        belief = PoseParticles(
            known, box, particles=40, capacity=12, every=6, length=0.3 * factor, subset=8
        )

        def one(state: Any, measured: Any) -> tuple[Any, None]:
            return belief.add(state, *measured), None

        @jax.jit
        def learn() -> Any:
            first = belief.init(jax.random.key(1), Spec(4, 2, 0.1))
            keys = jax.random.split(jax.random.key(2), len(s))
            points = jnp.asarray(factor * s, jnp.float32), jnp.asarray(y, jnp.float32), keys
            return jax.lax.scan(one, first, points)[0]

        state = learn()
        theta = np.asarray(state.theta) / [factor, factor, 1.0]
        return theta, np.asarray(state.log_w)

    theta, log_w = particles(1.0)
    other, weights = particles(1024.0)  # rounds as 1 does
    np.testing.assert_allclose(other, theta, atol=1e-3)
    np.testing.assert_allclose(weights, log_w, atol=1e-2)
