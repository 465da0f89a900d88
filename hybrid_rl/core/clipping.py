"""The bound to which demonstrated actions are clipped, against the policy that imitates them."""

from typing import Any


def check_saturation(learner: Any, section: str) -> None:
    """Raise ValueError for a learner that clips below its policy's saturation; section: its key."""
    saturation = getattr(learner.policy, "saturation", None)
    if saturation is not None and saturation > learner.edge:
        raise ValueError(
            f"policy.saturation={saturation}: must be at most {section}.edge={learner.edge}, to "
            "which demonstrated actions are clipped"
        )
