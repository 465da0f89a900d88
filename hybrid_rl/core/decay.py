"""Decay of exploration along a run."""

from jax import Array


def of_run(rate: float, decisions: Array | None) -> Array | float:
    """rate^k [] after k `decisions` [] of the run; 0 after training, where they are not counted."""
    if rate == 1:
        return 1.0
    return 0.0 if decisions is None else rate**decisions
