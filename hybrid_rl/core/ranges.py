"""A check of two parts together, whose message names their keys in the configuration."""

from typing import Any


def edge_and_saturation(learner: Any, section: str) -> None:
    """Raise ValueError for a learner that clips the actions below its policy's saturation."""
    saturation = getattr(learner.policy, "saturation", None)
    if saturation is not None and saturation > learner.edge:
        raise ValueError(
            f"policy.saturation={saturation}: must be at most {section}.edge={learner.edge}, to "
            "which demonstrated actions are clipped"
        )
