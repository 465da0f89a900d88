"""Metrics and parameters of every method and every experiment after 48 decisions.

    python tests/golden/golden.py record FILE   writes FILE, a JSON
    python tests/golden/golden.py compare FILE  compares; the exit code is 1 if a number differs

For changes that must not affect results: record before, compare after, on the same machine,
since float32 rounds differently on another processor; each takes about a quarter of an hour on one
core. Networks, batches and horizons are cut down; the method, the task and every other setting are
those of the configuration. Parameters are compared by value, whatever field of `Params` they are
in; a method that refuses the pendulum is run by its experiments alone.
"""

import hashlib
import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parents[1])]

import jax  # noqa: E402
import jax.numpy as jnp  # noqa: E402
import numpy as np  # noqa: E402
from hydra import compose, initialize_config_dir  # noqa: E402
from omegaconf import DictConfig, ListConfig, OmegaConf  # noqa: E402
from omegaconf.errors import OmegaConfBaseException  # noqa: E402
from tiny import demonstrate  # noqa: E402

import conftest  # noqa: E402, F401  # the same flags of XLA as in the tests
from hybrid_rl.errors import UsageError  # noqa: E402
from hybrid_rl.settings import build as config  # noqa: E402
from hybrid_rl.settings.groups import options  # noqa: E402
from hybrid_rl.training.loop import Loop  # noqa: E402

DECISIONS = 48
MAXIMUM = {  # of a setting, wherever it occurs
    "batch_size": 4,
    "samples": 6,
    "horizon": 3,
    "iterations": 2,
    "updates": 2,
    "capacity": 200,
    "pretrain": 2,
    "random_steps": 4,
    "num_seeds": 1,
    "total_steps": DECISIONS,
    "members": 2,
}


def cases() -> dict[str, list[str]]:
    """Overrides by name: methods on the pendulum, and experiments with each of their methods."""
    overrides = {algo: ["task=pendulum", f"algo={algo}"] for algo in options("algo")}
    for experiment in options("experiment"):
        with initialize_config_dir(str(config.CONF), version_base="1.3"):
            whole = compose("train", [f"experiment={experiment}"], return_hydra_config=True)
        compared = OmegaConf.select(whole, "hydra.sweeper.params.algo")
        for algo in compared.split(",") if compared else [whole.algo]:
            overrides[f"{experiment} {algo}"] = [f"experiment={experiment}", f"algo={algo}"]
    return overrides


def cut(node: Any) -> None:
    """Limit the sizes in `node` and below, in place."""
    for key, value in node.items():
        if isinstance(value, DictConfig):
            cut(value)
        elif key == "hidden":
            node[key] = [8 for _ in value]
        elif key in MAXIMUM and isinstance(value, (int, float)):
            node[key] = min(value, MAXIMUM[key])
        elif isinstance(value, ListConfig):
            for item in value:
                if isinstance(item, DictConfig):
                    cut(item)


def digest(tree: Any) -> str:
    """A digest of all leaves in any order."""
    each = [hashlib.sha1(np.asarray(leaf).tobytes()).hexdigest() for leaf in jax.tree.leaves(tree)]
    return hashlib.sha1(" ".join(sorted(each)).encode()).hexdigest()[:12]


def size(tree: Any) -> float:
    """Sum of the absolute values of all leaves."""
    leaves = [np.abs(np.asarray(leaf, np.float64)).sum() for leaf in jax.tree.leaves(tree)]
    return float(np.sum(leaves))


def outcome(overrides: list[str]) -> dict[str, Any]:
    """The metrics of a method, its parameters, and its actions without exploration.

    What is refused is empty.
    """
    try:
        return _outcome(overrides)
    except (UsageError, OmegaConfBaseException):  # the latter: the task lacks what it refers to
        return {}


def _outcome(overrides: list[str]) -> dict[str, Any]:
    whole = config.load(overrides)
    with tempfile.TemporaryDirectory() as folder:
        if whole.pretrain:
            whole = config.load([*overrides, demonstrate(Path(folder), whole)])
        OmegaConf.set_struct(whole, False)
        cut(whole)
        run = config.build(whole)
        loop = Loop(run.agent, run.seeds, stride=DECISIONS)
        state = loop.init()
        program = loop.compile(state)
        state, metrics = program(state, jnp.int32(0), jnp.int32(DECISIONS))
        params = jax.tree.map(lambda leaf: leaf[0], jax.vmap(run.agent.params)(state))
    means: dict[str, Any] = {}
    for name, values in sorted(metrics.items()):
        known = np.asarray(values)[~np.isnan(np.asarray(values, np.float32))]
        means[name] = float(known.mean(dtype=np.float64)) if known.size else None
    learned = sorted([digest(value), size(value)] for value in params if jax.tree.leaves(value))
    env = jax.tree.map(lambda leaf: leaf[0, 0], state.env)
    params, actions = params._replace(world=env), {}
    for mode, controller in run.controllers.items():
        first = controller.init(run.agent.spec)
        u = jax.jit(controller.act)(params, first, env.obs, jax.random.key(7))[0]
        actions[mode] = [float(value) for value in u]
    return {"metrics": means, "learned": learned, "actions": actions}


def values(tree: Any) -> dict[str, Any]:
    """Path -> value of all leaves of an outcome."""
    leaves = jax.tree_util.tree_leaves_with_path(tree, is_leaf=lambda node: node is None)
    return {jax.tree_util.keystr(path): value for path, value in leaves}


def moved(before: Any, after: Any) -> list[str]:
    """The differences between two outcomes, a line each."""
    old, new = values(before), values(after)
    lines = [f"{key}: {'gone' if key in old else 'new'}" for key in old.keys() ^ new.keys()]
    for key in old.keys() & new.keys():
        if (a := old[key]) != (b := new[key]):
            known = isinstance(a, float) and isinstance(b, float)
            apart = f" (relative {abs(a - b) / max(abs(a), 1e-12):.1e})" if known else ""
            lines.append(f"{key}: {a} -> {b}{apart}")
    return sorted(lines)


def main() -> None:
    """The command; further arguments choose the cases whose names contain one of them."""
    mode, file, words = sys.argv[1], Path(sys.argv[2]), sys.argv[3:]
    known = json.loads(file.read_text()) if file.exists() else {}
    wrong = 0
    for name, overrides in cases().items():
        if words and not any(word in name for word in words):
            continue
        now = outcome(overrides)
        if mode == "record":
            known[name] = now
            file.write_text(json.dumps(known, indent=0, sort_keys=True) + "\n")
            print(name, flush=True)
            jax.clear_caches()
            continue
        lines = moved(known[name], now) if name in known else ["not recorded"]
        wrong += bool(lines)
        print(f"{name}: {'moved' if lines else 'same'}", *lines, sep="\n    ", flush=True)
        jax.clear_caches()
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    os.chdir(HERE.parents[1])
    main()
