"""Decay along a run: of exploration and of learning rates."""

from jax import Array

from hybrid_rl.protocols import Schedule


def of_run(rate: float, decisions: Array | None) -> Array | float:
    """rate^k [] after k `decisions` [] of the run.

    Where they are not counted, after training, it is 0; or 1 if the rate is 1.
    """
    if rate == 1:
        return 1.0
    return 0.0 if decisions is None else rate**decisions


def of_rates(schedule: Schedule | None, decisions: Array | None) -> Array | float:
    """The factor [] of learning rates after so many `decisions` []; 1 without a schedule.

    It is 1, too, where decisions are not counted: before the run and after it.
    """
    return 1.0 if schedule is None or decisions is None else schedule.factor(decisions)
