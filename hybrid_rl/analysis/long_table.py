"""Learning curves as a long table, one value of one seed in a row.

    exp_name,env_name,seed,metric,env_step,value

These are the columns in which SimbaV2 and others publish their curves, so that their scripts draw
ours next to theirs. `avg_return` is their name of eval/return; other metrics keep their names.
exp_name is the label of the curve, env_name the task, env_step the number of decisions.
"""

import csv
import io
from collections.abc import Sequence

import numpy as np

from hybrid_rl.analysis.curves import Curve
from hybrid_rl.errors import UsageError

COLUMNS = ("exp_name", "env_name", "seed", "metric", "env_step", "value")
NAMES = {"eval/return": "avg_return"}


def long_table(drawn: Sequence[Curve], x: str) -> str:
    """The text of the table; a missing value has no row.

    Raises:
        UsageError: if `x` is not the number of decisions.
    """
    if x != "step":
        raise UsageError(f"x={x}: a table is over decisions; give x=step, or a picture as out")
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(COLUMNS)
    for curve in drawn:
        metric = NAMES.get(curve.metric, curve.metric)
        for seed, values in zip(curve.seeds, curve.each, strict=True):
            for step, value in zip(curve.x, values.astype("float32"), strict=True):
                if np.isfinite(value):
                    rows.writerow((curve.label, curve.task, seed, metric, f"{step:.10g}", value))
    return text.getvalue()
