"""Gymnasium environments that are wrong, or go wrong: one line says what they must be."""

import random
from collections.abc import Callable
from typing import Any, ClassVar

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from gymnasium.spaces import Box, Dict, Discrete
from gymnasium.wrappers import OrderEnforcing, TimeLimit
from hosted import Count, counting

from hybrid_rl.envs.adapters.external import External
from hybrid_rl.errors import UsageError, WorldError
from hybrid_rl.fields import FieldError
from hybrid_rl.settings import build as config
from hybrid_rl.settings.values import check
from hybrid_rl.types import Spec

STEPS = 5  # decisions of an episode


@pytest.mark.parametrize(
    ("fail", "line"),
    [
        ("error", ": ValueError: motor off"),
        ("exit", ": SystemExit; raise an error instead of sys.exit()"),
        ("nan", "Count: step: entry 1 of obs is not finite"),
        ("size", "Count: step: "),
        ("reward", "Count: step: gives a reward that is not finite"),
    ],
)
def test_what_goes_wrong_in_an_environment_is_one_line(fail, line):
    copies = counting(fail=fail).copies([1, 2], STEPS)
    copies.reset()
    with pytest.raises(WorldError) as error:
        list(map(copies.step, np.zeros((3, 2, 1))))
    assert line in str(error.value)
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
    with pytest.raises(UsageError, match=r"Odd: has observations Box\(.*; they must be numbers in"):
        External(make=Odd, kwargs={"obs": Box(-1, 1, (0,))})
    with pytest.raises(UsageError, match=r"CartPole-v1: has actions Discrete\(2\); they must be a"):
        External(id="CartPole-v1")


def test_an_id_that_is_a_number_is_one_line():
    with pytest.raises(UsageError, match=r"env\.id=3: must be a word"):
        check(config.load(["task=gymnasium", "algo=sac", "env.id=3"]))


def test_an_action_of_whole_numbers_is_the_nearest():
    class Whole(Count):
        action_space = Box(-2, 4, (1,), np.int32)

    copies = External(make=Whole).copies([0], STEPS)
    copies.reset()
    rewards = [copies.step(np.array([[u]])).reward[0] for u in (0.9, -0.9, 0.0)]
    assert rewards == [4, -2, 1]


def test_a_time_limit_among_the_wrappers_is_that_of_the_episode():
    limited = External(make=lambda: OrderEnforcing(TimeLimit(Odd(), 50)))
    assert limited.known.steps == 50
    assert External(make=Odd).known.steps is None


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({}, "give an id of Gymnasium, or env.make=MODULE:CLASS"),
        ({"id": "Hoper-v5"}, "env.id=Hoper-v5: NameNotFound: Environment `Hoper` doesn't exist"),
        ({"id": "CartPole-v1"}, "CartPole-v1: has actions Discrete(2)"),
        ({"make": Odd, "kwargs": {"actions": Box(-np.inf, 1, (1,))}}, "finite bounds"),
        ({"make": Odd, "kwargs": {"obs": Box(0, 255, (300, 400, 3))}}, "must be numbers"),
        ({"make": "nowhere:Env"}, "env.make=nowhere:Env: cannot be imported (No module named"),
        ({"make": "./reach.py:Reach"}, "cannot be imported (a module has no .py: reach:Reach)"),
        ({"make": "json:loads"}, "env.make=json:loads: TypeError"),
        ({"make": ["a"]}, "env.make=['a']: must be MODULE:CLASS"),
        ({"make": Odd, "kwargs": {"actions": Box(-1, 1, (0,))}}, "of one number or more"),
        ({"make": type("Timed", (Odd,), {"dt": "fast"})}, "Timed: does not say its time step; add"),
        ({"id": "Pendulum-v1", "kwargs": 3}, "env.kwargs=3: must be {KEY: VALUE}"),
        ({"id": "Pendulum-v1", "timeout_s": 1.0}, "goes with env.processes=true"),
    ],
)
def test_what_is_no_usable_environment_is_one_line(given, line):
    with pytest.raises(UsageError) as error:
        External(**given)
    assert line in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("base", "method", "returned", "line"),
    [
        (Count, "step", (np.ones(2), 0.0, False, {}), "returns 4 things; it must return obs, rew"),
        (Count, "step", (np.ones(3), 0.0, False, False, {}), "obs has the shape [3]; its space"),
        (Count, "step", (np.ones(2), np.zeros(1), False, False, {}), "reward has the shape [1]; i"),
        (Count, "step", (np.ones(2), np.nan, False, False, {}), "reward is not finite"),
        (Count, "step", (np.array([0, np.nan]), 0.0, False, False, {}), "entry 1 of obs is not fi"),
        (Count, "reset", (np.array([0, 1e300]), {}), "entry 1 of obs is not finite"),
        (Count, "reset", np.ones(2), "returns ndarray; it must return obs, info"),
        (Odd, "reset", ({"a": np.ones((2, 2))}, {}), "obs lacks the key 'b' of its space, Dict('a"),
        (Odd, "step", (np.ones(7), 0.0, False, False, {}), "obs does not fit its space, Dict('a'"),
    ],
)
def test_what_the_first_step_returns_is_checked_before_a_run(base, method, returned, line):
    kind = type("Wrong", (base,), {method: lambda self, *_, **options: returned})
    with pytest.raises(UsageError) as error:
        External(make=kind)
    assert line in str(error.value)
    assert "\n" not in str(error.value)


