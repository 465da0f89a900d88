"""Learning rates that fall to zero along the last decisions of a run.

    rate_k = rate min(1, (N - k) / (share N))        after k of N decisions

Until then nothing changes, so a run without it is the same up to there. Linear decay at the end of
training is the cooldown of Hagele et al. 2024.
"""

import jax.numpy as jnp
from jax import Array

from hybrid_rl.fields import Count, Share, part


@part
class LinearDecay:
    """Falls from 1 to 0 in a line over the last `share` of `decisions`."""

    decisions: Count | None = None  # N, of the whole run
    share: Share = 0.3

    def factor(self, decisions: Array) -> Array:
        """The factor [] of learning rates, so many decisions [] into the run."""
        whole = self.decisions
        assert whole is not None  # a run sets it
        left = (whole - decisions) / (self.share * whole)
        return jnp.clip(left, 0.0, 1.0)
