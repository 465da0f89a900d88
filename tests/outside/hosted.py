"""A Gymnasium environment whose observations count, and which can fail."""

from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium.spaces import Box

from hybrid_rl.envs.adapters.external import External


class Count(gymnasium.Env):
    """Shows the number of the episode and of the step; each ends after its own number of steps."""

    observation_space = Box(-np.inf, np.inf, (2,))
    action_space = Box(-2, 4, (1,))
    metadata: ClassVar = {"render_fps": 10}

    def __init__(self, fail: str = "") -> None:
        self.fail, self.episode, self.last = fail, 0, np.zeros(1)
        self.buffer = np.zeros(2)

    def reset(self, seed: int | None = None, options: dict | None = None) -> tuple:
        super().reset(seed=seed)
        self.episode, self.time = self.episode + 1, 0
        return self._seen(), {}

    def step(self, action: np.ndarray) -> tuple:
        self.time, self.last = self.time + 1, action
        fail = self.fail if self.time == 2 else ""
        if fail == "error":
            raise ValueError("motor off")
        obs = self._seen()
        if fail == "nan":
            obs[1] = np.nan
        obs = np.zeros(3) if fail == "size" else obs
        reward = np.inf if fail == "reward" else float(action[0])
        return obs, reward, self.time >= self.episode + 1, self.fail == "both", {}

    def _seen(self) -> np.ndarray:
        """A buffer that the next step overwrites."""
        self.buffer[:] = self.episode, self.time
        return self.buffer


def counting(**kwargs: Any) -> External:
    return External(make=Count, kwargs=kwargs)
