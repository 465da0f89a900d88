"""What a goal pays a robot for not having fallen.

Without it, a fall, which ends the episode, would pay where the goal is missed.
"""

from hybrid_rl.protocols import Env

FALLS = 3.0  # a decision, where episodes end by the robot's fall


def bonus(world: Env, given: float | None) -> float:
    """The reward of a decision before the goal's own: `given`, or by whether episodes can end."""
    if given is not None:
        return given
    return 0.0 if getattr(world, "ended", None) is None else FALLS
