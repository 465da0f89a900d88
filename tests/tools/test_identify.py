"""Identification of robots, on a slider with a closed form and on an arm of one link."""

import json
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import yaml
from tiny import call

from hybrid_rl import UsageError, identify
from hybrid_rl.tools.identify import __main__ as command
from hybrid_rl.tools.identify import fitting, information, simulation
from scripts.identify_trials import played

SLIDER = """<mujoco><option timestep="0.001" gravity="0 0 0" integrator="RK4"/><worldbody>
  <body name="car"><joint name="x" type="slide"/><geom size="0.1" mass="2"/></body>
</worldbody><actuator><motor name="push" joint="x"/></actuator></mujoco>"""
LINK = """<mujoco><option timestep="0.004" integrator="implicitfast"/><worldbody>
  <body name="link"><joint name="hinge" axis="0 1 0" damping="0.2" frictionloss="0.1"/>
    <geom type="capsule" size="0.03" fromto="0 0 0 0 0 -0.3" mass="1"/></body>
</worldbody><actuator><motor name="motor" joint="hinge" gear="4" ctrlrange="-1 1"/></actuator>
</mujoco>"""
HANGING = """<mujoco><option timestep="0.002" integrator="implicitfast"/><worldbody>
  <body><joint name="hinge" axis="0 1 0" ref="180" damping="0.1"/>
    <inertial pos="0 0 -0.2039" mass="1" diaginertia="1 0.9584 1"/></body>
</worldbody><actuator><motor name="motor" joint="hinge" gear="2"/></actuator></mujoco>"""
FORCE = '<sensor><actuatorfrc name="torque" actuator="motor"/></sensor></mujoco>'
ENDS = ((0.1, 0, ""), (2.5, 0, "beyond its"), (np.nan, 0, "finite"), (0.1, 0.4, "did not return"))
RANGES = {"body.link.mass": [0.6, 1.6], "joint.hinge.damping": [0.1, 0.4]}
RANGES |= {"joint.hinge.frictionloss": [0.05, 0.2], "delay": {"nominal": 0.01, "range": [0, 0.03]}}
LIMITS = {"limits": {"hinge": {"position": [-2, 2], "velocity": 9}}}


def system(tmp_path, text=LINK, parameters=RANGES):
    (tmp_path / "arm.xml").write_text(text)
    return identify.read(tmp_path / "arm.xml", {**(LIMITS if text == LINK else {}), **parameters})


def logged(arm, plan, theta, seed=0, friction=0.0):
    """A log of the arm with theta; friction: more of it [N m], in one direction alone."""
    log, _ = played(arm, replace(plan, ctrl=plan.ctrl - friction / 4), theta, "right", seed)
    return replace(log, ctrl=plan.ctrl)


def test_a_slider_moves_as_its_closed_form_also_between_steps(tmp_path):
    """q = u (t - d)^2 / 2m, so dq / dlog m = -q and dq / dd = -u (t - d) / m."""
    given = {"body.car.mass": [1, 4], "delay": {"nominal": 0.0123, "range": [0, 0.1]}}
    arm = system(tmp_path, SLIDER, given)
    first, _ = simulation.start(arm)
    t = np.array([0.0, 0.5004, 1.0])
    motion = simulation.Motion(np.array([-1.0, 0.0]), np.array([[0.0], [3.0]]), first, 0.0, 1001)
    x, sensors = simulation.simulate([arm.model(arm.nominal)], [0.0123], [motion])
    q = 3 / 4 * np.maximum(t - 0.0123, 0) ** 2
    y = simulation.measured(arm, x, sensors, 0.0, t)[0, :, 0]
    np.testing.assert_allclose(y, q, rtol=1e-3, atol=1e-6)
    J = information.jacobian(arm, arm.nominal, motion, t)
    np.testing.assert_allclose(J[:, 0], -q, rtol=2e-3, atol=1e-6)
    np.testing.assert_allclose(J[:, 1], -0.15 * np.maximum(t - 0.0123, 0), rtol=5e-3, atol=1e-4)


def test_everything_of_a_force_together_is_named_as_what_no_log_shows(tmp_path):
    forces = {**RANGES, "actuator.motor.gain": [0.5, 2.0]}
    (weak,) = identify.excite(system(tmp_path, parameters=forces), "sines", 2.0).weak
    assert weak.text.startswith("scale: body.link.mass, joint.hinge.damping")
    assert not identify.excite(system(tmp_path), "sines", 2.0).weak
    text = LINK.replace("</mujoco>", FORCE)
    seen = system(tmp_path, text, {**forces, **LIMITS, "sensors": ["torque"]})
    assert not identify.excite(seen, "sines", 2.0).weak


