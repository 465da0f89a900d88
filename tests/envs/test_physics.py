"""The physics: resets, the implementation that is chosen, models of others, empty fields."""

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.envs.mujoco.physics import Physics, resolve


def test_auto_depends_on_the_number_of_environments(monkeypatch):
    """With a GPU: MuJoCo C for few; for many or an unknown number Warp, or MJX without it."""
    assert (resolve("auto"), resolve("mjx")) == ("native", "mjx")
    installed = [True]
    monkeypatch.setattr("hybrid_rl.envs.mujoco.physics.find_spec", lambda _: installed[0] or None)
    monkeypatch.setattr(jax, "default_backend", lambda: "gpu")
    monkeypatch.setattr("hybrid_rl.envs.mujoco.native.cores", lambda: 16)
    names = [resolve("auto", count) for count in (1, 640, 641, None)]
    assert names == ["native", "native", "warp", "warp"]
    installed[0] = False
    assert resolve("auto", 641) == "mjx"
    assert resolve("mjx", 1) == "mjx"


def test_a_model_outside_the_repository(tmp_path):
    file = tmp_path / "own.xml"
    ball = "<worldbody><body><freejoint/><geom size='1'/></body></worldbody>"
    file.write_text(f"<mujoco>{ball}</mujoco>")
    physics = Physics(str(file), "native")
    state = physics.step(physics.reset(jnp.eye(7)[3], jnp.zeros(6)), jnp.zeros(0), 10)
    np.testing.assert_allclose(state.qvel[2], -9.81 * 0.02, rtol=1e-5)
    far = physics.step(state.replace(qvel=state.qvel.at[0].set(1e12)), jnp.zeros(0), 1)
    assert not abs(far.qvel[0]) < 1e9  # MuJoCo would have reset what diverges


def test_a_state_has_no_empty_arrays():
    """Shardy of jax 0.11 ends the process when it shards one."""
    for asset in ("halfcheetah.xml", "halfcheetah_contact.xml", "pendulum.xml"):
        body = Physics(asset, "native")
        state = body.reset(jnp.asarray(body.model.qpos0), jnp.zeros(body.model.nv))
        after = body.step(state, jnp.zeros(body.model.nu), 1)
        for now in (state, after):
            assert all(x.size for x in jax.tree.leaves(now))
        assert jax.tree.structure(state) == jax.tree.structure(after)
