"""Pictures of landers that asked for backflips: figures 6-9 and 6-10.

IQM with its 95% bootstrap band over seeds (studies/curves), and a dot for each seed.
"""

from typing import Any

import numpy as np

from hybrid_rl.analysis.curves import improvement
from hybrid_rl.analysis.style import STROKES, blank, line_styles, plain_log, words
from hybrid_rl.thesis.studies import backflips
from hybrid_rl.thesis.studies.backflips import (
    Explored,
    by_reference,
    explored,
    lost,
    safety,
    teacher,
    trained,
)
from hybrid_rl.thesis.studies.numbers import band_of

HATCHES = ("", "//", "..", "xx", "--", "oo")  # of bars, in the order of STROKES
CRITERIA = {
    "success": "Upside down for a second, height kept",
    "turned": "Upside down at some time",
}


def flips(pattern: str) -> tuple[Any, dict[str, Any]]:
    """Figure 6-9: shares of flights of the clones over the number of queries, and safety."""
    each = explored(pattern)
    results = {one[:2]: trained(one) for one in each}
    rows: dict[str, Any] = {}
    for one in each:
        success, turned = (
            dict(zip(backflips.LENGTHS, part, strict=True)) for part in results[one[:2]]
        )
        rows.setdefault(one.label, {})[str(one.most)] = {
            "asked": one.asked,
            "decisions_until_the_last": np.nanmax(one.decision, axis=1),
            "success": {str(length): _spread(shares) for length, shares in success.items()},
            "turned": {str(length): _spread(shares) for length, shares in turned.items()},
            "safety": _safety(one),
        }
    numbers = {
        "flights_a_clone": backflips.STARTS,
        "teacher": teacher(),
        "lost_from_V": lost(),
        "rows": rows,
        "comparisons": _compared({key: result[0][-1] for key, result in results.items()}),
    }
    return bars(numbers), numbers


def _spread(values: np.ndarray) -> dict[str, Any]:
    """Mean, IQM and its band of [S], and each."""
    return {"mean": values.mean(), **band_of(values), "each": values}


def _safety(one: Explored) -> dict[str, Any]:
    """Of the exploration: V, shares of decisions, deviations."""
    V, beyond, high, std = safety(one.visited)
    return {
        "greatest_V_median": np.median(V),
        "greatest_V": V.max(),
        "beyond_90_degrees": beyond.mean(),
        "higher_or_lower_than_1": high.mean(),
        "std": std,
    }


def _compared(results: dict[tuple[str, int], np.ndarray]) -> dict[str, Any]:
    """P(X > Y) and its band, for all pairs of rows at equal numbers of queries."""
    pairs: dict[str, Any] = {}
    for (label, most), shares in results.items():
        for (other, count), others in results.items():
            if count == most and label < other:
                name = f"{label} > {other}, {most}"
                pairs[name] = improvement(shares, others)
    return pairs


def bars(numbers: dict[str, Any]) -> Any:
    """Figure 6-9: a panel for each criterion and training length."""
    figure, rows = blank(9, 7.6), numbers["rows"]
    panels = figure.subplots(len(CRITERIA), len(backflips.LENGTHS), sharey=True, sharex=True)
    counts = sorted({most for row in rows.values() for most in row}, key=int)
    styles = line_styles(rows)
    width = 0.84 / len(rows)
    for line, (criterion, title) in zip(panels, CRITERIA.items(), strict=True):
        for axes, length in zip(line, backflips.LENGTHS, strict=True):
            for i, (label, row) in enumerate(rows.items()):
                at, shares = (
                    (i + 0.5) * width - 0.42,
                    {most: one[criterion][str(length)] for most, one in row.items()},
                )
                _row(axes, shares, counts, at, width, styles[label])
                axes.containers[-1].set_label(words(label))
            axes.set_title(f"{title}, after {length:,} steps", fontsize=9)
            axes.set(xticks=range(len(counts)), xticklabels=counts, ylim=(0, 102))
    for axes in panels[-1]:
        axes.set_xlabel("Demonstrations")
    for axes in panels[:, 0]:
        axes.set_ylabel(f"Flights [%], of {backflips.STARTS} a seed")
    handles, names = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower left", ncols=2, frameon=False, fontsize=8)
    return figure


