"""Imitation of a teacher that is asked: what clones learn from chosen queries.

    python -m hybrid_rl.figures study=imitation runs="runs/lander/*/*" out=fig_4_2.png

view=queries    figure 4-2: runs of experiment=thesis/fig_4_2, one per method. Score of the clone
                over its teacher's against demonstrations, IQM and 95% band over seeds, as trained
                (one Adam step a decision) and after `refit` steps on the labels of the first N
                demonstrations, N of `at`; the first N with 90%. runs=A.json,B.json joins files
view=backflips  figure 6-9: runs of experiment=thesis/fig_6_9. Flights of the clones that succeed,
                and that turn at some time, after 3,000 and 15,000 more steps on their labels;
                safety of the exploration
view=information  figure 6-10: information of the queries of these runs, under the clone that asked
                and under one reference clone
"""

from typing import Annotated, Any

from hybrid_rl.cli.arguments import one_of, whole
from hybrid_rl.errors import UsageError
from hybrid_rl.thesis.studies import backflip_picture, queries_picture
from hybrid_rl.thesis.studies.numbers import rounded

DRAWN = {
    "queries": queries_picture.picture,
    "backflips": backflip_picture.bars,
    "information": backflip_picture.curves,
}
LINES = {
    "queries": queries_picture.lines,
    "backflips": backflip_picture.lines,
    "information": backflip_picture.query_lines,
}


def figure(
    runs: Annotated[str, "run folders, a pattern in quotes; or JSON files, to join"],
    view: Annotated[str, ", ".join(LINES), one_of(*LINES)] = "queries",
    refit: Annotated[int, "of view=queries: Adam steps of a refit; 0: none", whole(0)] = 15_000,
    at: Annotated[str, "of view=queries: demonstrations of a refit"] = "1,2,4,8,12",
) -> tuple[Any, dict[str, Any]]:
    """The picture and the numbers of one view."""
    views = {
        "queries": lambda: queries_picture.drawn(runs, refit, _counts(at)),
        "backflips": lambda: backflip_picture.flips(runs),
        "information": lambda: backflip_picture.queries(runs),
    }
    figure, numbers = views[view]()
    return figure, {"view": view, **rounded(numbers)}


def draw(numbers: dict[str, Any]) -> Any:
    """The picture of numbers from a JSON."""
    return DRAWN[numbers["view"]](numbers)


def _counts(at: str) -> list[int]:
    """The numbers in `at`, with commas between them."""
    if not all(part.strip().isdigit() for part in at.split(",")):
        raise UsageError(f"at={at}: must be whole numbers with commas between them")
    return [int(part) for part in at.split(",")]


def summary(numbers: dict[str, Any]) -> list[str]:
    """The lines of one view."""
    return LINES[numbers["view"]](numbers)
