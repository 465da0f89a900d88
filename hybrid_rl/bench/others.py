"""What others' code does on the same machine, as contestants.

Bare loops over `mjx.step` and `mujoco.rollout`, without reward, end or reset; MuJoCo Playground's
CheetahRun and Brax's soft actor-critic where these packages are installed (extra `bench`).
"""

import os
from importlib.util import find_spec
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np

from hybrid_rl import config
from hybrid_rl.bench.ours import compiled
from hybrid_rl.bench.race import Contestant
from hybrid_rl.envs.physics import Physics


def _physics(task: str) -> Physics:
    env: Any = config.build(config.load([f"task={task}", "physics=native"])).agent.episode.env
    return env._body


def bare_native(task: str, count: int, steps: int) -> Contestant:
    """`mujoco.rollout` on all threads."""
    from mujoco import rollout

    model = _physics(task).model
    threads = min(os.cpu_count() or 1, count)
    data = [mujoco.MjData(model) for _ in range(threads)]
    size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS.value)
    first = np.zeros((count, size))
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS.value
    mujoco.mj_getState(model, data[0], first[0], full)
    first[:] = first[0]
    control = np.full((count, steps, model.nu), 0.5)
    pool = rollout.Rollout(nthread=threads)
    return Contestant(
        "bare mujoco.rollout",
        lambda: pool.rollout(model, data, first, control),
        count * steps,
    )


def bare_mjx(task: str, count: int, steps: int, implementation: str = "jax") -> Contestant:
    """`mjx.step` in a scan under `vmap`."""
    from mujoco import mjx

    from hybrid_rl.envs import accelerated

    body = _physics(task)
    on_device, one = accelerated.template(body.asset, implementation, count)
    ctrl = jnp.full(body.model.nu, 0.5)

    def run(qpos: jax.Array) -> jax.Array:
        def start(q: jax.Array) -> Any:
            return one.replace(qpos=q, ctrl=ctrl)

        def forward(_: int, data: Any) -> Any:
            return jax.vmap(mjx.step, (None, 0))(on_device, data)

        return jax.lax.fori_loop(0, steps, forward, jax.vmap(start)(qpos)).qpos

    qpos = jnp.tile(one.qpos, (count, 1))
    name = {"jax": "bare mjx.step", "warp": "bare mjx.step, Warp"}[implementation]
    with jax.numpy_rank_promotion("allow"):
        return compiled(name, run, qpos, work=count * steps)


def playground(count: int, decisions: int) -> Contestant | None:
    """MuJoCo Playground's CheetahRun with its own reward; None where it is not installed."""
    if find_spec("mujoco_playground") is None:
        return None
    from mujoco_playground import registry  # type: ignore[import-not-found]

    env = registry.load("CheetahRun")
    u = jnp.full((count, env.action_size), 0.5)

    def run(state: Any) -> Any:
        return jax.lax.fori_loop(0, decisions, lambda _, s: jax.vmap(env.step)(s, u), state)

    with jax.numpy_rank_promotion("allow"):
        state = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(0), count))
        work = count * decisions * round(env.dt / env.sim_dt)
        return compiled("MuJoCo Playground's CheetahRun", run, state, work=work)