def test_fisher_tells_more_than_most_signals_and_all_keep_the_limits(tmp_path):
    arm = system(tmp_path)
    plans = {how: identify.excite(arm, how, 1.0, limits=0.8) for how in command.HOW}
    for plan in plans.values():
        assert plan.reach <= 0.8
        assert all(np.abs(logged(arm, plan, theta).q).max() < 2.01 for theta in arm.draw(5, seed=9))
    assert plans["fisher"].gained > np.median([plan.gained for plan in plans.values()])


def test_the_fit_finds_the_truth_and_says_when_the_model_lacks_something(tmp_path):
    arm = system(tmp_path)
    theta = np.array([1.3, 0.15, 0.15, 0.02])
    plan, other = (identify.excite(arm, "sines", 1.5, seed=seed) for seed in (0, 1))
    logs = [logged(arm, plan, theta, 2), logged(arm, other, theta, 3)]
    found = identify.fit(arm, logs[:1], logs[1], starts=1)
    np.testing.assert_allclose(found.theta, theta, rtol=0.1)
    low, high = found.interval().T
    assert ((low <= theta) & (theta <= high)).mean() >= 0.75
    assert found.held.explained
    assert found.held.error < 5e-4 < found.held.nominal
    odd = [logged(arm, each, theta, 4, friction=0.1) for each in (plan, other)]
    wrong = identify.fit(arm, odd[:1], odd[1], starts=1)
    assert not wrong.held.explained
    assert wrong.held.widen > 2


def test_the_commands_of_the_how_to_identify_its_robot(tmp_path, monkeypatch):
    """I q'' = 3 u - 2 sin q - 0.2 q' with I = 1, in real time."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    page = (Path(__file__).parents[2] / "docs/howto_deploy.md").read_text()
    Path("how_to_robot.py").write_text(page.partition("```python\n")[2].partition("```")[0])
    Path("arm.xml").write_text(HANGING)
    ranges = {"joint.hinge.damping": [0.05, 0.5], "actuator.motor.gain": [0.5, 2.0]}
    Path("params.yaml").write_text(yaml.safe_dump(ranges))
    words = ["model=arm.xml", "parameters=params.yaml"]
    call(command.main, *words, "excite=babble", "seconds=1.5")
    call(command.main, *words, "play=plan.npz", "robot=how_to_robot:Arm")
    call(command.main, *words, "log=log.npz", "check=log.npz", "starts=1")
    values = json.loads(Path("identified/identified.json").read_text())["parameters"]
    assert values["actuator.motor.gain"]["value"] == pytest.approx(1.5, rel=0.1)
    assert yaml.safe_load(Path("identified/ranges.yaml").read_text()).keys() == ranges.keys()


@pytest.mark.parametrize(
    ("parameters", "line"),
    [
        ({"joint.knee.damping": [1, 2]}, "joint.knee.damping: must be ELEMENT.NAME.FIELD"),
        ({"body.leg.mass": [1, 2]}, "body.leg: the model has no such body"),
        ({"joint.hinge.damping": [0.3, 0.4]}, r"0.2 must lie in its range, \[0.3, 0.4\]"),
        ({"limits": {"knee": {"velocity": 1}}}, "limits: the model has no joint knee"),
    ],
)
def test_a_mistake_in_the_parameters_is_one_line(tmp_path, parameters, line):
    with pytest.raises(UsageError, match=line):
        system(tmp_path, parameters=parameters)


def test_without_the_toolbox_the_line_says_what_to_install(monkeypatch):
    monkeypatch.delattr("mujoco.sysid.optimize")
    with pytest.raises(UsageError, match=r'pip install "hybrid_rl\[identify\]"'):
        fitting.sysid()


def test_a_log_of_another_robot_is_one_line(tmp_path):
    np.savez(tmp_path / "log.npz", t=np.arange(30.0), ctrl=np.zeros((30, 2)), q=np.zeros((30, 1)))
    with pytest.raises(UsageError, match=r"ctrl is \[30, 2\]; this model needs finite numbers"):
        identify.load(tmp_path / "log.npz", system(tmp_path))


@pytest.mark.parametrize(("q", "waits", "end"), ENDS)
def test_a_plan_is_played_in_time_and_whatever_happens_ends_in_stop(tmp_path, q, waits, end):
    sent, ended = [], []
    robot = SimpleNamespace(
        reset=lambda: None,
        observe=lambda: (np.array([q, 0.0]), time.monotonic(), time.sleep(waits))[:2],
        apply=sent.append,
        stop=lambda: ended.append(True),
    )
    arm = system(tmp_path)
    plan = identify.excite(arm, "sines", 0.3)
    if end:
        with pytest.raises(UsageError, match=end):
            identify.play(arm, plan, robot)
    else:
        log = identify.play(arm, plan, robot)
        assert (log.t >= plan.t[:-1]).all()  # never early
        np.testing.assert_array_equal(log.ctrl, plan.ctrl[:-1])  # no position after the last one
        np.testing.assert_array_equal(sent[-len(plan.t) :], plan.ctrl)
    assert (bool(ended), bool(sent)) == (True, not end)
