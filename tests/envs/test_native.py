"""MuJoCo C on threads: batches, other devices, what diverges, errors."""

import threading
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from tiny import only_line

from hybrid_rl.envs.mujoco import native, xla_callback
from hybrid_rl.envs.mujoco.physics import Physics

CHEETAH = Physics("halfcheetah.xml", "native")


def _states(physics, count):
    rng = np.random.default_rng(0)
    qpos = rng.uniform(-0.1, 0.1, (count, 9)).astype(np.float32)
    qvel = rng.normal(0, 0.1, (count, 9)).astype(np.float32)
    ctrl = rng.uniform(-1, 1, (count, 6)).astype(np.float32)
    return jax.vmap(physics.reset)(qpos, qvel), jnp.asarray(ctrl)


@cache
def _many(physics, decisions):
    """`decisions` in one loop, for any number of environments; compiled once."""

    def run(state, ctrl):
        return jax.lax.fori_loop(0, decisions, lambda _, s: physics.step(s, ctrl, 5), state)

    return jax.jit(jax.vmap(run))


def _finishes(work, seconds=120.0):
    """The result of `work`, run on another thread so that a deadlock fails instead of hanging."""
    out = []
    thread = threading.Thread(target=lambda: out.append(jax.block_until_ready(work())), daemon=True)
    thread.start()
    thread.join(seconds)
    assert out, f"unfinished after {seconds} s, or failed"
    return out[0]


@pytest.mark.parametrize(("count", "decisions"), [(1, 300), (5, 200), (1024, 4)])
def test_a_batch_equals_single_environments(count, decisions):
    state, ctrl = _states(CHEETAH, count)
    many = _finishes(lambda: _many(CHEETAH, decisions)(state, ctrl))
    last = jax.tree.map(lambda a: a[-1:], state)
    one = _finishes(lambda: _many(CHEETAH, decisions)(last, ctrl[-1:]))
    for a, b in zip(jax.tree.leaves(many), jax.tree.leaves(one), strict=True):
        np.testing.assert_array_equal(a[-1:], b)


def test_programs_run_at_the_same_time():
    state, ctrl = _states(CHEETAH, 64)
    run = _many(CHEETAH, 20)
    alone = jax.block_until_ready(run(state, ctrl))
    with ThreadPoolExecutor(4) as pool:
        results = [pool.submit(run, state, ctrl) for _ in range(4)]
        for result in results:
            got = _finishes(lambda result=result: result.result())
            np.testing.assert_array_equal(got.qpos, alone.qpos)


def test_the_callback_of_other_devices_gives_the_same(monkeypatch):
    state, ctrl = _states(CHEETAH, 3)
    on_cpu = _many(CHEETAH, 4)(state, ctrl)
    monkeypatch.setattr(jax.lax, "platform_dependent", lambda x, cpu, default: default(x))
    lowered = _many.__wrapped__(CHEETAH, 4).lower(state, ctrl)
    assert "hybrid_rl.native" not in lowered.as_text()
    np.testing.assert_array_equal(lowered.compile()(state, ctrl).qpos, on_cpu.qpos)


def test_only_a_diverged_environment_is_nan():
    state, ctrl = _states(CHEETAH, 3)
    state = state.replace(qpos=jnp.asarray(state.qpos).at[1, 2].set(jnp.inf))
    after = _many(CHEETAH, 1)(state, ctrl)
    assert np.isnan(after.qpos[1]).all()
    assert np.isfinite(after.qpos[jnp.array([0, 2])]).all()


def test_the_persistent_cache_accepts_compiled_programs():
    """It refuses programs with JAX's own Python callbacks."""
    state, ctrl = _states(CHEETAH, 2)
    text = _many(CHEETAH, 1).lower(state, ctrl).compile().as_text()
    assert "hybrid_rl.native" in text
    assert "xla_ffi_python" not in text


def test_an_unstable_simulation_is_one_line_and_no_file(tmp_path, monkeypatch, capfd):
    """MuJoCo's own warnings are a line at each call, also in MUJOCO_LOG.TXT."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(native, "_WARNED", set())
    state, ctrl = _states(CHEETAH, 3)
    huge = jnp.asarray(state.qvel).at[1].set(1e12).at[2].set(1e38)  # NumPy's sum overflows
    state = state.replace(qvel=huge)
    step = jax.vmap(lambda state, ctrl: CHEETAH.step(state, ctrl, 5))
    for _ in range(2):
        jax.block_until_ready(step(state, ctrl))
    native._warn("Linesearch objective is not convex")  # which follows from it
    assert "unstable. (printed once" in only_line(capfd)
    assert not list(tmp_path.iterdir())


def test_an_error_in_a_foreign_call_is_raised():
    def fail(x, y):
        raise ArithmeticError("out of range")

    xla_callback.register("hybrid_rl.test.fails", fail)
    out = jax.ShapeDtypeStruct((3,), np.float32)
    call = jax.ffi.ffi_call("hybrid_rl.test.fails", out)
    with pytest.raises(Exception, match="out of range"):
        jax.block_until_ready(jax.jit(call)(jnp.zeros(3)))
