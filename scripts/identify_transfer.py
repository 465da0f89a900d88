"""Does identification pay? Policies for hidden arms, trained on identified and on other models.

    python -m scripts.identify_transfer plants=10 out=identify_transfer.json

A vertical link with a motor and a load turns to an angle and holds it. Each hidden arm has a
heavier load, more friction and damping, a weaker motor and a delay, drawn from FACTORS, RANGES and
DELAY. A policy (SAC) is trained

    nominal      on the model as its file has it
    wide         on another arm of these ranges in each episode
    identified   on the model that `identify` finds from four seconds of sines on the hidden arm,
                 and on its intervals (`episode.randomise.elements`)
    hidden       on the hidden arm itself: what a perfect model would give

and acts on the hidden arm, 64 episodes each.
"""

import json
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

import hybrid_rl as hr
from hybrid_rl import arguments, command, identify
from hybrid_rl.controllers.policy import PolicyController
from hybrid_rl.critics.ensemble_q import EnsembleQ
from hybrid_rl.data.replay import Replay
from hybrid_rl.learners.sac import SAC
from hybrid_rl.policies.tanh_gaussian import TanhGaussian
from hybrid_rl.training.history import HistoryController
from scripts.identify_trials import NOISE, played

ARGUMENTS = (
    arguments.Argument("plants", 10, "hidden arms", arguments.whole()),
    arguments.Argument("first", 0, "number of the first one", arguments.whole(least=0)),
    arguments.Argument("seeds", 3, "policies of each kind", arguments.whole()),
    arguments.Argument("steps", 5000, "decisions of each", arguments.whole()),
    arguments.Argument("history", 1, "observations that a policy sees", arguments.whole()),
    arguments.Argument("hidden", False, "true: also policies of the fourth kind", arguments.flag),
    arguments.Argument("out", "identify_transfer.json", "written after every policy"),
)
DECISION, STEPS = 0.04, 50  # [s], and decisions of an episode
EPISODES = 64
ARM = """<mujoco model="arm">
  <compiler angle="radian"/>
  <option timestep="0.004" integrator="implicitfast"/>
  <default><geom contype="0" conaffinity="0"/></default>
  <worldbody>
    <body name="link">
      <joint name="hinge" axis="0 1 0" damping="0.1" frictionloss="0.1" armature="0.01"/>
      <geom type="capsule" size="0.03" fromto="0 0 0 0 0 -0.4" mass="0.5"/>
      <body name="load" pos="0 0 -0.4"><geom type="sphere" size="0.04" mass="0.5"/></body>
    </body>
  </worldbody>
  <actuator><motor name="motor" joint="hinge" gear="9" ctrlrange="-1 1"/></actuator>
</mujoco>"""
FACTORS = {  # of the hidden arms, on the model's values
    "body.load.mass": (1.0, 1.8),
    "joint.hinge.damping": (1.0, 4.0),
    "joint.hinge.frictionloss": (1.0, 5.0),
}
RANGES = {"actuator.motor.gain": [0.6, 1.0]}
DELAY = [0.0, 0.06]  # [s]


@dataclass(frozen=True)
class Reach:
    """r = -|angle - target| - 0.01 u^2; o = (cos q, sin q, qvel / 5, q - target) [4]."""

    asset: str
    spec = hr.Spec(obs=4, act=1, dt=DECISION)

    def reset(self, key: jax.Array) -> hr.EnvState:
        """At rest, about where it hangs, with a random target between there and 30 degrees up."""
        begin, aim = jax.random.split(key)
        qpos = jax.random.uniform(begin, (1,), minval=-0.5, maxval=0.5)
        target = jax.random.uniform(aim, (1,), minval=-2.0, maxval=2.0)
        data = hr.Physics(self.asset).reset(qpos, jnp.zeros(1))
        return self._state(data, target, jnp.zeros(1))

    def step(self, state: hr.EnvState, action: jax.Array) -> hr.EnvState:
        """One decision."""
        action = jnp.clip(action, -1.0, 1.0)
        data = hr.Physics(self.asset).step(state.data, action, round(DECISION / 0.004))
        return self._state(data, state.info["target"], action)

    def _state(self, data: Any, target: jax.Array, action: jax.Array) -> hr.EnvState:
        q, error = data.qpos, data.qpos - target
        obs = jnp.concatenate((jnp.cos(q), jnp.sin(q), data.qvel / 5, error))
        reward = -jnp.abs(error).sum() - 0.01 * (action**2).sum()
        return hr.EnvState(data, obs, reward, info={"target": target})


