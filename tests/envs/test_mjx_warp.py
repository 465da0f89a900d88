"""MuJoCo Warp on the CPU: slow, with the same kernels as on a GPU."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from worlds import BROKEN, LIFTED, OTHER, TOUCHING, apart, make, rollout

from hybrid_rl.envs.mujoco.physics import Physics

pytestmark = pytest.mark.turns(4)


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


@pytest.fixture(scope="module")
def mjx_warp():
    """The module: to import it takes 2 s, in every process that collects tests."""
    from hybrid_rl.envs.mujoco import mjx_warp

    return mjx_warp


@pytest.fixture
def small_lists(mjx_warp, monkeypatch):
    """Lists of two constraint rows."""
    monkeypatch.setattr(mjx_warp, "capacities", lambda asset: (11, 2))
    mjx_warp.template.cache_clear()
    yield
    mjx_warp.template.cache_clear()


def test_an_overflow_gives_nan(env, mjx_warp, small_lists):
    """MuJoCo Warp itself would drop contacts and continue."""
    state = env.reset(jax.random.key(0))
    fields = {
        "qpos": state.data.qpos.at[1].add(-0.05),  # into the floor
        "qvel": state.data.qvel,
        "qacc_warmstart": state.data.warmstart,
        "ctrl": state.data.ctrl,
    }
    assert jnp.isnan(mjx_warp.step("hopper.xml", "warp", 1, fields)["qpos"]).all()


@pytest.mark.parametrize(
    ("asset", "contacts", "rows"),
    [
        ("cartpole.xml", 0, 1),  # the ends of the rail
        ("hopper.xml", 11, 38),
        ("walker2d.xml", 14, 62),  # 7 capsules on a floor, 6 joint limits
        ("halfcheetah.xml", 16, 70),  # 8 capsules on a floor, 6 joint limits
        ("humanoid.xml", 138, 242),  # 12 capsules, 5 spheres on a floor, 109 pairs, 17 limits
    ],
)
def test_capacities(mjx_warp, asset, contacts, rows):
    assert mjx_warp.capacities(asset) == (contacts, rows)
