"""Gymnasium environments that are wrong, or go wrong: one line says what they must be."""

import re
from typing import Any, ClassVar

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from gymnasium.spaces import Box, Dict, Discrete
from gymnasium.wrappers import OrderEnforcing, TimeLimit
from hosted import Count, counting

from hybrid_rl.envs.adapters.external import Copies, External
from hybrid_rl.errors import UsageError, WorldError
from hybrid_rl.fields import FieldError
from hybrid_rl.rewards.aim import Aim
from hybrid_rl.types import Spec

STEPS = 5  # decisions of an episode


@pytest.mark.parametrize(
    ("fail", "line"),
    [
        ("nan", "Count: step: entry 1 of obs is not finite"),
        ("size", "Count: step: ValueError: "),
        ("reward", "Count: step: gives a reward that is not finite"),
    ],
)
def test_what_goes_wrong_in_an_environment_is_one_line(fail, line):
    copies = Copies(counting(fail=fail), [1, 2], STEPS)
    copies.reset()
    with pytest.raises(WorldError, match=re.escape(line)) as error:
        list(map(copies.step, np.zeros((3, 2, 1))))
    assert "\n" not in str(error.value)


class Odd(gymnasium.Env):
    """Spaces that have to be flattened, or refused."""

    observation_space = Dict({"b": Discrete(3), "a": Box(0, 1, (2, 2))})
    metadata: ClassVar = {"render_fps": 50}

    def __init__(self, actions: Any = None, obs: Any = None) -> None:
        self.action_space = Box(-1, 1, (2, 1)) if actions is None else actions
        if obs is not None:
            self.observation_space = obs

    def reset(self, seed: int | None = None, options: dict | None = None) -> tuple:
        return self.observation_space.sample(), {}

    def step(self, action: np.ndarray) -> tuple:
        return self.observation_space.sample(), 0.0, False, False, {}


def test_spaces_of_any_form_are_flattened():
    odd = External(make=Odd)
    assert (odd.spec, odd.parts) == (Spec(obs=7, act=2, dt=0.02), "a [4], b [3]")
    np.testing.assert_array_equal(odd.flat({"b": 1, "a": np.ones((2, 2))}), [1, 1, 1, 1, 0, 1, 0])
    assert counting().parts == ""


def test_goals_are_for_what_its_class_measures():
    measured = other(quantities=lambda _, obs: {"episode": obs[0]})
    worlds: list[Any] = [External(**measured), counting()]
    goal = Aim(worlds[0], "episode", target=3.0)
    assert goal.reward_of(jnp.zeros(2), jnp.zeros(1), jnp.array([1.0, 0.0])) < 0
    with pytest.raises(FieldError, match="needs an environment with `quantities`"):
        Aim(worlds[1], "episode", target=3.0)


def test_an_action_of_whole_numbers_is_the_nearest():
    class Whole(Count):
        action_space = Box(-2, 4, (1,), np.int32)

    copies = Copies(External(make=Whole), [0], STEPS)
    copies.reset()
    rewards = [copies.step(np.array([[u]])).reward[0] for u in (0.9, -0.9, 0.0)]
    assert rewards == [4, -2, 1]


def test_a_time_limit_among_the_wrappers_is_that_of_the_episode():
    limited = External(make=lambda: OrderEnforcing(TimeLimit(Odd(), 50)))
    assert limited.known.steps == 50
    assert External(make=Odd).known.steps is None


def other(**members: Any) -> dict[str, Any]:
    return {"make": type("Other", (Count,), members)}


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({}, "give an id of Gymnasium, or env.make=MODULE:CLASS"),
        ({"id": "Hoper-v5"}, "env.id=Hoper-v5: NameNotFound: "),
        ({"id": "CartPole-v1"}, "CartPole-v1: has actions Discrete(2)"),
        ({"make": Odd, "kwargs": {"actions": Box(-np.inf, 1, (1,))}}, "finite bounds"),
        ({"make": "nowhere:Env"}, "env.make=nowhere:Env: cannot be imported (No module named"),
        ({"make": Odd, "kwargs": {"obs": Box(-1, 1, (0,))}}, "they must be numbers in a form"),
        (other(metadata={}), "does not say its time step"),
        (other(_seen=lambda _: np.zeros(3)), "reset: returns obs of 3 numbers; its space has 2"),
        (other(step=lambda *_: (0, 0, 0, {})), "step: returns a tuple of 4; it must be (obs,"),
    ],
)
def test_what_is_no_usable_environment_is_one_line(given, line):
    with pytest.raises(UsageError, match=re.escape(line)) as error:
        External(**given)
    assert "\n" not in str(error.value)


def test_an_id_without_a_version_has_the_time_limit_of_the_newest():
    with pytest.warns(UserWarning, match="latest versioned"):
        assert External(id="Pendulum").known.steps == 200


def test_a_picture_of_an_environment_that_draws_none_is_one_line():
    copies = Copies(counting(), [0], STEPS)
    copies.reset()
    with pytest.raises(WorldError, match="render: NotImplementedError; for a video"):
        copies.picture()


def test_planning_on_the_environment_itself_is_refused():
    env = counting()
    with pytest.raises(UsageError, match="steps outside JAX"):
        env.step(env.reset(jax.random.key(0)), jnp.zeros(1))
