"""Random arrangements of objects: an experiment has those that its seed draws."""

import pytest

from hybrid_rl.settings import build as config
from scripts.arrangements import draw


@pytest.mark.parametrize(("name", "seed"), [("first", 1), ("second", 2), ("third", 3)])
def test_an_experiment_has_the_objects_of_its_seed(name: str, seed: int) -> None:
    objects = config.load([f"experiment=arrangements/{name}"]).env.objects
    assert [tuple(each) for each in objects] == draw(seed)
