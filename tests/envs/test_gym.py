"""The ids under which Gymnasium finds the environments, and their time limits."""

import gymnasium
import numpy as np
import pytest
from test_gymnasium import play
from worlds import OWN_TEST, TASKS

from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv, GymnasiumVectorEnv
from hybrid_rl.envs.analytic.two_link import TwoLink

ID = "hybrid_rl/"


def test_every_task_has_an_id_and_its_time_limit():
    """A decision of the cartpole's task is two of its environment's."""
    targets = [spec.kwargs["world"] for name, spec in gymnasium.registry.items() if ID in name]
    assert len(targets) == len(set(targets)) == len({*TASKS, *OWN_TEST})
    assert gymnasium.spec("hybrid_rl/Walker2d").max_episode_steps == 1000
    assert gymnasium.spec("hybrid_rl/Cartpole").max_episode_steps == 2 * 500
    assert GymnasiumEnv(TwoLink()).steps == GymnasiumVectorEnv(TwoLink(), 2).steps == 200

    class Mine(TwoLink):
        pass

    with pytest.raises(ValueError, match="steps: Mine has no time limit of its own; give steps=N"):
        GymnasiumEnv(Mine())


def test_an_id_takes_the_fields_of_its_environment():
    long = {"success_distance": 1.0, "max_episode_steps": 4}
    env = gymnasium.make("hybrid_rl.envs.gym:hybrid_rl/TwoLink", **long)
    env.reset(seed=0)
    ends = [env.step(np.zeros(2, np.float32))[3] for _ in range(4)]
    assert (env.unwrapped.env.success_distance, ends) == (1.0, [False, False, False, True])
    envs = gymnasium.make_vec("hybrid_rl/TwoLink", num_envs=2, **long)
    ended = [truncated.all() for _, _, _, truncated, _ in play(envs, 0, 4)]
    assert (envs.env.success_distance, ended) == (1.0, [False, False, False, True])
