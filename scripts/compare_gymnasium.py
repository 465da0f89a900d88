"""Walking robots against Gymnasium's: one decision from the same state, random actions.

    python scripts/compare_gymnasium.py --physics native mjx --out docs/results/gymnasium.json
    python scripts/compare_gymnasium.py --speed --out docs/results/gymnasium_speed.json

Before every decision ours is set to the state of Gymnasium's, so that differences do not grow
from decision to decision. `state` is the largest difference of an entry of qpos or qvel after the
decision, `reward` the difference of the reward, which for Ant-v5 includes the contact cost.
--speed: steps/s of one environment of ours through the Gymnasium adapter and of Gymnasium's, in
turns, each by its fastest block.
"""

import argparse
import json
import time
from pathlib import Path
from typing import Any

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.envs.adapters.gymnasium import GymnasiumEnv
from hybrid_rl.envs.ant import Ant
from hybrid_rl.envs.halfcheetah import HalfCheetah
from hybrid_rl.envs.hopper import Hopper
from hybrid_rl.envs.humanoid import Humanoid
from hybrid_rl.envs.swimmer import Swimmer
from hybrid_rl.envs.walker2d import Walker2d

WORLDS = {  # name -> environment, its fields, Gymnasium's
    "half-cheetah": (HalfCheetah, {}, "HalfCheetah-v5"),
    "hopper": (Hopper, {}, "Hopper-v5"),
    "walker": (Walker2d, {}, "Walker2d-v5"),
    "ant, points": (Ant, {"reward": "gymnasium"}, "Ant-v5"),
    "ant, capsules": (Ant, {"reward": "gymnasium", "contacts": "capsules"}, "Ant-v5"),
    "swimmer": (Swimmer, {}, "Swimmer-v5"),
    "humanoid": (Humanoid, {"observation": "full"}, "Humanoid-v5"),
}
EPISODES, LONGEST = 20, 100  # decisions
BLOCKS, BLOCK = 150, 100  # steps of a block


def differences(name: str, physics: str) -> dict[str, Any]:
    """One row: how far a decision differs."""
    kind, fields, theirs_name = WORLDS[name]
    ours, theirs = kind(physics, **fields), gymnasium.make(theirs_name).unwrapped
    empty = ours.reset(jax.random.key(0))
    reset, step = jax.jit(ours._body.reset), jax.jit(ours.step)
    state, reward, cost, touching, ends = [], [], [], 0, 0
    for episode in range(EPISODES):
        theirs.reset(seed=episode)
        rng = np.random.default_rng(episode)
        for _ in range(LONGEST):
            data = reset(jnp.asarray(theirs.data.qpos), jnp.asarray(theirs.data.qvel))
            action = rng.uniform(-1, 1, ours.spec.act).astype(np.float32)
            _, right, terminated, _, info = theirs.step(theirs.action_space.high * action)
            after = step(empty.replace(data=data), action)
            pairs = ((after.data.qpos, theirs.data.qpos), (after.data.qvel, theirs.data.qvel))
            state.append(max(np.abs(np.asarray(a) - b).max() for a, b in pairs))
            reward.append(abs(float(after.reward) - float(right)))
            cost.append(-info.get("reward_contact", 0.0))
            touching += theirs.data.ncon > 0
            ends += bool(after.terminated) != terminated
            if terminated:
                break
    theirs.close()
    return {
        "name": name,
        "physics": physics,
        "decisions": len(state),
        "touching": int(touching),
        "other_ends": int(ends),
        "state_median": float(np.median(state)),
        "state_99": float(np.quantile(state, 0.99)),
        "state_max": float(np.max(state)),
        "reward_mean": float(np.mean(reward)),
        "reward_max": float(np.max(reward)),
        "contact_cost_mean": float(np.mean(cost)),
        "contact_cost_max": float(np.max(cost)),
    }


def speed(name: str) -> dict[str, Any]:
    """One row: steps/s of both, and their ratio."""
    kind, fields, theirs_name = WORLDS[name]
    pair = [GymnasiumEnv(kind("native", **fields), 0), gymnasium.make(theirs_name)]
    rng = np.random.default_rng(0)
    actions = rng.uniform(-1, 1, (BLOCK, pair[0].env.spec.act)).astype(np.float32)
    best = [np.inf, np.inf]  # [s] of a block
    for _ in range(BLOCKS):
        for i, env in enumerate(pair):
            env.reset(seed=0)
            began = time.perf_counter()
            for action in actions:
                if env.step(action)[2]:
                    env.reset()
            best[i] = min(best[i], time.perf_counter() - began)
    ours, theirs = (round(BLOCK / seconds, 1) for seconds in best)
    return {"name": name, "steps_per_s": ours, "gymnasium": theirs, "ratio": ours / theirs}


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description="Walking robots against Gymnasium's")
    parser.add_argument("--physics", nargs="+", default=["native"])
    parser.add_argument("--speed", action="store_true")
    parser.add_argument("--out", type=Path)
    arguments = parser.parse_args()
    rows = []
    for physics in [None] if arguments.speed else arguments.physics:
        for name in WORLDS:
            rows.append(speed(name) if physics is None else differences(name, physics))
            print(json.dumps(rows[-1]), flush=True)
    if arguments.out:
        arguments.out.write_text(json.dumps({"rows": rows}, indent=1) + "\n", encoding="ascii")


if __name__ == "__main__":
    main()
