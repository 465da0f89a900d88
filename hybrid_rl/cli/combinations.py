"""The jobs of a sweep: every combination of the listed values."""

from collections.abc import Sequence

from hydra._internal.core_plugins.basic_sweeper import BasicSweeper
from hydra.core.override_parser.types import Override

from hybrid_rl.errors import UsageError


def jobs_of(parsed: Sequence[Override]) -> list[list[str]]:
    """The overrides of each job: every combination of the values."""
    for each in parsed:
        if each.is_interval_sweep():
            raise UsageError(f"{each.input_line}: a range needs hydra/sweeper=tuned; list values")
        if each.is_sweep_override():
            listed(each)
    return BasicSweeper.split_arguments([*parsed], None)[0]


def labels(jobs: Sequence[Sequence[str]]) -> dict[int, str]:
    """The overrides of each job that not all jobs share."""
    common = set.intersection(*map(set, jobs))
    own = ([text for text in overrides if text not in common] for overrides in jobs)
    return {number: " ".join(texts) for number, texts in enumerate(own)}


def listed(override: Override) -> list[str]:
    """The values of an override that lists several, as they are typed, each one time."""
    if not (values := [*dict.fromkeys(override.sweep_string_iterator())]):
        raise UsageError(f"{override.input_line}: has no values")
    return values