class Drawn(Count):
    """Draws from a generator of the process; `seeds`: after `reset` has seeded it."""

    def __init__(self, draw: Callable[[], float], seeds: bool = False) -> None:
        super().__init__()
        self.draw, self.seeds = draw, seeds

    def reset(self, seed: int | None = None, options: dict | None = None) -> tuple:
        if self.seeds:
            np.random.seed(seed)
        self.draw()
        return super().reset(seed=seed)


@pytest.mark.parametrize(
    ("draw", "seeds", "source"),
    [
        (np.random.normal, False, "np.random"),
        (random.random, False, "random"),
        (np.random.normal, True, None),
        (np.random.default_rng(0).normal, False, None),
    ],
)
def test_numbers_that_the_seed_does_not_repeat_are_a_note_of_the_run(draw, seeds, source):
    env = External(make=Drawn, kwargs={"draw": draw, "seeds": seeds})
    line = f"Drawn: draws from {source}, which seed= does not seed; use self.np_random"
    assert env.known.notes == (() if source is None else (line,))


def test_a_small_image_is_a_note_of_the_run():
    (note,) = External(make=Odd, kwargs={"obs": Box(0, 255, (20, 20, 3), np.uint8)}).known.notes
    assert note.startswith("Odd: an observation has 1,200 numbers; those of an image")


def test_an_environment_without_a_time_step_is_shown_where_to_write_it():
    with pytest.raises(UsageError, match=r"add env.dt=0.05, .* or metadata = .* to its class"):
        External(make=type("Timeless", (Count,), {"metadata": {}}))
    with pytest.raises(UsageError, match=r"Fast: does not say its time step; add env.dt=0.05"):
        External(make=type("Fast", (Count,), {"metadata": {"render_fps": "fast"}}))
    with pytest.raises(FieldError, match=r"dt=0: must be above 0"):
        External(make=Count, dt=0)


def test_an_id_without_a_version_has_the_time_limit_of_the_newest():
    with pytest.warns(UserWarning, match="latest versioned"):
        assert External(id="Pendulum").known.steps == 200


def test_a_video_of_an_environment_that_takes_no_render_mode_says_what_it_needs():
    copies = counting().copies([1], STEPS, render_mode="rgb_array")
    with pytest.raises(WorldError, match="Count: for a video, give it `def __init__"):
        copies.reset()


@pytest.mark.parametrize(
    ("render", "line"),
    [
        (gymnasium.Env.render, "Wrong: for a video, give it `def __init__"),
        (lambda self: None, "Wrong: render: returns NoneType; for a video, give it `def __init__"),
    ],
)
def test_a_video_of_an_environment_without_a_picture_says_what_it_needs(render, line):
    kind = type("Wrong", (Count,), {"render": render})
    copies = External(make=kind).copies([1], STEPS)
    copies.reset()
    with pytest.raises(WorldError) as error:
        copies.picture()
    assert str(error.value).startswith(line)


def test_planning_on_the_environment_itself_is_refused():
    env = counting()
    with pytest.raises(UsageError, match="steps on the host"):
        env.step(env.reset(jax.random.key(0)), jnp.zeros(1))
