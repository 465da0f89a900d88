"""What acted between two observations of a late robot, by a stand-in that remembers its physics.

    python -m scripts.what_acted latency_s=0.02 jitter_s=0.005 lost=0.01 out=what_acted.json

A half-cheetah in wall-clock time, with random decisions. FILE has means over the decisions of the
share of the physics steps between their two observations in which acted: `own` the action of the
decision, `before` the one before it, and `believed` what the learner says that acted, by the lag
that it estimated: the overlap of its shares with the true ones.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np

from hybrid_rl.cli.arguments import Argument, number, output, read, whole
from hybrid_rl.envs.adapters.stand_in import HalfCheetah
from hybrid_rl.outside.lag import estimated, shares
from hybrid_rl.outside.row_log import RowLog
from hybrid_rl.tools.stand_in import Physics
from hybrid_rl.types import Spec

ARGUMENTS = (
    Argument("latency_s", 0.02, "[s] of a datagram in each direction", number()),
    Argument("jitter_s", 0.005, "[s] more, on average", number()),
    Argument("lost", 0.01, "share of the datagrams that are lost", number()),
    Argument("decisions", 1000, "how many, all of them random", whole(200)),
    Argument("port", 7300, "of the stand-in", whole()),
    Argument("out", "", "JSON", needed="out=FILE.json"),
)


class Remembering(Physics):
    """A stand-in that remembers what it observed and which action acted, at each step."""

    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        self.steps: dict[bytes, int] = {}  # observation -> step
        self.acting: list[np.ndarray] = []  # [T] of [m]

    def _say(self, k: int) -> None:
        seen = np.asarray(self.env._get_obs(), "<f4").tobytes()
        self.steps[seen] = len(self.acting)
        self.acting.append(self.action.copy())
        super()._say(k)


def measured(physics: Remembering, rows: np.ndarray) -> dict[str, float]:
    """The shares of the module's docstring, of rows [N]."""
    names = ("obs", "next_obs", "sent", "times", "interval")
    lag = estimated(*(rows[name] for name in names))
    found = []
    for row in rows:
        first, last = (physics.steps.get(row[name].tobytes()) for name in ("obs", "next_obs"))
        if first is None or last is None or last <= first:
            continue
        acting = np.array(physics.acting[first + 1 : last + 1])
        same = np.abs(acting[:, None] - row["sent"]).max(-1) < 1e-4  # [steps, PENDING + 1]
        true = same.mean(0)
        believed = shares(row["times"], row["interval"], lag)
        found.append([true[0], true[1], np.minimum(true, believed).sum()])
    own, before, overlap = np.mean(found, 0)
    return {
        "decisions": len(found),
        "lag_s": lag,
        "own": float(own),
        "before": float(before),
        "believed": float(overlap),
    }


def main() -> None:
    """The command."""
    given: Any = read(__doc__, ARGUMENTS)[0]
    out = output("out", given["out"], (".json",))
    late = (given[key] for key in ("latency_s", "jitter_s", "lost"))
    physics = Remembering(HalfCheetah, given["port"], *late)
    with tempfile.TemporaryDirectory() as folder:
        Thread(target=physics.run, args=(1e6,), daemon=True).start()
        words = (
            f"task=robot algo=sac settings=light env.make={HalfCheetah.__module__}:HalfCheetah "
            f"env.kwargs={{port:{given['port']}}} random_steps={given['decisions']} "
            f"total_steps={given['decisions'] + 1} run_dir={folder}/run"
        )
        subprocess.run([sys.executable, "-m", "hybrid_rl.train", *words.split()], check=True)
        size = HalfCheetah.obs, len(HalfCheetah.low)
        log = RowLog(next(Path(folder).glob("run/robot/rows*")), Spec(*size, HalfCheetah.dt))
        rows = np.array([log.read(number) for number in range(log.count())])
    out.write_text(json.dumps(measured(physics, rows), indent=1) + "\n")


if __name__ == "__main__":
    main()