def trained(
    file: Path, folder: Path, seeds: int, steps: int, history: int, **disturbed: Any
) -> Any:
    """Policies of so many seeds, trained on the model in `file`."""
    episode = hr.Episode(Reach(str(file)), steps=STEPS, history=history, **disturbed)
    policy, critic = TanhGaussian(hidden=(64, 64)), EnsembleQ(hidden=(64, 64))
    learners = {"policy": SAC(policy, critic, batch_size=128)}
    acting: Any = PolicyController(policy)
    acting = acting if history == 1 else HistoryController(acting, history)
    agent = hr.Agent(episode, acting, learners, Replay())
    result = hr.train(
        agent, total_steps=steps, num_seeds=seeds, run_dir=str(folder), progress=False
    )
    return result.load()


def returns(loaded: Any, seeds: int, plant: hr.Episode) -> list[float]:
    """Mean return of each seed's policy on a plant."""
    keys = jax.random.split(jax.random.key(1), EPISODES)
    reset, step = jax.jit(jax.vmap(plant.reset)), jax.jit(jax.vmap(plant.step))
    result = []
    for seed in range(seeds):
        policy, state, total = loaded.policy(seed=seed), reset(keys), 0.0
        policy.reset()
        for _ in range(STEPS):
            state = step(state, jnp.asarray(policy(np.asarray(state.obs))))
            total += float(state.reward.mean())
        result.append(total)
    return result


def parameters(file: Path) -> identify.System:
    """The arm with its unknown parameters in the ranges of the hidden ones, and a little beyond."""
    nominal = identify.read(file, dict.fromkeys(FACTORS)).nominal
    ranges: Mapping[str, Any] = {
        name: {"nominal": float(v), "range": [0.9 * a * float(v), 1.1 * b * float(v)]}
        for (name, (a, b)), v in zip(FACTORS.items(), nominal, strict=True)
    }
    gains = {name: {"nominal": 1.0, "range": [0.9 * a, 1.1 * b]} for name, (a, b) in RANGES.items()}
    limits = {name: {"position": [-3, 3], "velocity": 12} for name in ("hinge",)}
    delay = {"nominal": 0.01, "range": [0.0, 0.08]}
    return identify.read(
        file, {**ranges, **gains, "delay": delay, "limits": limits, "noise": NOISE}
    )


def main() -> None:
    """The command."""
    given: Any = arguments.read(__doc__, ARGUMENTS)[0]
    size = {name: given[name] for name in ("seeds", "steps", "history")}
    folder = Path(tempfile.mkdtemp())
    (file := folder / "arm.xml").write_text(ARM)
    arm = parameters(file)
    values = dict(zip(arm.names, arm.nominal.tolist(), strict=True))
    elements = {name: [a * values[name], b * values[name]] for name, (a, b) in FACTORS.items()}
    elements |= RANGES
    began = time.monotonic()
    shared = {
        "nominal": trained(file, folder / "nominal", **size),
        "wide": trained(
            *(file, folder / "wide"),
            **{"randomise": {"elements": elements}, "delay": DELAY[0], "jitter": DELAY[1], **size},
        ),
    }
    rows = []
    for k in range(given["first"], given["first"] + given["plants"]):
        random = np.random.default_rng(200 + k)
        theta = np.array([random.uniform(*elements.get(name, DELAY)) for name in arm.names])
        hidden = folder / f"hidden_{k}.xml"
        hidden.write_text(arm.described(theta).to_xml())
        plant = hr.Episode(Reach(str(hidden)), steps=STEPS, delay=arm.delay(theta))
        log, _ = played(arm, identify.excite(arm, "sines", 4.0, seed=k), theta, "right", 2 * k)
        other = identify.excite(arm, "babble", 4.0, seed=1000 + k)
        check, _ = played(arm, other, theta, "right", 2 * k + 1)
        found = identify.fit(arm, [log], check, seed=k)
        identify.write(found, folder / f"found_{k}")
        low, high = found.interval()[arm.names.index("delay")].tolist()
        loaded = {
            **shared,
            "identified": trained(
                *(folder / f"found_{k}/arm.xml", folder / f"own_{k}"),
                **{"randomise": {"elements": str(folder / f"found_{k}/ranges.yaml")}},
                **{"delay": low, "jitter": high - low, **size},
            ),
        }
        if given["hidden"]:
            at = {"delay": arm.delay(theta), **size}
            loaded["hidden"] = trained(hidden, folder / f"best_{k}", **at)
        row = {name: returns(each, given["seeds"], plant) for name, each in loaded.items()}
        error = (found.theta / np.maximum(theta, 1e-3) - 1).tolist()
        described = {"plant": k, "theta": theta.tolist(), "relative": error}
        rows.append({**described, "held": vars(found.held), "returns": row})
        report = {"names": arm.names, **size, "plants": rows}
        Path(given["out"]).write_text(json.dumps(report))
        means = {name: round(float(np.mean(each)), 2) for name, each in row.items()}
        print(k, means, f"{time.monotonic() - began:.0f} s", flush=True)


if __name__ == "__main__":
    command.run(main)
