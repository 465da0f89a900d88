"""Lander: a planar vehicle with two thrusters that hovers, or turns a backflip.

    x'' = -S sin th,  z'' = S cos th - 1,  th'' = 2 (a1 - a2),  S = a1 + a2
    flip   r = -(10 (th - goal)^2 + 5 z^2 + 10 relu(-z) + x'^2 + z'^2 + th'^2 + 0.1 |u|^2)
    hover  r = -(|o|^2 + 0.001 |a - 1/2|^2),   both after the step

o = (x, z, th, x', z', th') [6]; mass, gravity and distances have no units. a [2]: thrusts, of both
signs, the right one first; a = 1/2 hovers; u = atanh(a), of |a| up to 0.9999. Start: N(0, 0.1 I)
for the flip, at rest at 0 for the hover. A decision is 0.1 s, one Euler step; never terminates.

goal = -2 pi turns: half a turn ends upside down, held by negative thrust; it is 0 for the hover.
Metrics: success = |th - goal| < 0.35 and |z| < 1 throughout the last second; turned = 1 from the
first time on at which |th - goal| < 0.35.

Source: thesis section 6.3.4 and appendix C, 10 Hz, with a = tanh u for its input u: it prints tan
where the text, and its author's code, have the bounded function, and it omits it in th''. The
rewards are its costs. Euler is its author's; the criterion of success is our choice, the thesis
has none.
"""

import math
from typing import Annotated, Literal

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.analytic.state import Euclidean, fully_observed
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.fields import among, part
from hybrid_rl.types import EnvState, Spec

DT = 0.1  # [s] of a decision
VARIANCE = 0.1  # of each entry of the state at the start of a flip
ANGLE, HEIGHT = 0.35, 1.0  # [rad], [length]: bounds of success
HOLD = 10  # decisions within these bounds at a success
LARGEST = 0.9999  # |a| in the cost of u, which is infinite at 1


@part
class Lander(Euclidean):
    """A lander with two thrusters."""

    task: Literal["hover", "flip"] = "flip"
    turns: Annotated[float, among(0.5, 1.0)] = 0.5  # of a flip

    spec = Spec(obs=6, act=2, dt=DT)

    @property
    def goal(self) -> float:
        """The angle [rad] at which the task ends."""
        return -2 * math.pi * self.turns if self.task == "flip" else 0.0

    def initial(self, key: Array) -> Array:
        """The first observation [6]: at rest for a hover, else random."""
        x = math.sqrt(VARIANCE) * jax.random.normal(key, (6,), jnp.float32)
        return x if self.task == "flip" else jnp.zeros(6, jnp.float32)

    def _state(self, x: Array, reward: Array, info: dict[str, Array]) -> EnvState:
        """At x [6], after the decisions that `info` counts."""
        at_goal = jnp.abs(x[2] - self.goal) < ANGLE
        level = at_goal & (jnp.abs(x[1]) < HEIGHT)
        info = {"held": jnp.zeros((), jnp.int32), "turned": jnp.zeros((), jnp.int32)} | info
        held = jnp.where(level, info["held"] + 1, 0)
        turned = info["turned"] | at_goal
        success = (held >= HOLD).astype(jnp.float32)
        return fully_observed(x, reward).replace(
            metrics={"success": success, "turned": turned.astype(jnp.float32)},
            info={**info, "held": held, "turned": turned},
        )

    def reward_of(self, x: Array, u: Array, after: Array) -> Array:
        """The reward [] of action u [2] at x [6], which led to `after` [6]."""
        if self.task == "hover":
            return -(jnp.sum(after**2) + 0.001 * jnp.sum((u - 0.5) ** 2))
        z, th = after[1], after[2]
        height = 5 * z**2 + 10 * jax.nn.relu(-z)
        inputs = jnp.arctanh(jnp.clip(u, -LARGEST, LARGEST))
        still = jnp.sum(after[3:] ** 2) + 0.1 * jnp.sum(inputs**2)
        return -(10 * (th - self.goal) ** 2 + height + still)

    def dynamics(self, x: Array, u: Array) -> Array:
        """The next observation [6] after action u [2] at x [6]."""
        thrust, sin, cos = u[0] + u[1], jnp.sin(x[2]), jnp.cos(x[2])
        rate = jnp.stack([-thrust * sin, thrust * cos - 1, 2 * (u[0] - u[1])])
        return x + DT * jnp.concatenate([x[3:], rate])

    def equilibrium(self) -> tuple[Array, Array]:
        """Upright at rest, on half the thrust."""
        return jnp.zeros(6), jnp.full(2, 0.5)

    scene = mjcf.scene("lander.xml")

    def pose(self, state: EnvState) -> Array:
        """Position and angle, qpos [3], for rendering."""
        return state.data[:3]
