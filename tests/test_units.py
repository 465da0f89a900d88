"""Units change nothing: with all lengths a thousand times larger or smaller, paths are the same."""

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.beliefs.maps.known import KnownMap
from hybrid_rl.core import poses
from hybrid_rl.data.replay import unpack
from hybrid_rl.envs.analytic.contact_plane import ContactPlane
from hybrid_rl.settings import build as config
from hybrid_rl.training.loop import Loop

pytestmark = pytest.mark.turns(4)

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
        high = (1.2 * factor, factor)
        world = ContactPlane(objects=scaled(factor), radius=0.03 * factor, high=high)
        keys = jax.random.split(jax.random.key(0), 64)
        starts.append(np.asarray(jax.jit(jax.vmap(world.reset))(keys).obs) / factor)
    np.testing.assert_allclose(*starts, rtol=1e-5)


def test_moves_of_poses_do_not_depend_on_units() -> None:
    """The outline of the map, and walks, turns and leaps with their densities."""
    moved, ratios = [], []
    for factor in (1.0, 1024.0):  # rounds as 1 does
        units = np.array([factor, factor, 1.0], np.float32)
        high = (1.2 * factor, factor)
        world: Any = ContactPlane(objects=scaled(factor), radius=0.03 * factor, high=high)
        known = KnownMap(world)
        frame = poses.Frame(*map(jnp.array, (world.low, high, known.middle, known.outline)))
        theta, contact = jnp.asarray(units) * jnp.array([0.5, 0.6, 2.0]), 0.4 * units[:2]

        def move(key: Any, frame: Any = frame, theta: Any = theta, contact: Any = contact) -> Any:
            return poses.move(frame, theta, contact, jnp.array(True), poses.CHANCES, key)

        keys = jax.random.split(jax.random.key(0), 64)
        proposals, ratio = jax.jit(jax.vmap(move))(keys)
        moved.append(np.asarray(proposals) / units)
        ratios.append(np.asarray(ratio))
    np.testing.assert_allclose(*moved, atol=1e-4)
    np.testing.assert_allclose(*ratios, atol=1e-3)
    assert (ratios[0] != 0).any()
