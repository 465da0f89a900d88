"""What others' code does on the same machine, as contestants.

Bare loops over `mjx.step` and `mujoco.rollout`, without reward, end or reset; MPPI on the true
model; MuJoCo Playground's CheetahRun where that package is installed (extra `bench`).
"""

from importlib import import_module
from importlib.util import find_spec
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np

from hybrid_rl.bench.ours import beginning, compiled
from hybrid_rl.bench.race import Contestant
from hybrid_rl.envs import native
from hybrid_rl.envs.physics import Physics
from hybrid_rl.training.episode import Episode


def _first(task: str, count: int) -> tuple[Physics, Any]:
    """The physics of a task, and the state of `count` worlds with the controls of an action."""
    episode, state, u = beginning(task, "native", count)
    env: Any = episode.env
    ctrl = jax.jit(jax.vmap(episode.step))(state, u).data.ctrl
    return env._body, state.data.replace(ctrl=ctrl)


def bare_native(task: str, count: int, steps: int) -> Contestant:
    """`mujoco.rollout` on all threads."""
    from mujoco import rollout

    body, first = _first(task, count)
    model, threads = body.model, min(native.cores(), count)
    data = [mujoco.MjData(model) for _ in range(threads)]
    parts = (jnp.zeros((count, 1)), first.qpos, first.qvel, first.act)  # mjSTATE_FULLPHYSICS
    start = np.concatenate([np.asarray(x, float) for x in parts if x is not None], 1)
    control = np.repeat(np.asarray(first.ctrl, float)[:, None], steps, 1)
    pool = rollout.Rollout(nthread=threads)
    return Contestant(
        "bare mujoco.rollout",
        lambda: pool.rollout(model, data, start, control),
        count * steps,
    )


def bare_mjx(task: str, count: int, steps: int, implementation: str = "jax") -> Contestant:
    """`mjx.step` in a loop under `vmap`."""
    from mujoco import mjx

    from hybrid_rl.envs import accelerated

    body, first = _first(task, count)
    on_device, one = accelerated.template(body.asset, implementation, count)

    def run(qpos: jax.Array, qvel: jax.Array, ctrl: jax.Array) -> jax.Array:
        def start(qpos: jax.Array, qvel: jax.Array, ctrl: jax.Array) -> Any:
            return one.replace(qpos=qpos, qvel=qvel, ctrl=ctrl)

        def forward(_: int, data: Any) -> Any:
            return jax.vmap(mjx.step, (None, 0))(on_device, data)

        return jax.lax.fori_loop(0, steps, forward, jax.vmap(start)(qpos, qvel, ctrl)).qpos

    name = {"jax": "bare mjx.step", "warp": "bare mjx.step, Warp"}[implementation]
    with jax.numpy_rank_promotion("allow"):
        return compiled(name, run, first.qpos, first.qvel, first.ctrl, work=count * steps)


def playground(count: int, decisions: int) -> Contestant | None:
    """MuJoCo Playground's CheetahRun with its own reward; None where it is not installed."""
    if find_spec("mujoco_playground") is None:
        return None
    env = import_module("mujoco_playground").registry.load("CheetahRun")
    u = jnp.full((count, env.action_size), 0.5)

    def run(state: Any) -> Any:
        return jax.lax.fori_loop(0, decisions, lambda _, s: jax.vmap(env.step)(s, u), state)

    with jax.numpy_rank_promotion("allow"):
        state = jax.jit(jax.vmap(env.reset))(jax.random.split(jax.random.key(0), count))
        work = count * decisions * round(env.dt / env.sim_dt)
        return compiled("MuJoCo Playground's CheetahRun", run, state, work=work)


def on_the_true_model(episode: Episode, samples: int, horizon: int) -> Contestant:
    """MPPI that rolls its candidates through the world itself; model steps.

    Noise around the last plan, the task's own reward, nothing learned: as hydrax does it.
    """
    repeats, start = 3, jax.jit(episode.reset)(jax.random.key(0))

    def candidate(state: Any, controls: jax.Array) -> jax.Array:
        def forward(state: Any, u: jax.Array) -> tuple[Any, jax.Array]:
            state = episode.step(state, u)
            return state, state.reward

        return jax.lax.scan(forward, state, controls)[1].sum()

    def run(state: Any, plan: jax.Array) -> jax.Array:
        def again(i: jax.Array, plan: jax.Array) -> jax.Array:
            noise = jax.random.normal(jax.random.key(i), (samples, *plan.shape))
            controls = jnp.clip(plan[None] + 0.3 * noise, -1, 1)
            returns = jax.vmap(candidate, (None, 0))(state, controls)
            weights = jax.nn.softmax((returns - returns.mean()) / (returns.std() + 1e-6))
            return jnp.tensordot(weights, controls, 1)

        return jax.lax.fori_loop(0, repeats, again, plan)

    plan = jnp.zeros((horizon, episode.spec.act))
    work = repeats * samples * horizon
    return compiled("MPPI on the true model", run, start, plan, work=work)
