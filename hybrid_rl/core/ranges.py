"""Checks of the fields of a part, whose messages name the key in its configuration."""

from typing import Any


def above_zero(part: Any, section: str, *names: str) -> None:
    """Raise ValueError for a field of `part` that is not above 0."""
    for name in names:
        if not getattr(part, name) > 0:
            raise ValueError(f"{section}.{name}={getattr(part, name)}: must be above 0")


def discount_and_tau(learner: Any) -> None:
    """Raise ValueError unless the discount of a learner is in [0, 1) and its tau in (0, 1]."""
    if not 0 <= learner.discount < 1:
        raise ValueError(f"policy_learner.discount={learner.discount}: must lie in [0, 1)")
    if not 0 < learner.tau <= 1:
        raise ValueError(f"policy_learner.tau={learner.tau}: must lie in (0, 1]")


def edge_and_saturation(learner: Any, section: str) -> None:
    """Raise ValueError for a learner that clips the actions below its policy's saturation."""
    saturation = getattr(learner.policy, "saturation", None)
    if saturation is not None and saturation > learner.edge:
        raise ValueError(
            f"policy.saturation={saturation}: must be at most {section}.edge={learner.edge}, to "
            "which demonstrated actions are clipped"
        )
