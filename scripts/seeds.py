"""Episodes of all learners of a run in one compiled program, and files of what they gave."""

import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from hybrid_rl.run.machine.provenance import device
from hybrid_rl.run.saved import Trained
from hybrid_rl.training.rollout import evaluation_keys

Row = tuple[str, Mapping[str, Any]]  # who acts, and what it gave: name -> [S]


def split_names(text: str) -> list[str]:
    """The names in `text`, with ; between them."""
    return [each.strip() for each in text.split(";") if each.strip()]


def every(trained: Trained, episodes: int, one: Callable[[Any, Array], Any]) -> Any:
    """What `one` gives for the parameters and the keys [episodes] of each learner: [S, ...]."""
    keys = jnp.stack([evaluation_keys(seed, episodes) for seed in trained.seeds])
    return jax.tree.map(np.asarray, jax.jit(jax.vmap(one))(trained.params, keys))


def write(out: str, trained: Trained, about: Mapping[str, Any], rows: Iterable[Row]) -> None:
    """Write each row to `out` and print its means, as soon as it is measured.

    Other rows that `out` has stay, if they are of the same run.
    """
    table = {"machine": device(), "run": trained.task, "seeds": list(trained.seeds)}
    table |= {"step": trained.step, **about}
    before = json.loads(Path(out).read_text()) if Path(out).exists() else {}
    same = {key: before.get(key) for key in table} == table
    found: dict[str, Any] = {**table, "rows": before["rows"] if same else {}}
    for name, row in rows:
        each = {key: np.asarray(values, float) for key, values in row.items()}
        found["rows"][name] = {key: values.round(2).tolist() for key, values in each.items()}
        shown = ", ".join(f"{key} {values.mean():.1f}" for key, values in each.items())
        print(f"{name}: {shown}", flush=True)
        Path(out).write_text(json.dumps(found, indent=1) + "\n")
