"""What a fit leaves in a folder: arm.xml, ranges.yaml, identified.json and report.png."""

import json
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import yaml

from hybrid_rl.tools.identify.fitting import Found

PANELS = 6  # channels that are drawn


def lines(found: Found) -> list[str]:
    """What was found, one line for each thing."""
    wide, held, system = found.interval(), found.held, found.system
    width = max(map(len, system.names))
    text = [
        f"{name:{width}}  {value:10.5g}  [{low:.5g}, {high:.5g}]{edge}"
        for name, value, (low, high), edge in zip(
            system.names, found.theta, wide, _edges(found), strict=True
        )
    ]
    text += [f"not separable: {each.text}" for each in found.weak]
    n = system.base.nq
    noise = float(np.sqrt((found.noise[:n] ** 2).mean()))
    text.append(f"noise {noise:.2g}; error of the model in the logs, without it: {found.error:.2g}")
    if held is None:
        return [*text, "check=LOG2 would tell whether the intervals can be trusted"]
    text.append(
        f"held-out log: error {held.error:.2g}, nominal model {held.nominal:.2g}, "
        f"{held.expected:.2g} expected from the intervals"
    )
    if held.explained:
        return [*text, "the model explains the held-out log"]
    line = "the model does not explain the held-out log: something that it lacks moves the robot"
    return [*text, f"{line}; the intervals are widened by {held.widen:.1f}"]


def _edges(found: Found) -> list[str]:
    """A remark for each parameter that ended at an end of its range."""
    system = found.system
    z, low, high = (system.z(x) for x in (found.theta, system.low, system.high))
    below = np.where(system.low == 0, np.inf, z - low)  # nothing here is below 0
    at = np.minimum(below, high - z) < 1e-3 * (high - low)
    return ["  at the end of its range: widen it" if each else "" for each in at]


def write(found: Found, out: str | Path) -> Path:
    """Write everything; the folder."""
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    spec = found.system.described(found.theta)
    spec.compile()
    (folder / "arm.xml").write_text(spec.to_xml(), encoding="utf-8")
    ranges = yaml.safe_dump(found.ranges(), sort_keys=False)
    (folder / "ranges.yaml").write_text(ranges, encoding="utf-8")
    held = found.held and vars(found.held)
    narrow, wide = found.interval(False), found.interval()
    values = {
        name: {"value": float(value), "noise_95": a.tolist(), "interval_95": b.tolist()}
        for name, value, a, b in zip(found.system.names, found.theta, narrow, wide, strict=True)
    }
    weak = [{"std": each.std, "parameters": each.text} for each in found.weak]
    described: dict[str, Any] = {"parameters": values, "weak": weak, "held_out": held}
    described |= {"noise": found.noise.tolist(), "error": found.error, "lines": lines(found)}
    (folder / "identified.json").write_text(json.dumps(described, indent=1), encoding="utf-8")
    _draw(found, folder / "report.png")
    return folder


def _draw(found: Found, out: Path) -> None:
    """Measured and simulated, and below each the residual; a column for each log."""
    from matplotlib.figure import Figure

    names = [mujoco.mj_id2name(found.system.base, mujoco.mjtObj.mjOBJ_JOINT, i) or f"q{i}"
             for i in range(found.system.base.njnt)]  # fmt: skip
    shown = min(found.shown[0][0].y.shape[1], PANELS)
    logs = found.shown
    figure = Figure(figsize=(5.5 * len(logs), 2.4 * shown), layout="constrained")
    axes = figure.subplots(2 * shown, len(logs), squeeze=False, height_ratios=[2, 1] * shown)
    for column, (log, y) in zip(axes.T, logs, strict=True):
        for j in range(shown):
            above, below = column[2 * j], column[2 * j + 1]
            above.plot(log.t, log.y[:, j], ".", ms=2, color="0.6", label="measured")
            above.plot(log.t, y[:, j], lw=1, label="simulated")
            below.plot(log.t, log.y[:, j] - y[:, j], lw=0.6)
            above.set_ylabel(names[j] if j < len(names) else f"sensor {j}")
            below.set_ylabel("residual")
        last = log is logs[-1][0] and found.held is not None
        column[0].set_title("held-out log" if last else "log")
        column[0].legend(frameon=False)
        column[-1].set_xlabel("t [s]")
    figure.savefig(out, dpi=130)
