"""Random arrangements: drawn by their rule, and free of overlaps by the distance of the world."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.envs.analytic.contact_plane import rounded_box
from hybrid_rl.settings import build as config
from scripts.arrangements import GAP, draw

NAMES = {"first": 1, "second": 2, "third": 3}
SIDE = np.linspace(0, 1, 401, dtype=np.float32)
POINTS = jnp.asarray(np.stack(np.meshgrid(SIDE, SIDE), -1).reshape(-1, 2))


@pytest.mark.parametrize("name", NAMES)
def test_an_experiment_has_the_objects_of_its_seed(name: str) -> None:
    objects = config.load([f"experiment=arrangements/{name}"]).env.objects
    assert [tuple(each) for each in objects] == draw(NAMES[name])


def test_objects_lie_apart_from_each_other_and_from_the_walls() -> None:
    """The sum of the distances to two objects is least between them, where it is the gap."""
    each = jax.jit(jax.vmap(rounded_box, (0, *[None] * 6)))
    counts, edge = set(), np.asarray((POINTS == 0) | (POINTS == 1)).any(1)
    for seed in range(1, 13):
        objects = draw(seed)
        counts.add(len(objects))
        d = np.stack([each(POINTS, *map(float, shape)) for shape in objects])
        assert d[:, edge].min() > GAP
        for i in range(len(objects)):
            for j in range(i):
                assert (d[i] + d[j]).min() > GAP - 1e-3
    assert counts == {3, 4, 5}
