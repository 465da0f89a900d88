"""Identify arms with hidden parameters: excitations side by side, wrong structures, faulty logs.

    python -m scripts.identify_trials kinds=right,stribeck truths=10 out=identify.json
    python -m scripts.identify_trials arms=sawyer,cheetah how=fisher,sines workers=20

Each trial draws a truth from the ranges, plans four seconds at the nominal model, plays them on the
truth with 1 mrad of noise, fits, and is judged on a babble of four seconds that is the same for all
excitations. `error` is without noise, from the same state. The kinds of truths:

    right      the model with other parameters
    stribeck   friction 50% higher at rest, centre of mass of the last link 6% away: in no model
    clock      the log's clock runs 2% fast
    jitter     each command arrives up to 10 ms later than written
    servo      the known gain of the first servo is 20% wrong
    backlash   the second joint's sensor has a play of 5 mrad
"""

import json
import multiprocessing
import os
import tempfile
import time
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from hybrid_rl import arguments, command, identify
from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.tools.identify import simulation
from hybrid_rl.tools.identify.excitation import Plan

ARGUMENTS = (
    arguments.Argument("arms", ["two_link"], "with an s: arms or half-cheetahs",
        arguments.several("two_link", "sawyer", "cheetah")),
    arguments.Argument("kinds", ["right"], "of truths", arguments.several(
        "right", "stribeck", "clock", "jitter", "servo", "backlash")),
    arguments.Argument("how", ["fisher", "sines", "chirp", "babble"], "excitations",
        arguments.several("fisher", "sines", "chirp", "steps", "babble")),
    arguments.Argument("seconds", [4.0], "of the motion", arguments.numbers()),
    arguments.Argument("truths", 10, "of each kind", arguments.whole()),
    arguments.Argument("starts", 6, "of each fit", arguments.whole()),
    arguments.Argument("workers", 2, "processes", arguments.whole()),
    arguments.Argument("out", "identify.json", "written after every trial"),
)  # fmt: skip
NOISE = 1e-3  # [rad]
TWO_LINK = """<mujoco model="arm">
  <compiler angle="radian"/>
  <option timestep="0.002" integrator="implicitfast"/>
  <default><geom type="capsule" size="0.03" contype="0" conaffinity="0"/></default>
  <worldbody>
    <body name="upper">
      <joint name="shoulder" axis="0 1 0" damping="0.8" frictionloss="0.5" armature="0.02"/>
      <geom fromto="0 0 0 0.3 0 0" mass="1.5"/>
      <body name="lower" pos="0.3 0 0">
        <joint name="elbow" axis="0 1 0" damping="0.3" frictionloss="0.2" armature="0.01"/>
        <geom fromto="0 0 0 0.25 0 0" mass="0.8"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <position name="shoulder" joint="shoulder" kp="60" kv="3" forcerange="-20 20" ctrlrange="-1.5 1.5"/>
    <position name="elbow" joint="elbow" kp="30" kv="1" forcerange="-8 8" ctrlrange="-1.5 1.5"/>
  </actuator>
</mujoco>"""  # noqa: E501
LEGS = ("back_thigh", "back_shin", "front_thigh", "front_shin")
UNKNOWN = {  # of the two links; ranges of half and 1 / 0.6 of the nominal value
    "two_link": (
        *("body.upper.mass", "body.lower.mass", "joint.shoulder.damping", "joint.elbow.damping"),
        *("joint.shoulder.frictionloss", "joint.elbow.frictionloss", "joint.shoulder.armature"),
        *("joint.elbow.armature", "actuator.elbow.gain"),
    ),
    "sawyer": (
        *(f"joint.j{i}.frictionloss" for i in range(7)),
        *(f"joint.j{i}.armature" for i in range(3)),
        *("actuator.j1.gain", "actuator.j3.gain", "body.rod.mass"),
    ),
    "cheetah": (
        *("geom.floor.friction", "body.torso.mass", "body.front_thigh.mass"),
        *(f"joint.{leg}.damping" for leg in LEGS),
        *(f"joint.{leg}.stiffness" for leg in LEGS),
    ),
}
SPEEDS = (1.74, 1.328, 1.957, 1.957, 3.485, 3.485, 4.545)  # [rad/s] of Sawyer
LIMITS = {
    "two_link": {
        "shoulder": {"position": [-1.5, 1.5], "velocity": 6},
        "elbow": {"position": [-1.5, 1.5], "velocity": 8},
    },
    "sawyer": {f"j{i}": {"velocity": v} for i, v in enumerate(SPEEDS)},
    "cheetah": {"pitch": {"position": [-0.8, 0.8]}, **{name: {"velocity": 15} for name in LEGS}},
}


