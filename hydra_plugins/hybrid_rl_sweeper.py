"""The sweepers of hybrid_rl, in the only package where Hydra searches for plugins.

Every Hydra program on the machine imports this module, so the rest is imported when it is used.
"""

from typing import Any

from hydra.plugins.sweeper import Sweeper


class CheckedSweeper(Sweeper):
    """`hybrid_rl.cli.sweep.Sweeper`."""

    def __init__(self, max_batch_size: int | None = None, params: Any = None) -> None:
        self.given = (max_batch_size, params)

    def setup(self, **given: Any) -> None:
        """Hydra's: what to run, and by which launcher."""
        from hybrid_rl.cli import sweep

        self.sweeper = sweep.Sweeper(*self.given)
        self.sweeper.setup(**given)

    def sweep(self, arguments: list[str]) -> Any:
        """Run all jobs."""
        return self.sweeper.sweep(arguments)


class TunedSweeper(CheckedSweeper):
    """`hybrid_rl.cli.tuned.Tuner`, with the picture of `hybrid_rl.analysis.tuning`."""

    def __init__(self, params: Any = None, **settings: Any) -> None:
        self.given = (settings, params)

    def setup(self, **given: Any) -> None:
        """Hydra's: what to run, and by which launcher."""
        from hybrid_rl import figures
        from hybrid_rl.analysis import tuning
        from hybrid_rl.cli import tuned

        def drawn(numbers: dict[str, Any], out: Any) -> None:
            figures.save(tuning.draw(numbers), numbers, out)

        self.sweeper = tuned.Tuner(*self.given, drawn)
        self.sweeper.setup(**given)
