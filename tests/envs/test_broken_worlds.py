"""A world of one's own that is wrong: one line names its file, and what it must be."""

import jax
import pytest
from faulty import LINE, STATE, WORLD, changed, refused, world
from worlds import TASKS, make

from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.envs import check
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Params

CODE = [  # of the world: what is wrong, replaced, by what, the whole line
    (
        "reward not a number",
        "-(x**2).sum()",
        "jnp.nan * x.sum()",
        r"w\.py:19: W\.step: reward is nan at decision 1, after obs \[0\..*\] and action \[.*\]",
    ),
    (
        "obs smaller than the spec",
        "obs=2",
        "obs=4",
        r"w\.py:15: W\.reset: returned obs float32\[2\]; it must be float32\[4\], as .* is 4",
    ),
    (
        "reward with an axis",
        "-(x**2).sum()",
        "-(x[:1] ** 2)",
        r"w\.py:19: W\.step: returned reward float32\[1\]; it must be float32\[\]",
    ),
    (
        "terminated a number",
        STATE,
        "EnvState(x, x, reward, 0.0, no, {}, {})",
        r"w\.py:15: W\.reset: returned terminated float32\[\]; it must be bool\[\]",
    ),
    (
        "another dtype in reset",
        "self._state(x, jnp.zeros(()))",
        "self._state(x, jnp.zeros(())).replace(data=jnp.zeros(2, int))",
        r"w\.py:19: W\.step: returned env\.data float32\[2\], reset gave int32\[2\]; both .*",
    ),
    (
        "a list in reset, a tuple in step",
        "self._state(x, jnp.zeros(()))",
        "self._state(x, jnp.zeros(())).replace(data=[x[0], x[1]])",
        r"w\.py:19: W\.step: returned .*",
    ),
    (
        "metrics in step alone",
        "self._state(x, -(x**2).sum())",
        "self._state(x, -(x**2).sum()).replace(metrics={'speed': x[0]})",
        r"w\.py:19: W\.step: returned env\.metrics\['speed'\] float32\[\], reset gave nothing; "
        r"both must be equal",
    ),
    (
        "a metric that is a vector",
        STATE,
        "EnvState(x, x, reward, no, no, {'speed': x})",
        r"w\.py:15: W\.reset: returned metrics .*speed.*float32\[2\].*; it must be .* numbers",
    ),
    (
        "step returns a tuple",
        "return self._state(x, -(x**2).sum())",
        "return x, 0.0, False, False, {}",
        r"w\.py:19: W\.step: returned a tuple of 5; it must be an EnvState",
    ),
    (
        "no spec",
        "    spec = Spec(obs=2, act=1, dt=0.05)\n",
        "",
        r"w\.py:10: W: spec is None; it must be Spec\(obs=\.\.\., act=\.\.\., dt=\.\.\.\), .*",
    ),
    (
        "step without an action",
        "def step(self, state, action):",
        "def step(self, state):",
        r"w\.py:19: W\.step: must be step\(self, state, action\)",
    ),
    (
        "no reset",
        "def reset",
        "def restart",
        r"w\.py:10: W has no reset; write def reset\(self, key\)",
    ),
    (
        "raise in reset",
        "x = jax.random.uniform(key, (2,))",
        'raise ValueError("my table is empty")',
        r"w\.py:16: W\.reset: ValueError: my table is empty",
    ),
    (
        "an if on a traced value",
        LINE,
        "x = state.data if state.data[0] > 0 else -state.data",
        r"w\.py:20: W\.step: TracerBoolConversionError: .*; write jnp\.where or .* of `if`",
    ),
    (
        "an attribute that changes",
        LINE,
        "self.gain = 2.0",
        r"w\.py:20: W\.step: FrozenInstanceError: cannot assign to field 'gain'; what changes .*",
    ),
    (
        "a random number of NumPy",
        LINE,
        "x = state.data + np.random.normal(size=2).astype(np.float32)",
        r"w\.py:19: W\.step: gives other numbers when it is traced again: what NumPy .*",
    ),
    (
        "an index out of range",
        "state.data[1], action[0]",
        "state.data[1], action[1]",
        r"w\.py:19: W\.step: IndexError: .* index 1 is out of bounds .* size 1; JAX takes the .*",
    ),
    (
        "an index out of range in reset",
        "x = jax.random.uniform(key, (2,))",
        "x = jax.random.uniform(key, (2,)); x = x.at[2].set(1.0)",
        r"w\.py:15: W\.reset: IndexError: .* index 2 is out of bounds .* size 2; JAX takes .*",
    ),
    (
        "an equilibrium without its action",
        "    def step(self",
        "    def equilibrium(self):\n        return jnp.zeros(2)\n\n    def step(self",
        r"w\.py:19: W\.equilibrium: returned float32\[2\]; it must be \(obs, action\)",
    ),
    (
        "an end of the process",
        LINE,
        'raise SystemExit("no licence")',
        r"w\.py:20: W\.step: SystemExit: no licence; raise an error instead of sys\.exit\(\)",
    ),
]


@pytest.mark.parametrize(("old", "new", "line"), [c[1:] for c in CODE], ids=[c[0] for c in CODE])
def test_a_world_is_refused_in_a_line_with_its_file(folder, old, new, line):
    refused(line, check, world(folder, changed(WORLD, old, new)))


def test_a_world_may_keep_keys_flags_of_numpy_and_information_of_its_own(folder):
    """`info` that step leaves out stays."""
    odd = changed(WORLD, "no = jnp.zeros((), bool)", "no = np.zeros((), bool)")
    odd = changed(
        odd, "self._state(x, jnp.zeros(()))", "self._state(x, 0.0).replace(info={'goal': x})"
    )
    odd = changed(odd, LINE, "x = state.info['goal'] + jax.random.normal(KEY, (2,))")
    odd = changed(odd, "@dataclass", "KEY = jax.random.key(3)\n\n\n@dataclass")
    assert check(world(folder, odd)) == ()


def test_an_index_that_follows_from_the_state_may_be_clamped(folder):
    """Of a table that is entered at [50 x + 3], x in [0, 1], and has 3 entries."""
    table = "jnp.arange(3.0)[jnp.int32(50 * state.data[1]) + 3], action[0]"
    assert check(world(folder, changed(WORLD, "state.data[1], action[0]", table))) == ()


def test_a_state_needs_no_metrics_and_no_info(folder):
    assert check(world(folder, changed(WORLD, STATE, "EnvState(x, x, reward, no, no)"))) == ()


@pytest.mark.parametrize("value", ["3", "0.5", "True", "x[0] > 0", "jnp.int32(3)"])
def test_a_metric_may_be_any_one_number(folder, value):
    """Also where no `vmap` makes arrays of Python's numbers, as in demonstrations."""
    state = f"EnvState(x, x, reward, no, no, {{'count': {value}}})"
    made = world(folder, changed(WORLD, STATE, state))
    assert check(made) == ()
    episode, key = Episode(made, steps=3), jax.random.key(0)
    states = rollout_with_actions(episode, ConstantController(), Params(), key, 3)[1]
    assert states.metrics["count"].shape == (4,)


@pytest.mark.parametrize("task", TASKS)
def test_the_worlds_of_the_library_pass(task):
    """Their numbers are tested in test_worlds.py."""
    assert check(make(task, "native"), decisions=0) == ()
