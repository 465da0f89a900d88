"""A pendulum with one fault, on purpose: what the doctor of runs is tried on.

u' = u + (a - u) / lag          a motor that answers late; u acts, a is what the policy asks for
o  = clip(o, -limit, limit)[kept]
r  = paid r;  NaN where |w| > nan_above
terminated after `ends` decisions, as a wrapper does that confuses it with `truncated`
"""

from dataclasses import dataclass, replace

import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.pendulum import Pendulum
from hybrid_rl.types import EnvState, Spec

FAR = 1e9  # a limit that is never reached
UP = 0.9  # height from which the pendulum counts as upright
MOTOR, CLOCK = "motor", "clock"  # in `info`


@dataclass(frozen=True)
class Broken:
    """The pendulum, sound with the values here."""

    limit: float = FAR  # of each entry of the observation
    kept: tuple[int, ...] = (0, 1, 2)  # entries of the observation that the learner sees
    paid: float = 1.0  # factor on the reward
    lag: float = 1.0  # [decisions] time constant of the motor
    ends: int = 0  # decisions until it terminates; 0: never
    nan_above: float = FAR  # [rad/s] speed above which the reward is NaN
    measured: bool = False  # whether the metrics have `success`, upright or not

    @property
    def spec(self) -> Spec:
        """The sizes of what the learner sees."""
        return Pendulum().spec._replace(obs=len(self.kept))

    def reset(self, key: Array) -> EnvState:
        """The first state of an episode. The key is consumed."""
        return self._seen(Pendulum().reset(key), jnp.zeros(1), jnp.zeros((), jnp.int32))

    def step(self, state: EnvState, action: Array) -> EnvState:
        """The state after one decision with action [1]."""
        motor = state.info[MOTOR]
        motor = motor + (jnp.clip(action, -1.0, 1.0) - motor) / self.lag
        return self._seen(Pendulum().step(state, motor), motor, state.info[CLOCK] + 1)

    def _seen(self, now: EnvState, motor: Array, clock: Array) -> EnvState:
        """`now`, a state of the sound pendulum, as the learner is shown it."""
        obs = jnp.clip(now.obs, -self.limit, self.limit)[jnp.array(self.kept)]
        reward = jnp.where(abs(now.obs[2]) > self.nan_above, jnp.nan, self.paid * now.reward)
        upright = {"success": (now.obs[0] > UP).astype(jnp.float32)} if self.measured else {}
        ended = (clock >= self.ends) if self.ends else jnp.zeros((), bool)
        info = {**now.info, MOTOR: motor, CLOCK: clock}
        return replace(now, obs=obs, reward=reward, terminated=ended, metrics=upright, info=info)
