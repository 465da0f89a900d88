"""Another body in each episode, of an environment in MuJoCo (domain randomisation).

    m_i, I_i  <-  mass m_i, mass I_i          every body
    m_1       <-  m_1 + payload               at the root's centre of mass, after the factor `mass`
    mu        <-  friction mu                 sliding friction of every geom and contact pair
    d         <-  damping d                   of every joint
    tau_j     <-  motors_j tau_j              at the same action; each motor has its own factor

Each number is uniform in its range, drawn at the reset, on top of what `Body` has changed.

Source: Peng et al. 2018, "Sim-to-real transfer of robotic control with dynamics randomization".
"""

from dataclasses import fields

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.physics import PhysicsState
from hybrid_rl.fields import FieldError, NotNegative, Positive, part


@part
class Ranges:
    """[low, high] of each number; None: as it is in the model."""

    mass: tuple[Positive, ...] | None = None
    friction: tuple[Positive, ...] | None = None
    damping: tuple[NotNegative, ...] | None = None
    motors: tuple[Positive, ...] | None = None
    payload: tuple[NotNegative, ...] | None = None  # [kg]

    def __post_init__(self) -> None:
        for name in (field.name for field in fields(self)):
            pair = getattr(self, name)
            right = isinstance(pair, tuple) and len(pair) == 2 and pair[0] <= pair[1]
            if pair is not None and not right:
                raise FieldError(self, name, "must be [low, high], or null")

    def draw(self, state: PhysicsState, motors: int, key: Array) -> PhysicsState:
        """`state` with another body, whose first actuators are the `motors`. Consumes the key."""
        model, own = mjcf.load(state.asset), dict(state.fields)
        keys = jax.random.split(key, len(fields(self)))

        def now(name: str) -> Array:
            return own.get(name, jnp.asarray(getattr(model, name), jnp.float32))

        def draw(i: int, pair: tuple[float, ...], shape: tuple[int, ...] = ()) -> Array:
            return jax.random.uniform(keys[i], shape, jnp.float32, *pair)

        if self.mass is not None:
            factor = draw(0, self.mass)
            own |= {name: factor * now(name) for name in ("body_mass", "body_inertia")}
        if self.friction is not None:
            factor = draw(1, self.friction)
            own["geom_friction"] = now("geom_friction").at[:, 0].multiply(factor)
            if model.npair:
                own["pair_friction"] = now("pair_friction").at[:, :2].multiply(factor)
        if self.damping is not None:
            own["dof_damping"] = draw(2, self.damping) * now("dof_damping")
        if self.motors is not None:
            factor = draw(3, self.motors, (min(motors, model.nu), 1))
            for name in ("actuator_gainprm", "actuator_biasprm"):
                own[name] = now(name).at[: len(factor)].multiply(factor)
        if self.payload is not None:
            own["body_mass"] = now("body_mass").at[1].add(draw(4, self.payload))
        return state.replace(fields=own)
