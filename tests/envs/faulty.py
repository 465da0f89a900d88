"""A world of one's own, its task file and its model; the tests break one of them."""

import re
from importlib import import_module

import pytest

from hybrid_rl.errors import UsageError

WORLD = """from dataclasses import dataclass

import jax
import jax.numpy as jnp
import numpy as np

from hybrid_rl.types import EnvState, Spec


@dataclass(frozen=True)
class W:
    gain: float = 1.0
    spec = Spec(obs=2, act=1, dt=0.05)

    def reset(self, key):
        x = jax.random.uniform(key, (2,))
        return self._state(x, jnp.zeros(()))

    def step(self, state, action):
        x = jnp.stack([state.data[1], action[0]])
        return self._state(x, -(x**2).sum())

    def _state(self, x, reward):
        no = jnp.zeros((), bool)
        return EnvState(x, x, reward, no, no, {}, {})
"""
CRANE = """from dataclasses import dataclass
from pathlib import Path

import jax.numpy as jnp

from hybrid_rl.envs.mujoco.physics import Physics
from hybrid_rl.types import EnvState, Spec

ASSET = str(Path(__file__).with_name("rail.xml"))


@dataclass(frozen=True)
class W:
    physics: str = "auto"
    spec = Spec(obs=2, act=1, dt=0.05)

    def reset(self, key):
        physics = Physics(ASSET, self.physics)
        return self._state(physics.reset(jnp.zeros(1), jnp.zeros(1)))

    def step(self, state, action):
        return self._state(Physics(ASSET, self.physics).step(state.data, action, 10))

    def _state(self, data):
        x, no = jnp.concatenate([data.qpos, data.qvel]), jnp.zeros((), bool)
        return EnvState(data, x, -x[0] ** 2, no, no, {}, {})
"""
RAIL = """<mujoco>
  <option timestep="0.005"><flag autoreset="disable"/></option>
  <worldbody><body><joint name="rail" type="slide"/><geom size="0.1"/></body></worldbody>
  <actuator><motor joint="rail"/></actuator>
</mujoco>
"""
TASK = """# @package _global_
# A broken world.
task: broken
env: {_target_: w.W, gain: 2.0}
episode: {steps: 20, action_repeat: 1}
random_steps: 10
total_steps: 50
eval_every: 50
eval_episodes: 1
checkpoint_every: 50
"""
STATE = "EnvState(x, x, reward, no, no, {}, {})"
LINE = "x = jnp.stack([state.data[1], action[0]])"  # of step


def world(folder, code, model=RAIL):
    """An instance of the class in w.py."""
    (folder / "w.py").write_text(code)
    (folder / "rail.xml").write_text(model)
    return import_module("w").W()


def changed(text, old, new):
    assert old in text
    return text.replace(old, new)


def refused(line, check, *arguments):
    with pytest.raises(UsageError) as refusal:
        check(*arguments)
    assert re.fullmatch(line, str(refusal.value)), str(refusal.value)


def write(folder, code=WORLD, task=TASK):
    """A world and its task file."""
    (folder / "w.py").write_text(code)
    (folder / "my_conf" / "task" / "broken.yaml").write_text(task)
