"""Environments against MuJoCo C: the same states and actions, stepped by mj_step."""

import jax
import mujoco
import numpy as np
import pytest
from worlds import (
    ARMS,
    IMPLEMENTATIONS,
    LIFTED,
    SIMULATED,
    TOUCH,
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

# Largest difference of an observation over 20 decisions in contact, 1e-4 by MuJoCo C (measured: at
# most 2e-5), and by MJX. Measured: cheetah 4e-4; hopper 5e-6; walker 6e-5; cart and pole 2e-6;
# ant 3e-4; humanoid 5e-5; quadcopter 9e-7; Sawyer, in 0.1 m, 9e-3; Panda 1e-2 [N], 3e-5 [m];
# Sawyer under torque control 2e-5, at rates up to 35 rad/s; ball 2e-6.
BY_MJX = {
    "halfcheetah": 3e-3,
    "walker2d": 1e-3,
    "ant": 3e-3,
    "humanoid": 1e-3,
    "sawyer_push": 5e-2,
    "panda_stack": 1e-1,
    "sawyer_torque": 2e-4,
}


@pytest.mark.parametrize("implementation", IMPLEMENTATIONS)
@pytest.mark.parametrize("task", SIMULATED)
def test_observations_are_those_of_mujoco_in_the_air_and_in_contact(task, implementation):
    near = BY_MJX.get(task, 1e-4) if implementation == "mjx" else 1e-4
    free = 1e-3 if task in ("ant", "humanoid", "walker2d") else 1e-4
    for lane, bound in ((LIFTED, free), (TOUCHING, near)):
        obs = np.asarray(rollout(make(task, implementation)).obs[lane])
        assert np.abs(obs - reference(task, implementation, lane)).max() < bound


@pytest.mark.parametrize("task", TOUCH)
def test_contact_is_made(task):
    """Otherwise the bounds above would not test contact."""
    path = rollout(make(task)).data
    model = mjcf.load(path.asset)
    data, touching = mujoco.MjData(model), {model.geom(name).id for name in TOUCH[task].geoms}
    counts = {TOUCHING: 0, LIFTED: 0}
    for lane in counts:
        for data.qpos[:] in np.asarray(path.qpos)[lane]:
            mujoco.mj_forward(model, data)
            counts[lane] += any(touching <= set(pair) for pair in data.contact.geom.tolist())
    assert counts[TOUCHING] >= 5
    assert counts[LIFTED] == 0


@pytest.mark.parametrize("task", [task for task in SIMULATED if task not in ARMS])
def test_a_single_environment_gives_the_same_bits_as_a_batch(task):
    env = make(task)
    state = jax.tree.map(lambda a: a[TOUCHING], start(env))
    for t, action in enumerate(actions(env)[TOUCHING]):
        state = jitted(env, "step")(state, action)
        batch = jax.tree.leaves(rollout(env).data)
        for single, several in zip(jax.tree.leaves(state.data), batch, strict=True):
            np.testing.assert_array_equal(single, several[TOUCHING][t])
