"""Environments against MuJoCo C: the same states and actions, stepped by mj_step."""

import jax
import mujoco
import numpy as np
import pytest
from worlds import (
    ARMS,
    IMPLEMENTATIONS,
    LIFTED,
    REFERENCE,
    SIMULATED,
    TOUCHING,
    actions,
    jitted,
    make,
    reference,
    rollout,
    start,
)

from hybrid_rl.envs.mujoco import mjcf

pytestmark = pytest.mark.xdist_group("worlds")  # both read `rollout`

# Largest difference of an observation over 20 decisions in contact. Measured: cheetah 5e-6
# native, 4e-4 mjx; hopper 4e-6, 5e-6; walker 1e-5, 6e-5; cart and pole 2e-6, 2e-6 (no contact);
# ant 2e-5, 3e-4; humanoid 6e-6, 5e-5; quadcopter 8e-7, 9e-7 (no contact); Sawyer, in 0.1 m,
# 3e-6, 9e-3; Panda 3e-6, 1e-2 [N], 3e-5 [m]; Sawyer under torque control 1e-6, 2e-5 (no contact,
# rates up to 35 rad/s); ball 5e-6, 2e-6 (no contact).
TOUCHING_BOUND = {
    ("halfcheetah", "native"): 1e-4,
    ("halfcheetah", "mjx"): 3e-3,
    ("hopper", "native"): 1e-4,
    ("hopper", "mjx"): 1e-4,
    ("walker2d", "native"): 1e-4,
    ("walker2d", "mjx"): 1e-3,
    ("cartpole", "native"): 1e-5,
    ("cartpole", "mjx"): 1e-5,
    ("ant", "native"): 1e-4,
    ("ant", "mjx"): 3e-3,
    ("humanoid", "native"): 1e-4,
    ("humanoid", "mjx"): 1e-3,
    ("quadcopter", "native"): 1e-5,
    ("quadcopter", "mjx"): 1e-5,
    ("sawyer_push", "native"): 1e-4,
    ("sawyer_push", "mjx"): 5e-2,
    ("panda_stack", "native"): 1e-4,
    ("panda_stack", "mjx"): 1e-1,
    ("sawyer_torque", "native"): 1e-5,
    ("sawyer_torque", "mjx"): 2e-4,
    ("sprk", "native"): 1e-4,
    ("sprk", "mjx"): 1e-4,
}
TOUCH = {  # geoms in contact
    "halfcheetah": ("floor",),
    "hopper": ("floor",),
    "walker2d": ("floor",),
    "ant": ("floor",),
    "humanoid": ("floor",),
    "sawyer_push": ("rod", "cube"),
    "panda_stack": ("left_pad", "block"),
}


def _error(task, implementation, lane):
    obs = np.asarray(rollout(make(task, implementation)).obs[lane])
    return np.abs(obs - reference(task, implementation, lane)).max()


@pytest.mark.parametrize("implementation", IMPLEMENTATIONS)
@pytest.mark.parametrize("task", SIMULATED)
def test_in_the_air(task, implementation):
    bound = 1e-3 if task in ("ant", "humanoid", "walker2d") else 1e-4
    assert _error(task, implementation, LIFTED) < bound


@pytest.mark.parametrize(("task", "implementation"), TOUCHING_BOUND)
def test_in_contact(task, implementation):
    assert _error(task, implementation, TOUCHING) < TOUCHING_BOUND[task, implementation]


@pytest.mark.parametrize("task", TOUCH)
def test_contact_is_made(task):
    """Otherwise the bounds above would not test contact."""
    model = mjcf.load(REFERENCE[task].asset)
    data, touching = mujoco.MjData(model), {model.geom(name).id for name in TOUCH[task]}
    path = np.asarray(rollout(make(task, "native")).data.qpos)
    counts = {TOUCHING: 0, LIFTED: 0}
    for lane in counts:
        for qpos in path[lane]:
            data.qpos[:] = qpos
            mujoco.mj_forward(model, data)
            counts[lane] += any(touching <= set(pair) for pair in data.contact.geom.tolist())
    assert counts[TOUCHING] >= 5
    assert counts[LIFTED] == 0


@pytest.mark.parametrize("task", [task for task in SIMULATED if task not in ARMS])
def test_a_single_environment_gives_the_same_bits_as_a_batch(task):
    env = make(task, "native")
    state = jax.tree.map(lambda a: a[TOUCHING], start(env))
    step = jitted(env, "step")
    for t, action in enumerate(actions(env)[TOUCHING]):
        state = step(state, action)
        for single, batch in zip(
            jax.tree.leaves(state.data), jax.tree.leaves(rollout(env).data), strict=True
        ):
            np.testing.assert_array_equal(single, batch[TOUCHING][t])
