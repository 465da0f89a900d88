"""What mattered in a tuned sweep: how much each key did, and the results over its values.

    python -m hybrid_rl.figures study=tuning runs=runs/sweeps/TIME out=tuning.png

Read from trials.json of the sweep's folder, which every tuned sweep draws at its end, too. The
importance of a key is its share by PED-ANOVA (Watanabe et al. 2023) in what sets the best tenth of
the finished trials apart; a pruned trial is shown at its last evaluation.
"""

import math
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hybrid_rl import UsageError, style
from hybrid_rl.run.files.reading import json_file

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ACROSS = 3  # panels in a row
WIDTH = 26  # [characters] of a title
KINDS: dict[str, dict[str, Any]] = {  # state of a trial -> its points
    "complete": {"color": style.BLUE, "marker": "o", "label": "finished"},
    "pruned": {"color": style.GREY, "marker": "x", "label": "pruned, at its last evaluation"},
}


def figure(runs: Annotated[str, "folder of a tuned sweep"]) -> tuple["Figure", dict[str, Any]]:
    """The picture of the study in a folder, and its numbers."""
    file = Path(runs) / "trials.json"
    try:
        numbers = json_file(file)
        return draw(numbers), numbers
    except UsageError as error:
        raise UsageError(f"runs={error}") from error
    except (KeyError, TypeError, AttributeError) as error:
        raise UsageError(f"runs={file}: holds no trials of a tuned sweep") from error


def summary(numbers: dict[str, Any]) -> list[str]:
    """The best trial, and a line per key, from the one that mattered most."""
    lines = []
    for row in numbers["trials"]:
        if row["trial"] == numbers["best"]:
            given = " ".join(f"{key}={value}" for key, value in row["values"].items())
            lines.append(f"best of {len(numbers['trials'])}, trial {row['trial']}: {given}")
    shares = sorted(numbers["importances"].items(), key=lambda pair: -pair[1])
    return lines + [f"{key}: importance {share:.0%}" for key, share in shares]


def draw(numbers: dict[str, Any]) -> "Figure":
    """The picture: the importances, then a panel for each key."""
    import matplotlib

    keys = numbers["keys"]
    across = min(ACROSS, len(keys) + 1)
    down = math.ceil((len(keys) + 1) / across)
    with matplotlib.rc_context(style.STYLE):
        picture = style.blank(3.0 * across, 2.6 * down + 0.4)
        panels = picture.subplots(down, across, squeeze=False).flat
        _importances(next(panels), numbers["importances"])
        for key, kind in keys.items():
            axes = next(panels)
            _results(axes, numbers, key, kind)
            axes.set_ylabel("result" if numbers["metric"] == "final_eval" else numbers["metric"])
        style.legend_outside(axes)
        for unused in panels:
            unused.set_axis_off()
    return picture


def _importances(axes: "Axes", shares: dict[str, float]) -> None:
    """A bar for each key, the longest on top."""
    ordered = sorted(shares.items(), key=lambda pair: pair[1])
    names = [key.rpartition(".")[2] for key, _ in ordered]
    axes.barh(
        range(len(names)), [share for _, share in ordered], color=style.BLUE, tick_label=names
    )
    axes.set_xlim(0, 1)
    axes.set_title("importance" if shares else "importance: needs two results")
    axes.grid(axis="y", visible=False)


def _results(axes: "Axes", numbers: dict[str, Any], key: str, kind: str) -> None:
    """The results of all trials over the values of a key; the best one has a ring."""
    known = [row for row in numbers["trials"] if row["result"] is not None]
    names = sorted({row["values"][key] for row in known}, key=_order) if kind == "names" else []
    for state, marks in KINDS.items():
        rows = [row for row in known if row["state"] == state]
        x = [_position(row["values"][key], names) for row in rows]
        axes.plot(x, [row["result"] for row in rows], linestyle="", **marks)
    for row in known:
        if row["trial"] == numbers["best"]:
            ring: dict[str, Any] = {
                "markersize": 11,
                "markerfacecolor": "none",
                "markeredgecolor": style.VERMILION,
            }
            at = _position(row["values"][key], names)
            axes.plot([at], [row["result"]], linestyle="", marker="o", label="best", **ring)
    if names:
        axes.set_xticks(range(len(names)), names)
        axes.set_xlim(-0.5, len(names) - 0.5)
    elif kind == "log" and known:
        axes.set_xscale("log")
        style.plain_log(axes.xaxis, narrow=True)
    axes.set_title("\n".join(textwrap.wrap(key.replace(".", ". "), WIDTH)).replace(". ", "."))


def _position(value: Any, names: list[str]) -> float:
    """Where a value is along the axis."""
    return names.index(value) if names else value


def _order(name: str) -> tuple[float, str]:
    """Numbers by size, then other names."""
    try:
        return float(name), name
    except ValueError:
        return np.inf, name
