"""Maps of contact against NumPy; map files that are unusable."""

from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.beliefs.maps.known import KnownMap
from hybrid_rl.beliefs.maps.learned import LearnedMap
from hybrid_rl.envs.analytic.contact_plane import ContactPlane

DISC = ContactPlane(objects=((0.5, 0.5, 0.0, 0.2, 0.2, 0.2),))


def test_the_known_map_steps_where_the_robot_touches() -> None:
    """Around a disc: p by the distance from its middle; the outline at the sum of the radii."""
    known = KnownMap(DISC, width=0.01, low=0.02, high=0.9)
    r = np.linspace(0.1, 0.45, 30)
    s = 0.5 + r[:, None] * np.array([0.6, 0.8])
    logit = (0.03 + 0.01 - (r - 0.2)) / 0.01
    want = 0.02 + 0.88 / (1 + np.exp(-logit))
    got = jax.jit(jax.vmap(known.chance))(jnp.asarray(s, jnp.float32))
    np.testing.assert_allclose(got, want, rtol=1e-3)
    radii = np.hypot(*(known.outline - 0.5).T)
    np.testing.assert_allclose(radii, 0.23, atol=2e-4)
    angle = np.arctan2(*(known.outline - 0.5).T)
    assert np.histogram(angle, 8, (-np.pi, np.pi))[0].min() > 5
    assert known.middle == (0.5, 0.5)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A map whose f is bilinear: 1 - 2 x + y - 3 x y on the box [0, 2] x [0, 1]."""
    x, y = np.meshgrid(np.linspace(0, 2, 9), np.linspace(0, 1, 6), indexing="ij")
    f = 1 - 2 * x + y - 3 * x * y
    np.savez(tmp_path / "map.npz", f=np.float32(f), low=[0.0, 0.0], high=[2.0, 1.0], slope=2.0)
    return tmp_path / "map.npz"


def test_the_learned_map_interpolates_f(file: Path) -> None:
    """Exact for a bilinear f; -1 outside of the box; f = 0 along the outline."""
    made = LearnedMap(str(file), (0.0, 0.0), (2.0, 1.0), 0.1, 0.8)
    s = np.random.default_rng(0).uniform([0, 0], [2, 1], (50, 2))
    x, y = s.T
    f = 1 - 2 * x + y - 3 * x * y
    got = jax.jit(jax.vmap(made.decision))(jnp.asarray(s, jnp.float32))
    np.testing.assert_allclose(got, f, atol=1e-5)
    p = jax.jit(jax.vmap(made.chance))(jnp.asarray(s, jnp.float32))
    np.testing.assert_allclose(p, 0.1 + 0.7 / (1 + np.exp(-2 * f)), rtol=1e-4)
    assert float(made.decision(jnp.array([2.1, 0.5]))) == -1
    x, y = made.outline.T
    np.testing.assert_allclose(1 - 2 * x + y - 3 * x * y, 0, atol=2e-2)
    assert len(x) > 5


def test_unusable_map_files_are_refused(file: Path, tmp_path: Path) -> None:
    """One line that names the file."""
    box = ((0.0, 0.0), (2.0, 1.0))
    cut = tmp_path / "cut.npz"
    cut.write_bytes(file.read_bytes()[:200])
    np.savez(tmp_path / "short.npz", f=np.eye(2))
    words = {"cut": "damaged", "short": "lacks low, high, slope", "none": "no such file"}
    for name, line in words.items():
        path = tmp_path / f"{name}.npz"
        with pytest.raises(ValueError, match=f"map.file={path}: .*{line}"):
            LearnedMap(str(path), *box)
    with pytest.raises(ValueError, match=r"is of the box \[0.0, 0.0, 2.0, 1.0\], this task's is"):
        LearnedMap(str(file))
