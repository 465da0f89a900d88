"""Pictures and lines of clones that choose their queries (hybrid_rl.thesis.studies.queries)."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from hybrid_rl.analysis.style import blank, legend_outside, line_styles, words
from hybrid_rl.errors import UsageError
from hybrid_rl.files.reading import json_file
from hybrid_rl.run.logs.records import arrays
from hybrid_rl.thesis.studies import queries

SAME = ("task", "score", "decisions_of_a_demonstration")


def drawn(runs: str, refit: int, at: Sequence[int]) -> tuple[Any, dict[str, Any]]:
    """The picture and the numbers of runs, or of JSON files with commas between them."""
    files = runs.split(",")
    if all(file.endswith(".json") for file in files):
        made = merged([Path(file.strip()) for file in files])
    else:
        made = queries.queries(runs, refit, at)
    return picture(made), made


def merged(files: Sequence[Path]) -> dict[str, Any]:
    """The methods of several files of view=queries, with the teacher's score of the first one.

    Raises:
        UsageError: for files that are missing, of other tasks, or with the same method.
    """
    made: dict[str, Any] = {}
    for file in files:
        try:
            one = json_file(file)
        except UsageError as error:
            raise UsageError(f"runs={error}") from error
        if one.get("view") != "queries":
            raise UsageError(f"runs={file}: needs a JSON of study=imitation view=queries")
        made = made or {**one, "methods": {}}
        for key in SAME:
            if one[key] != made[key]:
                raise UsageError(f"runs={file}: {key} is {one[key]}, in {files[0]} {made[key]}")
        if twice := sorted(made["methods"].keys() & one["methods"].keys()):
            raise UsageError(f"runs={file}: {twice[0]} is in another file, too")
        made["methods"] |= one["methods"]
    made["methods"] = {label: arrays(one) for label, one in sorted(made["methods"].items())}
    return {**made, "comparisons": queries.compared(made["methods"])}


def picture(made: dict[str, Any]) -> Any:
    """Shares over demonstrations, a panel for each schedule."""
    methods = made["methods"]
    refits = [one for one in methods.values() if "refit" in one]
    schedules = ["printed", *(["refit"] if refits else [])]
    figure = blank(4.4 * len(schedules), 4.2)
    styles = line_styles(methods)
    panels = figure.subplots(1, len(schedules), sharey=True, squeeze=False)[0]
    alpha = min(0.15, 0.6 / len(methods))
    for axes, schedule in zip(panels, schedules, strict=True):
        for label, one in methods.items():
            line = one if schedule == "printed" else one.get("refit")
            if line is None:
                continue
            style = styles[label]
            axes.plot(line["N"], line["iqm"], label=words(label), ms=4, **style)
            ends = line["low"], line["high"]
            axes.fill_between(line["N"], *ends, color=style["color"], alpha=alpha)
        axes.axhline(1, color="#444444", linewidth=0.8)
        axes.set_xlabel(f"demonstrations of {made['decisions_of_a_demonstration']} decisions")
        steps = f"{made['refit_steps']:,} steps on the same labels"
        axes.set_title("one Adam step a decision" if schedule == "printed" else steps)
    score = {"success": "share of successes", "return": "return"}[made["score"]]
    panels[0].set_ylabel(f"{score} / the teacher's")
    legend_outside(panels[0])
    return figure


def lines(numbers: dict[str, Any]) -> list[str]:
    """A line for each method, then the comparisons with random queries."""
    result = [f"{numbers['task']}: the teacher's {numbers['score']} is {numbers['teacher']:.4g}"]
    for label, one in numbers["methods"].items():
        each = [("printed", one), *([("refit", one["refit"])] if "refit" in one else [])]
        for schedule, line in each:
            shares = ", ".join(
                f"N={n:g} {m:.2f} [{a:.2f}, {b:.2f}]"
                for n, m, a, b in zip(
                    *(line[name] for name in ("N", "iqm", "low", "high")), strict=True
                )
                if n in (1, 2, 4, 8, 12)
            )
            reached = "never" if line["reaches"] is None else f"at {line['reaches']:g}"
            result.append(f"{label}, {schedule}: {shares}; 90% {reached}")
        middle, low, high = one["area"]
        result.append(f"{label}: mean over N {middle:.3f} [{low:.3f}, {high:.3f}]")
    for label, one in numbers["comparisons"].items():
        words = [f"{key} {p:.2f} [{a:.2f}, {b:.2f}]" for key, (p, a, b) in one.items()]
        result.append(f"P({label} > RQ-DAgger): {', '.join(words)}")
    return result
