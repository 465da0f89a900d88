"""When each learner learns: before the first decision, during random decisions, after them."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax import Array
from tiny import TINY, demonstrate

from hybrid_rl.settings import build as config
from hybrid_rl.training.agent import Agent
from hybrid_rl.types import Params

pytestmark = pytest.mark.turns(3)

KEY = jax.random.key(3)


@pytest.fixture(scope="module")
def agent(tmp_path_factory) -> Agent:
    """Hybrid learning from demonstrations on the pendulum, pretrained for 3 steps."""
    line = [*TINY, "algo=hybrid_bc", "pretrain=3", "cloning_learner.batch_size=16"]
    line += ["cloning_learner.updates=1", "random_steps=0"]
    folder = tmp_path_factory.mktemp("demonstrations")
    return config.build(config.load([*line, demonstrate(folder, config.load(line))])).agent


def with_reward(agent: Agent, reward: Array | float):
    """The same agent in an environment whose rewards are `reward`."""
    world = agent.episode.env

    class Paid(type(world)):
        def step(self, state, action):
            return super().step(state, action).replace(reward=jnp.float32(reward))

    env = Paid(**vars(world))
    return replace(agent, episode=replace(agent.episode, env=env))


def history(agent: Agent, decisions: int):
    """The parameters before the first decision and after each one [decisions + 1, ...]."""

    def run(key):
        def one(state, t):
            state = agent.step(state, t)[0]
            return state, agent.params(state)

        first = agent.init(key)
        rest = jax.lax.scan(one, first, jnp.arange(decisions))[1]
        return jax.tree.map(lambda a, b: jnp.append(a[None], b, 0), agent.params(first), rest)

    return jax.jit(run)(KEY)


def at(params: Params, decision: int) -> Params:
    """The parameters after a number of decisions."""
    return jax.tree.map(lambda each: each[decision], params)


def same(a, b) -> bool:
    """Whether all numbers are equal."""
    return all(map(np.array_equal, jax.tree.leaves(a), jax.tree.leaves(b)))


def test_experience_changes_the_models_and_not_the_policy(agent):
    """With different rewards the policies are equal and the reward models are not; all learn."""
    learned = jax.jit(lambda reward: history(with_reward(agent, reward), 6))
    params, others = learned(1.0), learned(-1.0)
    first, one, other = at(params, 0), at(params, -1), at(others, -1)
    assert same(one.policy, other.policy)
    assert not same(one.reward, other.reward)
    assert not same(first.policy, one.policy)
    assert not same(first.model, one.model)


def test_pretraining_is_gradient_steps_on_demonstrations(agent):
    """The policy is that of a plain loop over the learner's updates."""
    learners = {"cloning": agent.learners["cloning"]}
    alone = replace(agent, learners=learners, pretrain=3)
    ahead, still = (
        jax.jit(a.init)(KEY).learners["cloning"] for a in (alone, replace(alone, pretrain=0))
    )
    count = ahead.optimiser[0].count
    assert (int(count), int(still.optimiser[0].count)) == (3, 0)
    state, cloning = still, learners["cloning"]
    update = jax.jit(lambda state, key: cloning.update(state, Params(), None, key)[0])
    for key in jax.random.split(jax.random.split(KEY, 4)[3], 3):
        ((_, updating),) = jax.random.split(key, (1, 2))
        state = update(state, updating)
    jax.tree.map(lambda a, b: np.testing.assert_allclose(a, b, atol=1e-6), ahead, state)


def test_no_key_of_pretraining_is_reused(agent, monkeypatch):
    """Its keys differ from those of the initial state and of the first decision."""
    received = []
    monkeypatch.setattr(Agent, "_pretrained", lambda _, state, key: received.append(key) or state)
    state = agent.init(KEY)
    first = jax.random.split(KEY, 2 + len(agent.learners))
    decision = jax.random.split(state.key, 3 + 2 * agent.num_envs)
    steps = jax.random.split(received[0], agent.pretrain)
    keys = jnp.concatenate([received[0][None], steps, first, decision])
    assert len(np.unique(jax.random.key_data(keys), axis=0)) == len(keys)


def test_pretraining_needs_demonstrations(agent):
    bare = replace(agent.replay, demonstrations=None)
    with pytest.raises(ValueError, match="pretrain=3: the memory has no demonstrations"):
        replace(agent, replay=bare)


def test_the_model_learns_from_random_decisions_and_the_policy_after_them() -> None:
    """Imagined data come from a trained model, unless the policy learns at random, too."""
    line = [
        *TINY,
        "algo=hybrid_stochastic",
        "random_steps=24",
        "policy_learner.during_random=false",
    ]
    early = config.build(config.load(line)).agent
    learned = history(early, 25)
    first, during, later = (at(learned, decision) for decision in (0, 24, 25))
    assert not same(first.model, during.model)
    assert same(first.policy, during.policy)
    assert not same(first.policy, later.policy)
