"""What robots learned over the minutes of their lives, and how they kept their time.

    python -m hybrid_rl.figures study=robots runs="runs/arm/*/*" out=robots.png

Runs of `task=robot`; those in one folder are seeds of one row, which has the folder's name. Read
from the rows that the robot's process wrote: the return of each episode, the share of deadlines
kept, how late after the beginning of its period an action was sent, and how old the observation was
then. The picture has the mean return of the episodes that ended in each half minute.
"""

from typing import Annotated, Any

import numpy as np

from hybrid_rl.analysis.results import find
from hybrid_rl.analysis.style import blank, legend_below, line_styles, words
from hybrid_rl.envs.adapters.robot import Robot
from hybrid_rl.errors import UsageError
from hybrid_rl.outside.row_log import row_type
from hybrid_rl.run import folder as run_folder
from hybrid_rl.run.saved import build_run

BIN = 0.5  # [min]
QUANTILES = {"median": 0.5, "99%": 0.99, "greatest": 1.0}


def figure(
    runs: Annotated[str, "run folders of task=robot; a pattern in quotes"],
) -> tuple[Any, dict[str, Any]]:
    """Returns over minutes, a panel for each robot."""
    numbers: dict[str, Any] = {"robots": {}}
    for path in find(runs):
        env = build_run(run_folder.read(path, "runs")).agent.episode.env
        if not isinstance(env, Robot):
            raise UsageError(f"runs={path}: is no run of task=robot")
        data = (path / "robot" / "rows").read_bytes()
        kind = row_type(env.spec)
        rows = np.frombuffer(data[: len(data) // kind.itemsize * kind.itemsize], kind)
        name = env.name.rpartition(":")[2]
        numbers["robots"].setdefault(name, {}).setdefault(path.parent.name, []).append(of(rows))
    return draw(numbers), numbers


def of(rows: np.ndarray) -> dict[str, Any]:
    """The numbers of one run."""
    minutes = (rows["time"] - rows["time"][0]) / 60
    ends = np.flatnonzero((rows["terminated"] | rows["truncated"]) != 0)
    first = np.concatenate([[0], ends[:-1] + 1]).astype(int)
    returns = [float(rows["reward"][a : b + 1].sum()) for a, b in zip(first, ends, strict=False)]
    kept = 1 - rows["missed"][-1] / (len(rows) + rows["missed"][-1])
    return {
        "decisions": len(rows),
        "minutes": float(minutes[-1]),
        "kept": float(kept),
        "missed": int(rows["missed"][-1]),
        "safe_actions": int(rows["unsafe"][-1]),
        "late_ms": {
            name: 1e3 * float(np.quantile(rows["late"], q)) for name, q in QUANTILES.items()
        },
        "age_ms": {name: 1e3 * float(np.quantile(rows["age"], q)) for name, q in QUANTILES.items()},
        "episodes": [[float(minutes[e]), r] for e, r in zip(ends, returns, strict=True)],
    }


def summary(numbers: dict[str, Any]) -> list[str]:
    """A line per run."""
    lines = []
    for robot, rows in numbers["robots"].items():
        for label, each in rows.items():
            for run in each:
                last = [value for minute, value in run["episodes"] if minute > run["minutes"] - 2]
                mean = f"{np.mean(last):,.1f}" if last else "-"
                lines.append(
                    f"{robot}, {words(label)}: {run['minutes']:.1f} min, {run['decisions']:,} "
                    f"decisions, {100 * run['kept']:.3f}% of deadlines kept, return {mean} (last "
                    "two minutes)"
                )
    return lines


def draw(numbers: dict[str, Any]) -> Any:
    """The picture."""
    robots = numbers["robots"]
    picture = blank(4.4 * len(robots), 4.2)
    for axes, (robot, rows) in zip(
        np.atleast_1d(picture.subplots(1, len(robots))), robots.items(), strict=True
    ):
        style = line_styles(rows)
        for label, each in rows.items():
            for i, run in enumerate(each):
                x, y = binned(run["episodes"])
                name = words(label) if i == 0 else None
                axes.plot(x, y, label=name, **style[label])
        axes.set_title(robot)
        axes.set_xlabel("minutes of the robot's life")
        axes.set_ylabel("return of an episode, while learning")
        legend_below(axes)
    return picture


def binned(episodes: Any) -> tuple[np.ndarray, np.ndarray]:
    """Means of the returns that belong to each BIN, at its end."""
    table = np.asarray(episodes, float).reshape(-1, 2)
    bins = np.ceil(table[:, 0] / BIN).astype(int)
    known = np.unique(bins)
    return known * BIN, np.array([table[bins == b, 1].mean() for b in known])
