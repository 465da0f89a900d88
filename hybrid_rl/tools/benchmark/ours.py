"""What this library does, as contestants: worlds, planners, updates, whole loops.

Every program is compiled before it is timed, and ends with a wait for its result.
"""

from collections.abc import Callable
from dataclasses import replace
from time import perf_counter
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

from hybrid_rl import Agent, Episode, Loop, build, compose
from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.tools.benchmark.products import alone as products_alone
from hybrid_rl.tools.benchmark.products import operations, products
from hybrid_rl.tools.benchmark.race import Contestant
from hybrid_rl.types import Batch, EnvState, Params

TRIED = 5  # decisions that say how long one takes
MOST = 2000  # decisions of each learner in a turn
LEARNING = 200_000  # decisions into a run, where every part is at work


def loop(
    name: str, agent: Agent, learners: int, decisions: int, seconds: float | None = None
) -> tuple[Contestant, float]:
    """`decisions` of each of `learners` in training; and the [s] that compiling took.

    seconds: as many decisions, at most, as take that long.
    """
    made = Loop(agent, tuple(range(learners)), decisions)
    state = made.init()
    began = perf_counter()
    program, compile_s = made.compile(state), perf_counter() - began
    held = [state]
    start = jnp.int32(LEARNING)

    def advance(rounds: int) -> None:
        held[0], _ = program(held[0], start, jnp.int32(rounds))
        jax.block_until_ready(held[0])

    if seconds is not None:
        advance(1)
        began = perf_counter()
        advance(TRIED)
        each = (perf_counter() - began) / TRIED
        decisions = min(max(round(seconds / each), 1), decisions)
    memory = made.memory(program) * made.mesh.size / learners
    contestant = Contestant(name, lambda: advance(decisions), learners * decisions, memory)
    return contestant, compile_s


def shares(agent: Agent, learners: int, seconds: float) -> tuple[list[Contestant], dict[str, int]]:
    """The loop whole and with parts left out, the products of each alone; their operations.

    The world alone comes second, and is in each of the parts after it. Operations are those of the
    matrix products in a decision of one learner.
    """
    names = tuple(agent.learners)  # those that make no updates still give their parameters
    still = replace(agent, controller=ConstantController(0.5), frozen=names)
    parts = {"whole loop": agent, "world and memory": still}
    for name in names:
        others = tuple(other for other in names if other != name)
        parts[f"world and {name} learner"] = replace(still, frozen=others)
    parts["world and controller"] = replace(agent, frozen=names)
    loops, alone, counts = [], [], {}
    for name, part in parts.items():
        loops.append(loop(name, part, learners, MOST, seconds)[0])
        one = jax.eval_shape(part.init, jax.random.key(0))
        found = products(part.step, one, jnp.int32(LEARNING))
        counts[name] = operations(found)
        if found:
            alone.append(products_alone(f"{name}, products alone", found, learners))
    return loops + alone, counts


def world(task: str, physics: str) -> Episode:
    """The world of a task, in episodes."""
    return build(compose([f"task={task}", f"physics={physics}"])).agent.episode


def beginning(task: str, physics: str, count: int) -> tuple[Episode, EnvState, Array]:
    """A task, `count` first states and an action [count, m] for each."""
    episode = world(task, physics)
    keys = jax.random.split(jax.random.key(0), count)
    u = jax.random.uniform(jax.random.key(1), (count, episode.spec.act), minval=-1, maxval=1)
    return episode, jax.jit(jax.vmap(episode.reset))(keys), u


def worlds(task: str, physics: str, count: int, decisions: int) -> Contestant:
    """`decisions` in each of `count` worlds: reward, end and reset included; physics steps."""
    episode, state, u = beginning(task, physics, count)
    env: Any = episode.env
    steps = round(env.spec.dt / env._body.model.opt.timestep) * episode.action_repeat
    keys = jax.random.split(jax.random.key(2), count)

    def forward(_: int, state: EnvState) -> EnvState:
        now = jax.vmap(episode.step)(state, u)
        return jax.vmap(episode.auto_reset)(now, keys)

    def run(state: EnvState) -> EnvState:
        return jax.lax.fori_loop(0, decisions, forward, state)

    return compile_contestant(f"ours, {physics}", run, state, work=count * decisions * steps)


def decisions(name: str, agent: Agent, learners: int, each: float = 1.0) -> Contestant:
    """What `learners` controllers do in a decision, side by side, each of them `each` units."""
    controller: Any = agent.controller
    state = Loop(agent, tuple(range(learners)), 1).init()
    params = jax.vmap(agent.params)(state)._replace(decisions=jnp.full(learners, LEARNING))
    rest = jax.vmap(lambda _: controller.init(agent.spec))(jnp.arange(learners))
    keys = jax.random.split(jax.random.key(0), learners)
    repeats = 10

    def run(params: Params, rest: Any, obs: Array, keys: Array) -> Any:
        def again(i: Array, held: tuple) -> tuple:  # each sees something new: none is left out
            control, total = held
            now = jax.vmap(jax.random.fold_in, (0, None))(keys, i)
            moved = obs + 1e-3 * i.astype(obs.dtype)
            u, control, _metrics = jax.vmap(controller.act)(params, control, moved, now)
            return control, total + u

        first = (rest, jnp.zeros((learners, agent.spec.act)))
        return jax.lax.fori_loop(0, repeats, again, first)

    given = (params, rest, state.env.obs[:, 0], keys)
    return compile_contestant(name, run, *given, work=repeats * learners * each)


def updates(name: str, agent: Agent, which: str, learners: int) -> Contestant:
    """Gradient steps of one of the agent's learners, for many agents side by side."""
    learner, o, m, repeats = agent.learners[which], agent.seen.obs, agent.spec.act, 20
    state = Loop(agent, tuple(range(learners)), 1).init()
    batch = recalled(learners, learner.batches * learner.batch_size, o, m)
    keys = jax.random.split(jax.random.key(0), learners)

    def one(state: Any, params: Params, batch: Batch, key: Array) -> Any:
        def again(i: Array, state: Any) -> Any:
            return learner.update(state, params, batch, jax.random.fold_in(key, i))[0]

        return jax.lax.fori_loop(0, repeats, again, state)

    given = (state.learners[which], jax.vmap(agent.params)(state), batch, keys)
    return compile_contestant(name, jax.vmap(one), *given, work=repeats * learners)


def recalled(learners: int, size: int, obs: int, act: int) -> Batch:
    """A batch [learners, size, ...] of noise, in which no episode ends."""
    of_x, of_u, of_r = jax.random.split(jax.random.key(0), 3)
    x, after = jax.random.normal(of_x, (2, learners, size, obs))
    u, next_u = jax.random.uniform(of_u, (2, learners, size, act), minval=-1, maxval=1)
    none = jnp.zeros((learners, size))
    return Batch(x, u, jax.random.normal(of_r, none.shape), none, none, after, next_u)


def compile_contestant(name: str, run: Callable[..., Any], *given: Any, work: float) -> Contestant:
    """`run(*given)`, compiled."""
    program = jax.jit(run).lower(*given).compile()
    return Contestant(name, lambda: jax.block_until_ready(program(*given)), work)


def product(size: int = 2048) -> Contestant:
    """A product of two square float32 matrices, which is what the chip can do; operations."""
    a = jnp.ones((size, size))
    return compile_contestant("matrix product", lambda a: a @ a, a, work=2.0 * size**3)
