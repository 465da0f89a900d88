"""What the plots of a window show."""

from collections import deque

import numpy as np

PLOTS = {  # name -> colour
    "reward": "#2a6f97",
    "agreement": "#6a994e",
    "value": "#d1495b",
}
SOURCES = {  # plot -> metric of a planner
    "agreement": "planner/policy_share",  # of the plan: 1 follows the policy
    "value": "planner/planned_return",
}
KEPT = 300  # decisions


class History:
    """The last decisions of an episode."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        """An episode begins."""
        self._rows: deque[dict[str, float]] = deque(maxlen=KEPT)

    def add(self, t: float, reward: float, metrics: dict[str, float]) -> None:
        """A decision at t [s]; metrics: of its planner, NaN where they do not apply."""
        row = {"t": t, "reward": reward}
        row |= {name: float(metrics[key]) for name, key in SOURCES.items() if key in metrics}
        self._rows.append(row)

    def curve(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """t [n] [s] and values [n] of those decisions that have one."""
        kept = [row for row in self._rows if np.isfinite(row.get(name, np.nan))]
        return np.array([row["t"] for row in kept]), np.array([row[name] for row in kept])
