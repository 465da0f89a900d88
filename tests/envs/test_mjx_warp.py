"""MuJoCo Warp on the CPU: slow, with the same kernels as on a GPU."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from worlds import BROKEN, LIFTED, OTHER, TOUCHING, apart, make, rollout

from hybrid_rl.envs.mujoco.physics import Physics

pytestmark = pytest.mark.turns(6)


@pytest.fixture(scope="module")
def env():
    """A hopper that takes the CPU for a GPU."""
    config = pytest.importorskip("warp").config
    config.quiet, config.optimization_level = True, 0  # a third less to compile
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(jax, "default_backend", lambda: "gpu")
        yield make("hopper", "warp")


@pytest.mark.parametrize("lane", [LIFTED, TOUCHING], ids=["in the air", "in contact"])
def test_agrees_with_mujoco(env, lane):
    assert apart(env, lane) < 1e-4  # measured: 4e-6


def test_reads_what_mujoco_c_computes(env):
    names = ("subtree_com", "cinert", "cvel")
    bodies = [Physics("hopper.xml", each, reads=names) for each in ("native", "warp")]
    first = env.reset(jax.random.key(0)).data
    after = [body.step(body.reset(first.qpos, first.qvel), jnp.ones(3), 4) for body in bodies]
    for name in names:
        native, warp = (body.read(s, name) for body, s in zip(bodies, after, strict=True))
        np.testing.assert_allclose(warp, native, atol=1e-4)


def test_nan_stays_in_its_lane(env):
    obs = np.asarray(rollout(env).obs)
    assert np.isnan(obs[BROKEN][5:]).all()
    np.testing.assert_array_equal(obs[TOUCHING], obs[OTHER])


def test_an_overflow_gives_nan(env, monkeypatch):
    """With lists of two constraint rows; MuJoCo Warp itself would drop contacts and continue."""
    from hybrid_rl.envs.mujoco import mjx_warp  # which takes 2 s to import

    monkeypatch.setattr(mjx_warp, "capacities", lambda asset: (11, 2))
    mjx_warp.template.cache_clear()
    state = env.reset(jax.random.key(0))
    fields = {
        "qpos": state.data.qpos.at[1].add(-0.05),  # into the floor
        "qvel": state.data.qvel,
        "qacc_warmstart": state.data.warmstart,
        "ctrl": state.data.ctrl,
    }
    assert jnp.isnan(mjx_warp.step("hopper.xml", "warp", 1, fields)["qpos"]).all()
    mjx_warp.template.cache_clear()
