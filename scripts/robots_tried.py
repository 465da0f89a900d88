"""Robots of other packages in task=legs and task=reach: what stands, and how far arms sag.

    python -m scripts.robots_tried LEGS... ARMS...

Each is NAME=FILE.xml. Writes robots_tried.json in the current folder: of legs the share of 64 that
stand two seconds after a start, with servos at home; of arms the farthest [rad] that a joint is
then from home.
"""

import json
import sys
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.envs.legs import Legs
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.simplified import FREE, located
from hybrid_rl.envs.reach import Reach

EPISODES, DECISIONS = 64, 100


def tried(file: str) -> dict[str, float]:
    """What is measured of the robot in a file."""
    walks = FREE in mjcf.load(located(file)).jnt_type[:1]
    env = (Legs if walks else Reach)(robot=file, physics="native")
    model = env._body.model
    state = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(0), EPISODES))
    step, stands = jax.jit(jax.vmap(env.step)), np.ones(EPISODES, bool)
    for _ in range(DECISIONS):
        state = step(state, jnp.zeros((EPISODES, env.spec.act)))
        stands &= ~np.asarray(state.terminated)
    found = {"motors": env.spec.act, "mass": round(float(model.body_mass.sum()), 1)}
    if walks:
        return found | {"feet": int(model.geom_conaffinity.sum()), "stands": float(stands.mean())}
    q = np.asarray(state.obs)[:, : env.spec.act]
    return found | {"sag": round(float(np.abs(q).max()), 3)}


def main() -> None:
    """The command."""
    pairs = [word.split("=", 1) for word in sys.argv[1:]]
    found = {name: tried(file) for name, file in pairs}
    groups = {"legs": "stands", "arms": "sag"}
    parts = {
        group: {name: row for name, row in found.items() if key in row}
        for group, key in groups.items()
    }
    Path("robots_tried.json").write_text(json.dumps(parts, indent=1) + "\n", encoding="utf-8")
    print(json.dumps(parts, indent=1))


if __name__ == "__main__":
    main()