def _row(
    axes: Any, row: dict[str, Any], counts: list, at: float, width: float, style: dict[str, Any]
) -> None:
    """The bars of one row, with bands and a dot for each seed."""
    for most, shares in row.items():
        x, middle = counts.index(most) + at, shares["iqm"]
        apart = [[max(0.0, middle - shares["low"])], [max(0.0, shares["high"] - middle)]]
        axes.errorbar(
            x, 100 * middle, 100 * np.array(apart), color="k", lw=0.8, capsize=2, zorder=3
        )
        spread = np.linspace(-0.25, 0.25, len(shares["each"])) * width
        axes.plot(
            x + spread,
            100 * np.asarray(shares["each"]),
            ".",
            color="k",
            ms=2.5,
            alpha=0.5,
            zorder=3,
        )
    heights = [100 * shares["iqm"] for shares in row.values()]
    axes.bar(
        [counts.index(most) + at for most in row],
        heights,
        0.92 * width,
        color=style["color"],
        alpha=0.5,
        hatch=HATCHES[STROKES.index(style["linestyle"])],
        edgecolor="white",
        linewidth=0,
    )


def queries(pattern: str) -> tuple[Any, dict[str, Any]]:
    """Figure 6-10: information of the queries, under the clone that asked and the reference."""
    each = explored(pattern)
    most = max(one.most for one in each)
    rows: dict[str, Any] = {}
    for one in [one for one in each if one.most == most]:
        rows[one.label] = {}
        for name, information in (("own", one.own), ("reference", by_reference(one))):
            known = np.isfinite(information).all(0)  # queries that all seeds asked
            if known.any():
                rows[one.label][name] = band_of(information[:, known])
    numbers = {"queries": most, "rows": rows}
    return curves(numbers), numbers


def curves(numbers: dict[str, Any]) -> Any:
    """Figure 6-10: a line with its band for each row, in a panel for each clone."""
    figure = blank(9, 4.6)
    panels: Any = figure.subplots(1, 2)
    titles = {"own": "by the clone that asks", "reference": "by one reference clone"}
    styles, ticks = line_styles(numbers["rows"]), range(5, int(numbers["queries"]) + 1, 5)
    for axes, (name, title) in zip(panels, titles.items(), strict=True):
        for label, row in numbers["rows"].items():
            if name in row:
                one, style = row[name], styles[label] | {"marker": None}
                count = 1 + np.arange(len(one["iqm"]))
                axes.plot(count, one["iqm"], label=words(label), **style)
                axes.fill_between(
                    count, one["low"], one["high"], color=style["color"], alpha=0.1, lw=0
                )
        axes.set(title=f"Information (trace) of the queries, {title}", xlabel="Query")
        axes.set(yscale="log", xticks=[1, *ticks])
        axes.title.set_fontsize(9)
        plain_log(axes.yaxis)
    handles, names = panels[-1].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower left", ncols=2, frameon=False, fontsize=8)
    return figure


def lines(numbers: dict[str, Any]) -> list[str]:
    """A line for each row and number of queries of figure 6-9."""
    result = [f"teacher: {numbers['teacher']:.0%}"]
    for label, row in numbers["rows"].items():
        for most, one in row.items():
            short, long = (_shown(one["success"][str(length)]) for length in backflips.LENGTHS)
            turned, safe = _shown(one["turned"][str(backflips.LENGTHS[-1])]), one["safety"]
            result.append(
                f"{label}, {most} queries ({np.mean(one['asked']):.1f} asked): success {long}, "
                f"after {backflips.LENGTHS[0]:,} steps {short}; turned {turned}; "
                f"greatest V {safe['greatest_V']:,.3g}, "
                f"beyond 90 degrees {safe['beyond_90_degrees']:.1%}"
            )
    return result


def _shown(shares: dict[str, Any]) -> str:
    return f"{shares['iqm']:.2f} [{shares['low']:.2f}, {shares['high']:.2f}]"


def query_lines(numbers: dict[str, Any]) -> list[str]:
    """A line for each row of figure 6-10."""
    result = []
    for label, row in numbers["rows"].items():
        ends = {name: (one["iqm"][0], one["iqm"][-1]) for name, one in row.items()}
        parts = [f"{name} {first:.3g} to {last:.3g}" for name, (first, last) in ends.items()]
        result.append(f"{label}: {'; '.join(parts)}")
    return result
