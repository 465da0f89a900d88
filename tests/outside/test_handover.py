"""Parameters in a file, which one process writes and another reads."""

import numpy as np
import pytest

from hybrid_rl.outside import handover

TREE = {"a": np.arange(6, dtype=np.float32).reshape(2, 3), "b": np.int32(4)}


def test_parameters_are_handed_over(tmp_path):
    handover.publish(tmp_path / "parameters", TREE, 7)
    version, tree = handover.latest(tmp_path / "parameters", TREE)
    assert version == 7
    assert np.array_equal(tree["a"], TREE["a"])
    assert tree["b"] == 4


@pytest.mark.parametrize("damage", ["absent", "cut", "changed", "other"])
def test_no_part_of_damaged_parameters_is_used(tmp_path, damage):
    file, like = tmp_path / "parameters", TREE
    if damage != "absent":
        handover.publish(file, TREE, 7)
    if damage == "cut":
        file.write_bytes(file.read_bytes()[:-1])
    if damage == "changed":
        file.write_bytes(file.read_bytes()[:-1] + b"\x07")
    if damage == "other":
        like = TREE | {"a": np.zeros((2, 2), np.float32)}
    assert handover.latest(file, like) is None