def system(arm: str, folder: Path) -> identify.System:
    """An arm and its unknown parameters: a factor of exp(-0.5) to exp(0.5) about the nominal."""
    file = folder / f"{arm}.xml"
    file.write_text({"two_link": lambda: TWO_LINK, "sawyer": sawyer, "cheetah": cheetah}[arm]())
    model = identify.read(file, dict.fromkeys(UNKNOWN[arm])).nominal
    ranges: dict[str, Any] = {
        name: [float(v * np.exp(-0.5)), float(v * np.exp(0.5))]
        for name, v in zip(UNKNOWN[arm], model, strict=True)
    }
    ranges["delay"] = {"nominal": 0.01, "range": [0.01 * np.exp(-0.5), 0.01 * np.exp(0.5)]}
    return identify.read(file, {**ranges, "noise": NOISE, "limits": LIMITS[arm]})


def sawyer() -> str:
    """The library's Sawyer with position servos, friction in its joints and a payload."""
    spec = mjcf.spec("sawyer.xml")
    spec.option.timestep = 0.002
    torque, kp = (80, 80, 40, 40, 9, 9, 9), (800, 800, 300, 300, 60, 60, 20)
    for i in range(7):
        spec.joint(f"j{i}").frictionloss = 0.03 * torque[i]
        servo = spec.add_actuator(name=f"j{i}", target=f"j{i}", trntype=mujoco.mjtTrn.mjTRN_JOINT)
        servo.set_to_position(kp=kp[i], kv=0.1 * kp[i])
        servo.forcerange[:], servo.forcelimited = (-torque[i], torque[i]), True
        servo.ctrlrange[:], servo.ctrllimited = spec.joint(f"j{i}").range, True
    spec.geom("rod").mass, spec.body("rod").gravcomp = 1.0, 0.0  # a payload
    spec.compile()
    return spec.to_xml()


def cheetah() -> str:
    """The library's half-cheetah on a floor whose friction is that of each contact."""
    spec = mjcf.spec("halfcheetah.xml")
    spec.geom("floor").priority = 1
    spec.compile()
    return spec.to_xml()


def played(
    arm: identify.System, plan: Plan, theta: np.ndarray, kind: str, seed: int
) -> tuple[identify.Log, np.ndarray]:
    """The log of a truth, and its states [S + 1, nstate]."""
    random, h = np.random.default_rng(seed), arm.base.opt.timestep
    first, _ = simulation.start(arm)
    model, t = arm.model(theta), plan.t
    sent = t + (random.uniform(0, 0.01, len(t)) if kind == "jitter" else 0)
    motion = simulation.Motion(sent, plan.ctrl, first, 0.0, round((t[-1] + 0.01) / h))
    if kind == "servo":
        for field in (model.actuator_gainprm, model.actuator_biasprm):
            field[0] *= 1.2
    if kind == "stribeck":
        x = stribeck(arm, model, motion, theta)
    else:
        x = simulation.simulate([model], [arm.delay(theta)], [motion])[0][0]
    q = simulation.measured(arm, x[None], np.zeros((1, 2, 1)), 0.0, t)[0]
    if kind == "backlash":
        held = q[0, 1]
        for row in q:
            held = np.clip(held, row[1] - 2.5e-3, row[1] + 2.5e-3)
            row[1] = held
    q = q + NOISE * random.normal(size=q.shape)
    return identify.Log(1.02 * t if kind == "clock" else t, plan.ctrl, q), x


