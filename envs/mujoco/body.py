"""A robot of MuJoCo whose body can be changed: heavier, loaded, on ice, with weak motors.

    m_i, I_i  <-  mass m_i, mass I_i          every body
    m_1       <-  m_1 + payload               at the root's centre of mass, after the factor `mass`
    mu        <-  friction mu                 sliding friction of every geom and contact pair
    tau_j     <-  motors_j tau_j              at the same action

Armature, damping and stiffness of the joints stay. By default nothing changes, and the model is the
same one; other values are part of its name (`mjcf`), so they hold in MuJoCo C, MJX and Warp.
"""

from abc import ABC
from dataclasses import KW_ONLY
from typing import ClassVar

from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.physics import Physics, Simulator
from hybrid_rl.fields import FieldError, NotNegative, Positive, part
from hybrid_rl.types import EnvState, Spec


@part
class Body(ABC):
    """What such robots share; `physics` is native, mjx, warp or auto."""

    physics: Simulator = "auto"
    _: KW_ONLY
    mass: Positive = 1.0  # factor on the mass and the inertia of every body
    friction: Positive = 1.0  # factor on every coefficient of sliding friction
    motors: tuple[Positive, ...] | Positive = 1.0  # factor on their strength: of all, or [m]
    payload: NotNegative = 0.0  # [kg] at the centre of mass of the root
    spec: ClassVar[Spec]  # observation size, action size and decision interval
    _asset: ClassVar[str]  # the model, whose first m actuators are the motors, for `_body`

    def __post_init__(self) -> None:
        size = self.spec.act
        if len(self._motors) != size:
            raise FieldError(self, "motors", f"must be 1 or {size} numbers, each above 0")

    def pose(self, state: EnvState) -> Array:
        """Joint positions qpos [nq] for rendering."""
        return state.data.qpos

    @property
    def _body(self) -> Physics:
        return self._physics(self._asset)

    @property
    def _motors(self) -> tuple[float, ...]:
        """The factor of each motor [m]."""
        one = not isinstance(self.motors, tuple)
        return (self.motors,) * self.spec.act if one else self.motors

    def _physics(self, asset: str, reads: tuple[str, ...] = ()) -> Physics:
        """The physics of `asset`, with the changes."""
        factors = {"mass": self.mass, "friction": self.friction}
        factors |= {f"motor.{i}": factor for i, factor in enumerate(self._motors)}
        values = {key: factor for key, factor in factors.items() if factor != 1}
        if self.payload:
            values["payload"] = self.payload
        return Physics(mjcf.changed(asset, values), self.physics, reads=reads)
