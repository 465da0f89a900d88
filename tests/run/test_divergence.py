"""Whether a number that is not finite is the world's or that of learning."""

from types import SimpleNamespace
from unittest.mock import patch

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from hybrid_rl.data.replay import Replay
from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.run import divergence
from hybrid_rl.run.logs import rows
from hybrid_rl.training.agent import Agent
from hybrid_rl.training.axis import Axis
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import Transition

WORLDS, NAN = 2, float("nan")


def decision(reward):
    """A decision of two environments, whose second reward is given."""
    obs = jnp.array([[0.0, 0.0, 0.0], [0.5, 0.25, -1.0]])
    flags, action = jnp.zeros(WORLDS, bool), jnp.array([[0.0], [0.75]])
    return Transition(obs, action, jnp.array([1.0, reward]), flags, flags, obs)


def diverged(capacity, rewards, reward=None):
    """The learners of a program, and their state after these decisions of one learner."""
    replay = Replay(capacity)
    episode = Episode(Pendulum(), reward=reward)
    with patch("hybrid_rl.training.contract.check_members"):  # of what neither acts nor learns
        agent = Agent(episode, SimpleNamespace(act=None), {}, replay, WORLDS)
    memory = replay.init(agent.spec, WORLDS)
    for reward in rewards:
        memory = replay.add(memory, decision(reward))
    memory = jax.tree.map(lambda leaf: leaf[None], memory)
    state = SimpleNamespace(memory=memory)
    return divergence.Diverged(SimpleNamespace(agent=agent, seeds=(3,), axis=Axis()), None), state


def metrics(**infinite):
    """Metrics of five rounds of one learner; NAME=ROUND is infinite from there on."""
    made = {name: np.zeros((5, 1)) for name in ("sac/q", "world/action", "world/reward")}
    for name, at in infinite.items():
        made[name.replace("_", "/")][at:] = np.inf
    return made


def test_a_reward_that_is_not_finite_is_the_worlds_and_its_decision_is_shown():
    learners, state = diverged(100, [-1, -2, NAN, -4, -5])
    failures = rows.infinite(metrics(sac_q=2, world_reward=2), 0, WORLDS)
    assert failures == {0: (6, "world/reward")}
    ends = [*learners.add(failures, state, 10).values()]
    assert divergence.line(ends, 0, None) == (
        "seed 3, step 6: world/reward is not finite, a fault of the world: "
        "hybrid_rl.envs.analytic.pendulum.Pendulum at obs [ 0.5 , 0.25, -1. ], action [0.75] gives "
        "reward nan, obs [ 0.5 , 0.25, -1. ]; there is no checkpoint"
    )
    assert "; checkpoint 4 is intact: fix what fails and resume it" in divergence.line(ends, 0, 4)


def test_a_reward_of_the_users_is_named_and_not_the_world():
    paid = SimpleNamespace(reward_of=lambda x, u, after: x[0])
    learners, state = diverged(100, [NAN], paid)
    (end,) = learners.add({0: (2, "world/reward")}, state, 2).values()
    assert end["world"].startswith("a fault of the world: types.SimpleNamespace at obs [ 0.5 ")


def test_a_decision_that_the_memory_forgot_is_not_shown():
    learners, state = diverged(4, [NAN, -2, -3, -4, -5])
    end = learners.add({0: (2, "world/reward")}, state, 10)[0]
    assert end["world"] == "a fault of the world hybrid_rl.envs.analytic.pendulum.Pendulum"


@pytest.mark.parametrize(
    "bad", [{"sac_q": 1, "world_reward": 2}, {"world_action": 2, "world_reward": 2}]
)
def test_what_was_learned_is_to_blame_where_it_failed_first_or_acted(bad):
    learners, state = diverged(100, [-1] * 5)
    ends = [*learners.add(rows.infinite(metrics(**bad), 0, WORLDS), state, 10).values()]
    assert divergence.line(ends, 0, None) == (
        f"seed 3, step {ends[0]['step']}: {ends[0]['quantity']} is not finite; there is no "
        "checkpoint"
    )
    assert ends[0]["quantity"] in ("sac/q", "world/action")
