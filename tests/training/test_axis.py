"""The numbers in which agents differ, and one agent with them."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import pytest

from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.learners.sac import SAC
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.training.loop import Axis, DifferError

ONE = SAC(TanhGaussian(hidden=(4,)), EnsembleQ(hidden=(4,)), discount=0.9)
OTHER = replace(ONE, policy=TanhGaussian(hidden=(4,), log_std_max=1.0), discount=0.95)


def test_the_numbers_that_differ_make_one_tree_the_other():
    trees = [{"a": (each, "word", 3)} for each in (ONE, OTHER)]
    axis = Axis.of(trees)
    assert axis.numbers == {"a.0.policy.log_std_max": (2.0, 1.0), "a.0.discount": (0.9, 0.95)}
    second = {path: values[1] for path, values in axis.numbers.items()}
    assert axis.put(trees[0]["a"], "a", second) == trees[1]["a"]
    assert axis.put(trees[0]["a"], "b", second) is trees[0]["a"]
    assert Axis.of([ONE, replace(ONE)]).numbers == {}


def test_a_part_with_a_traced_number_skips_the_check_of_its_field():
    axis = Axis.of([{"a": ONE}, {"a": OTHER}])
    doubled = jax.jit(lambda x: 2 * axis.put(ONE, "a", {"a.discount": x}).discount)
    assert doubled(jnp.float32(0.25)) == 0.5


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"batch_size": 3}, "batch_size"),
        ({"during_random": True}, "during_random"),
        ({"target_entropy": -1.0}, "target_entropy"),
        ({"policy": TanhGaussian(hidden=(5,))}, "policy.hidden.0"),
        ({"policy": TanhGaussian(hidden=(4, 4))}, "policy.hidden"),
        ({"critic": EnsembleQ(hidden=(4,), activation="tanh")}, "critic.activation"),
    ],
)
def test_what_is_no_number_is_refused_by_its_path(change, path):
    with pytest.raises(DifferError) as caught:
        Axis.of([ONE, replace(ONE, **change)])
    assert caught.value.path == path


def test_a_whole_number_stands_for_a_number():
    assert Axis.of([ONE, replace(ONE, discount=0)]).numbers == {"discount": (0.9, 0.0)}
