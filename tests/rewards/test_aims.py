"""Rewards of conf/reward, against the quantities of states that physics has made."""

from typing import Any

import jax
import jax.numpy as jnp
import pytest

from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.hopper import Hopper
from hybrid_rl.envs.sawyer_push import SawyerPush
from hybrid_rl.rewards.aim import Aim
from hybrid_rl.rewards.known import KnownReward
from hybrid_rl.rewards.push import Push
from hybrid_rl.rewards.run import Run
from hybrid_rl.types import Params

CHEETAH = HalfCheetah("native")
ACTION = jnp.linspace(-0.9, 0.9, 6)
STATE = jax.jit(CHEETAH.reset)(jax.random.key(0))
AFTER = jax.jit(CHEETAH.step)(STATE, ACTION)


def paid(goal: Any) -> float:
    """The reward of that decision."""
    return float(goal.reward_of(STATE.obs, ACTION, AFTER.obs))


def test_a_speed_is_held_in_metres_per_second() -> None:
    """The velocity of the root in MuJoCo's state, and 0.05 of the squared actions."""
    speed, effort = float(AFTER.data.qvel[0]), float((ACTION**2).sum())
    assert paid(Aim(CHEETAH, "speed", 2.0)) == pytest.approx(-abs(speed - 2) - 0.05 * effort)
    assert paid(Run(CHEETAH, -1.0, effort=0.5)) == pytest.approx(-speed - 0.5 * effort)


def test_falling_does_not_pay() -> None:
    """A robot whose episodes end by a fall gets 3 for each decision."""
    robot = Hopper("native")
    obs, none = jnp.zeros(robot.spec.obs), jnp.zeros(3)
    assert float(Aim(robot, "speed", 0.0).reward_of(obs, none, obs)) == pytest.approx(3, abs=1e-5)


def test_a_planner_sees_a_smooth_limit() -> None:
    """The indicator of the pitch is a sigmoid, equal far from the limit, with a gradient at it."""
    goal = Run(CHEETAH, level=0.2)
    for pitch in (0.0, 0.5):
        obs = AFTER.obs.at[1].set(pitch)
        at = STATE.obs, ACTION, obs
        assert float(goal.smoothed(*at)) == pytest.approx(float(goal.reward_of(*at)), abs=0.1)
    obs = AFTER.obs.at[1].set(0.2)
    slopes = [
        jax.grad(lambda obs, f=f: f(STATE.obs, ACTION, obs))(obs)[1]
        for f in (goal.smoothed, goal.reward_of)
    ]
    assert float(slopes[0]) < -10
    assert float(slopes[1]) == 0
    known = KnownReward(CHEETAH, goal)
    seen = known.outcome(Params(), STATE.obs, ACTION, obs)[0]
    assert float(seen) == pytest.approx(float(goal.smoothed(STATE.obs, ACTION, obs)))


def test_a_block_is_pushed_to_another_position() -> None:
    """Distances in metres, from the scaled observation."""
    robot = SawyerPush("native")
    obs = jnp.array([0.3, 0.4, 1.0, 0.0])  # rod 5 cm from the block, block 10 cm from the target
    goal = Push(robot, (0.1, 0.0), effort=0.0)
    assert float(goal.reward_of(obs, jnp.zeros(2), obs)) == pytest.approx(-0.8 * 0.05, abs=1e-5)
