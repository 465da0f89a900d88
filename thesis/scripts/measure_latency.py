"""Time of one action of exported controllers on one core, as JSON.

    python thesis/scripts/measure_latency.py LABEL=FILE ... > latency.json

FILE is a .stablehlo of `python -m hybrid_rl.export`. Each is called REPEATS times after
a warm-up, with a new observation; the medians and 99th percentiles are in microseconds. The
process keeps to one core, and XLA to one thread. hybrid_rl is not imported.
"""

import json
import os
import platform
import sys
import time
from collections.abc import Callable
from pathlib import Path

REPEATS = 2000
WARM_UP = 50


def program(file: Path) -> tuple[Callable, int]:
    """(act, o) of a .stablehlo; a planner keeps its state between calls."""
    import jax
    import jax.export
    import numpy as np

    exported = jax.export.deserialize(bytearray(file.read_bytes()))
    call, obs = jax.jit(exported.call), exported.in_avals[0].shape[0]
    if len(exported.in_avals) == 1:
        return lambda x: np.asarray(call(x)), obs
    memory = [np.zeros(exported.in_avals[1].shape, np.uint32), 0]

    def act(x: np.ndarray) -> np.ndarray:
        key = np.array([0, memory[1]], np.uint32)
        action, state = call(x, memory[0], key)
        memory[:] = state, memory[1] + 1
        return np.asarray(action)

    return act, obs


def measured(file: Path) -> dict[str, float]:
    """Median and 99th percentile [us] of a call."""
    import numpy as np

    act, size = program(file)
    xs = np.random.default_rng(0).normal(size=(WARM_UP + REPEATS, size)).astype(np.float32)
    times = []
    for x in xs:
        began = time.perf_counter()
        act(x)
        times.append(1e6 * (time.perf_counter() - began))
    middle, high = np.percentile(times[WARM_UP:], (50, 99))
    return {"median_us": round(middle, 1), "p99_us": round(high, 1)}


def main() -> None:
    """Measure the files of the command line."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false"
    os.environ |= {"OPENBLAS_NUM_THREADS": "1", "JAX_PLATFORMS": "cpu"}
    rows = {}
    for text in sys.argv[1:]:
        label, _, file = text.partition("=")
        rows[label] = measured(Path(file))
    names = [
        line.split(":", 1)[1].strip()
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        if line.startswith("model name")
    ]
    from importlib.metadata import version

    versions = {name: version(name) for name in ("jax", "numpy")}
    about = {"processor": names[0], "python": platform.python_version(), **versions}
    print(json.dumps({**about, "calls": REPEATS, "rows": rows}, indent=1))


if __name__ == "__main__":
    main()