def stribeck(
    arm: identify.System, model: mujoco.MjModel, motion: Any, theta: np.ndarray
) -> np.ndarray:
    """States of the truth that no model of the ranges is."""
    model.body_ipos[-1, 0] *= 1.06
    mujoco.mj_setConst(model, mujoco.MjData(model))
    data = mujoco.MjData(model)
    mujoco.mj_setState(model, data, motion.first, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    ctrl = simulation.commands(motion, arm.delay(theta), model.opt.timestep, motion.steps)
    states = [motion.first]
    for u in ctrl:
        v = data.qvel
        data.ctrl[:] = u
        data.qfrc_applied[:] = (
            -0.5 * model.dof_frictionloss * np.tanh(v / 0.02) * np.exp(-((v / 0.3) ** 2))
        )
        mujoco.mj_step(model, data)
        states.append(np.concatenate(([data.time], data.qpos, data.qvel, data.act)))
    return np.stack(states)


def trial(job: tuple[str, str, str, float, int, int]) -> dict[str, Any]:
    """One excitation on one truth."""
    name, kind, how, seconds, k, starts = job
    with tempfile.TemporaryDirectory() as folder:
        arm = system(name, Path(folder))
        theta = arm.draw(k + 1, seed=100)[k]
        begun = time.process_time()
        plan = identify.excite(arm, how, seconds, seed=k)
        planned = time.process_time() - begun
        other = identify.excite(arm, "babble", 4.0, seed=1000 + k)
        log, x = played(arm, plan, theta, kind, seed=2 * k)
        check, held = played(arm, other, theta, kind, seed=2 * k + 1)
        begun = time.process_time()
        found = identify.fit(arm, [log], check, starts=starts, seed=k)
        fitted = time.process_time() - begun
        same = played(arm, other, found.theta, "right", seed=0)[1]
        nq = arm.base.nq
        error = np.sqrt(np.mean((same - held)[:, 1 : 1 + nq] ** 2))
        inside = [
            [bool(a <= v <= b) for v, (a, b) in zip(theta, found.interval(wide), strict=True)]
            for wide in (False, True)
        ]
        q, v = x[:, 1 : 1 + nq], x[:, 1 + nq : 1 + 2 * nq]
        low, high, speed = arm.bounds
        ends = np.isfinite(low)  # of a joint with limits
        middle, half = (high[ends] + low[ends]) / 2, (high[ends] - low[ends]) / 2
        used = max(np.max(abs(q[:, ends] - middle) / half), np.max(abs(v) / speed))
        relative = (found.theta / theta - 1).tolist()
        judged = found.held
        assert judged is not None
        return {
            **dict(zip(("arm", "kind", "how", "seconds", "truth", "starts"), job, strict=True)),
            **{"relative": relative, "error": float(error), "own": found.error},
            **{"inside": inside[0], "inside_widened": inside[1], "std": found.std.tolist()},
            **{"deviations": plan.deviations.tolist(), "gained": plan.gained},
            **{"held": vars(judged), "limit": float(used)},
            **{"planned_s": planned, "fitted_s": fitted},
            "weak": [each.text for each in found.weak],
        }


def _alone() -> None:
    """Give a worker a core of its own."""
    cores = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {cores[multiprocessing.current_process()._identity[0] % len(cores)]})


def main() -> None:
    """The command."""
    given: Any = arguments.read(__doc__, ARGUMENTS)[0]
    jobs = [
        (arm, kind, how, seconds, k, given["starts"])
        for k in range(given["truths"])
        for arm in given["arms"]
        for kind in given["kinds"]
        for seconds in given["seconds"]
        for how in given["how"]
    ]
    rows: list[dict[str, Any]] = []
    context = multiprocessing.get_context("spawn")
    with context.Pool(given["workers"], _alone) as pool:
        for row in pool.imap_unordered(trial, jobs):
            rows.append(row)
            Path(given["out"]).write_text(json.dumps({"noise": NOISE, "trials": rows}))
            words = (row[key] for key in ("arm", "kind", "how", "seconds", "truth"))
            median = 100 * np.median(np.abs(row["relative"]))
            print(*words, f"{1e3 * row['error']:.3f} mrad, median {median:.2f}%", flush=True)


if __name__ == "__main__":
    command.run(main)
