"""Trained policies and their worlds as JavaScript, for the robots on the site's first page.

Each robot is a policy of policies/ with the world and the episode that its file describes:

    window.ROBOTS.halfcheetah = {
      models: {physics, scene},           MJCF
      step(s, u, physics), pose(s),       of the world, as JavaScript
      commands: {name: most},             of a robot that is told what to do
      tell(s, o, c),                      state and observation with the command c
      repeat, dt, limit, ...              of the episode
      policy: {sizes, weights, ...},      a multilayer perceptron, as `export` has it
      starts: [{s, o}, ...]}              first states of episodes

s: the leaves of the world's state, one after the other. Nothing here is typed a second time:
models, steps per decision, scaling of actions, observations and rewards are the environment's.
"""

import base64
import json
import re
from functools import cache
from pathlib import Path
from typing import Any

import jax
import numpy as np
from jax import Array

from hybrid_rl.envs.mujoco import mjcf
from hybrid_rl.envs.mujoco.scenery import pose_of
from hybrid_rl.networks import Perceptron
from hybrid_rl.run import saved as trained
from hybrid_rl.run.exported import layers
from hybrid_rl.training.episode import Episode
from hybrid_rl.types import EnvState
from scripts.browser.javascript import Program

NAMES = {  # policy -> how the page calls it; the first one is shown first
    "halfcheetah": "Half-cheetah",
    "humanoid": "Humanoid",
    "ant": "Ant",
    "hopper": "Hopper",
    "walker2d": "Walker",
    "cartpole": "Cartpole",
    "pendulum": "Pendulum",
    "quadcopter": "Quadcopter",
    "lander": "Lander",
}
STARTS = 16  # first states per robot
read = cache(trained.read)  # name -> a policy with its world
STEP = """(s, a, physics) => {{
  {lines}
  return {{ s: [{s}], o: [{o}], reward: {reward}, ended: {ended} }};
}}"""


def write(out: Path) -> None:
    """Write `out`, a script that sets window.ROBOTS."""
    robots = ",\n".join(f'"{name}": {robot(name)}' for name in NAMES)
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(f"window.ROBOTS = {{\n{robots}\n}};\n", encoding="utf-8")


def robot(name: str) -> str:
    """The policy `name` with its world, as an object of JavaScript."""
    policy = read(name)
    episode = policy.episode
    env: Any = episode.env
    plain = Episode(env, episode.steps, episode.action_repeat)
    if episode != plain:
        raise ValueError(
            f"{name}: delays, noise, other rewards and constraints are not on the page"
        )
    first = jax.jit(jax.vmap(env.reset))(keys())
    like = jax.tree.map(lambda leaf: leaf[0], first)
    try:
        program, step = _step(env, like)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from error
    if len(program.assets) > 1:
        raise ValueError(f"{name}: has several models, {', '.join(program.assets)}")
    (physics,) = [_plain(name, asset) for asset in program.assets] or [None]
    values = {
        "title": NAMES[name],
        "models": {"physics": physics, "scene": env.scene() if hasattr(env, "scene") else physics},
        "repeat": episode.action_repeat,
        "dt": env.spec.dt,  # [s] of a step
        "limit": episode.steps,  # decisions
        "travels": "speed" in like.metrics,
        "policy": network(layers(episode.spec, *policy.learner(mode="policy"))),
        "starts": [_start(first, i) for i in range(STARTS)],
    }
    functions = {"step": step, "pose": _pose(env, like)}
    if commands := getattr(env, "commands", None):
        values["commands"], functions["tell"] = commands, _tell(env, like, len(commands))
    lines = ",\n".join(f'"{each}": {text}' for each, text in functions.items())
    return f"{json.dumps(values)[:-1]},\n{lines}\n}}"


def keys() -> Array:
    """Keys [STARTS] of the episodes that the page runs: it begins where `Episode.reset` does."""
    return jax.random.split(jax.random.key(0), STARTS)


def network(net: Perceptron) -> dict[str, Any]:
    """The network as JSON; weights: float32 of W_1 [n, m] row by row, b_1, W_2, ... in base64."""
    parts = [part for layer in zip(net.weights, net.biases, strict=True) for part in layer]
    flat = np.concatenate([np.ravel(part) for part in parts]).astype("<f4")
    return {
        "mean": np.asarray(net.mean, float).tolist(),
        "scale": np.asarray(net.scale, float).tolist(),
        "sizes": [len(net.mean), *(len(bias) for bias in net.biases)],
        "activation": net.activation,
        "squash": net.squash,
        "weights": base64.b64encode(flat.tobytes()).decode(),
    }


def _step(env: Any, like: EnvState) -> tuple[Program, str]:
    """One step of the world as a function of JavaScript."""

    def step(state: tuple[Any, Any], action: Array) -> tuple[Any, ...]:
        after = env.step(like.replace(data=state[0], info=state[1]), action)
        return (after.data, after.info), after.obs, after.reward, after.terminated

    program = Program()
    state, obs, reward, ended = program.function(
        step, ("s", "a"), ((like.data, like.info), np.zeros(env.spec.act, np.float32))
    )
    text = STEP.format(
        lines="\n  ".join(program.lines),
        s=_joined(state),
        o=_joined(obs),
        reward=_joined(reward),
        ended=_joined(ended),
    )
    return program, text


def _pose(env: Any, like: EnvState) -> str:
    """Positions qpos of the scene at a state, as a function of JavaScript."""

    def pose(state: tuple[Any, Any]) -> Array:
        return pose_of(env)(like.replace(data=state[0], info=state[1]))

    program = Program()
    qpos = program.function(pose, ("s",), ((like.data, like.info),))
    return f"(s) => {{ {' '.join(program.lines)} return [{_joined(qpos)}]; }}"


def _tell(env: Any, like: EnvState, size: int) -> str:
    """State and observation with a command [size], as a function of JavaScript."""

    def tell(state: tuple[Any, Any], obs: Array, command: Array) -> tuple[Any, ...]:
        told = env.commanded(like.replace(data=state[0], info=state[1], obs=obs), command)
        return (told.data, told.info), told.obs

    program, command = Program(), np.zeros(size, np.float32)
    given = (like.data, like.info), like.obs, command
    state, obs = program.function(tell, ("s", "o", "c"), given)
    lines = " ".join(program.lines)
    return f"(s, o, c) => {{ {lines} return {{ s: [{_joined(state)}], o: [{_joined(obs)}] }}; }}"


def _joined(tree: Any) -> str:
    """All expressions, separated by commas."""
    return ", ".join(word for leaf in jax.tree.leaves(tree) for word in np.ravel(leaf))


def _start(first: EnvState, i: int) -> dict[str, list[float]]:
    """State and observation of the first state `i`."""
    leaves = [np.ravel(leaf[i]).astype(float) for leaf in jax.tree.leaves((first.data, first.info))]
    return {"s": np.concatenate(leaves).tolist(), "o": np.asarray(first.obs[i], float).tolist()}


def _plain(name: str, asset: str) -> str:
    """The MJCF of a world's model, which must be the one that its file describes."""
    if "?" in asset:
        raise ValueError(
            f"{name}: {asset} is changed after it is compiled; the page cannot do this"
        )
    plain = mjcf.text(asset).replace(' input="pos"', "")  # of a servo, new to the page's MuJoCo
    return re.sub(r"<!--.*?-->\s*", "", plain, flags=re.DOTALL)
