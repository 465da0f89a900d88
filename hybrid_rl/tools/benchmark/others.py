"""What others' code does on the same machine, as contestants.

Bare loops over `mjx.step` and `mujoco.rollout`, without reward, end or reset; MPPI on the true
model; gradient steps of Brax's soft actor-critic; MuJoCo Playground's CheetahRun where that package
is installed (extra `bench`).

Bare loops step the compiled model that our world steps, so solver, iterations, integrator and time
step are equal. Playground's world has a model and solver settings of its own.
"""

import os
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import jax
import jax.numpy as jnp
import mujoco
import numpy as np
import optax

from hybrid_rl import Episode, Physics
from hybrid_rl.tools.benchmark.ours import beginning, compile_contestant, recalled, world
from hybrid_rl.tools.benchmark.race import Contestant
from hybrid_rl.types import Batch, Spec


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
    model, threads = body.model, min(os.cpu_count() or 1, count)
    data = [mujoco.MjData(model) for _ in range(threads)]
    parts = (jnp.zeros((count, 1)), first.qpos, first.qvel, first.act)  # mjSTATE_FULLPHYSICS
    start = np.concatenate([np.asarray(x, float) for x in parts if x is not None], 1)
    control = np.repeat(np.asarray(first.ctrl, float)[:, None], steps, 1)
    pool = rollout.Rollout(nthread=threads)
    return Contestant(
        "bare mujoco.rollout", lambda: pool.rollout(model, data, start, control), count * steps
    )


def bare_mjx(task: str, count: int, steps: int, implementation: str = "jax") -> Contestant:
    """`mjx.step` in a loop under `vmap`."""
    from mujoco import mjx

    from hybrid_rl.envs.mujoco import mjx_warp

    body, first = _first(task, count)
    on_device, one = mjx_warp.template(body.asset, implementation, count)

    def run(qpos: jax.Array, qvel: jax.Array, ctrl: jax.Array) -> jax.Array:
        def start(qpos: jax.Array, qvel: jax.Array, ctrl: jax.Array) -> Any:
            return one.replace(qpos=qpos, qvel=qvel, ctrl=ctrl)

        def forward(_: int, data: Any) -> Any:
            return jax.vmap(mjx.step, (None, 0))(on_device, data)

        return jax.lax.fori_loop(0, steps, forward, jax.vmap(start)(qpos, qvel, ctrl)).qpos

    name = {"jax": "bare mjx.step", "warp": "bare mjx.step, Warp"}[implementation]
    with jax.numpy_rank_promotion("allow"):
        return compile_contestant(name, run, first.qpos, first.qvel, first.ctrl, work=count * steps)


def solver(task: str) -> dict[str, Any]:
    """The settings that a world of `task` and its bare loops share."""
    env: Any = world(task, "native").env
    option = env._body.model.opt
    return {
        "solver": mujoco.mjtSolver(option.solver).name,
        "iterations": int(option.iterations),
        "ls_iterations": int(option.ls_iterations),
        "integrator": mujoco.mjtIntegrator(option.integrator).name,
        "timestep": float(option.timestep),  # [s]
    }


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
        return compile_contestant("MuJoCo Playground's CheetahRun", run, state, work=work)


def brax_sac(spec: Spec, hidden: tuple[int, ...], size: int, learners: int) -> Contestant:
    """Gradient steps of Brax's soft actor-critic: its networks and losses, three Adams, a target.

    Its trainer itself does not start on jax 0.10 and later (`jax.device_put_replicated`).
    """
    from brax.training.agents.sac import losses, networks
    from brax.training.types import Transition

    nets = networks.make_sac_networks(spec.obs, spec.act, hidden_layer_sizes=hidden)
    of_alpha, of_critic, of_actor = losses.make_losses(nets, 1.0, 0.99, spec.act)
    adam, repeats = optax.adam(3e-4), 20
    batch = recalled(learners, size, spec.obs, spec.act)

    def init(key: jax.Array) -> tuple:
        policy, q = nets.policy_network.init(key), nets.q_network.init(key)
        alpha = jnp.zeros(())
        return (policy, q, alpha), q, tuple(adam.init(part) for part in (policy, q, alpha))

    def one(state: tuple, batch: Batch, key: jax.Array) -> tuple:
        no_end: Any = {"state_extras": {"truncation": batch.truncated}}
        data = Transition(
            batch.obs, batch.action, batch.reward, 1 - batch.terminated, batch.next_obs, no_end
        )

        def again(i: jax.Array, state: tuple) -> tuple:
            (policy, q, log_alpha), target, optimisers = state
            keys, alpha = jax.random.split(jax.random.fold_in(key, i), 3), jnp.exp(log_alpha)
            grads = (
                jax.grad(of_actor)(policy, None, q, alpha, data, keys[0]),
                jax.grad(of_critic)(q, policy, None, target, alpha, data, keys[1]),
                jax.grad(of_alpha)(log_alpha, policy, None, data, keys[2]),
            )
            parts, states = [], []
            for grad, optimiser, part in zip(grads, optimisers, state[0], strict=True):
                change, optimiser = adam.update(grad, optimiser, part)
                parts.append(optax.apply_updates(part, change))
                states.append(optimiser)
            target = optax.incremental_update(parts[1], target, 0.005)
            return tuple(parts), target, tuple(states)

        return jax.lax.fori_loop(0, repeats, again, state)

    with jax.numpy_rank_promotion("allow"):
        keys = jax.random.split(jax.random.key(0), learners)
        state = jax.vmap(init)(keys)
        work = repeats * learners
        return compile_contestant("Brax's SAC", jax.vmap(one), state, batch, keys, work=work)


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
    return compile_contestant("MPPI on the true model", run, start, plan, work=work)
