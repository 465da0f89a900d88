"""The sweeper of hybrid_rl, in the only package where Hydra searches for plugins.

Every Hydra program on the machine imports this module, so the rest is imported when it is used.
"""

from typing import Any

from hydra.plugins.sweeper import Sweeper


class CheckedSweeper(Sweeper):
    """`hybrid_rl.cli.sweep.Sweeper`."""

    def __init__(self, params: Any = None) -> None:
        self.params = params

    def setup(self, **given: Any) -> None:
        """Hydra's: what to run, and by which launcher."""
        from hybrid_rl.cli import sweep

        self.sweeper = sweep.Sweeper(self.params, **given)

    def sweep(self, arguments: list[str]) -> Any:
        """Run all jobs."""
        return self.sweeper.sweep(arguments)
