"""A world of one's own that is wrong: one line names its file, and what it must be."""

import jax
import pytest
from faulty import CRANE, LINE, RAIL, STATE, WORLD, changed, refused, world
from worlds import TASKS, make

from hybrid_rl.controllers.constant import ConstantController
from hybrid_rl.envs import check
from hybrid_rl.training.episode import Episode
from hybrid_rl.training.rollout import rollout_with_actions
from hybrid_rl.types import Params

PAID = "-(x**2).sum()"
METRICS = f"self._state(x, {PAID}).replace(metrics={{'speed': x[0]}})"
IF = "x = state.data if state.data[0] > 0 else -state.data"
EQUILIBRIUM = "    def equilibrium(self):\n        return jnp.zeros(2)\n\n    def step(self"
CODE = [  # of WORLD: replaced, by what, the line after "w.py:LINE: W"
    ("obs=2", "obs=4", r"\.reset: returned obs float32\[2\]; it must be float32\[4\], .* is 4"),
    (PAID, "-(x[:1] ** 2)", r"\.step: returned reward float32\[1\]; it must be float32\[\]"),
    (STATE, "EnvState(x, x, reward, 0.0, no, {}, {})", r"\.reset: returned terminated float32.*"),
    (f"self._state(x, {PAID})", METRICS, r"\.step: returned env\.metrics\['speed'\] float32.*"),
    (STATE, "EnvState(x, x, reward, no, no, {'v': x})", r"\.reset: returned metrics .* numbers"),
    (f"self._state(x, {PAID})", "x, 0.0, False, {}", r"\.step: returned a tuple of 4; it must .*"),
    ("    spec = Spec(obs=2, act=1, dt=0.05)\n", "", r": spec is None; it must be Spec\(obs=.*"),
    ("def step(self, state, action):", "def step(self, state):", r"\.step: TypeError: .*"),
    ("def reset", "def restart", r" has no reset; see protocols\.Env"),
    ("jnp.stack([", "stack([", r"\.step: NameError: name 'stack' is not defined"),
    (LINE, IF, r"\.step: TracerBoolConversionError: .*; write jnp\.where or .* of `if`"),
    (LINE, "self.gain = 2.0", r"\.step: FrozenInstanceError: .*; what changes .*"),
    ("    def step(self", EQUILIBRIUM, r"\.equilibrium: returned float32\[2\]; .* \(obs, action\)"),
    (LINE, 'raise SystemExit("no")', r"\.step: SystemExit: no; raise an error instead of .*"),
]
SIMULATED = [  # of CRANE, a world in MuJoCo, or of its model, the same
    ("act=1", "act=2", r"\.step: returned env\.data\.ctrl float32\[2\], reset gave .*"),
    ('"rail.xml"', '"rial.xml"', r"\.reset: ValueError: .*/rial\.xml: no such file"),
    ("reset(jnp.zeros(1),", "reset(jnp.zeros(2),", r"\.reset: ValueError: qpos has the shape .*"),
    ("-x[0] ** 2", 'Physics(ASSET).sensor(data, "hand")[0]', r"\.reset: KeyError: .*'hand'.*"),
    ('motor joint="', 'motor joint="un', r"\.reset: ValueError: .*Error: unknown transmission .*"),
    ('type="slide"', 'kind="slide"', r"\.reset: ValueError: .*/rail\.xml: XML Error: .*, line 3"),
]


@pytest.mark.parametrize(("old", "new", "line"), [*CODE, *SIMULATED])
def test_a_world_is_refused_in_a_line_with_its_file(folder, old, new, line):
    code = WORLD if (old, new, line) in CODE else CRANE
    assert old in code + RAIL
    made = world(folder, code.replace(old, new), RAIL.replace(old, new))
    refused(rf"w\.py:\d+: W{line}", check, made)


def test_a_world_may_keep_keys_flags_of_numpy_and_information_of_its_own(folder):
    """`info` that step leaves out stays."""
    odd = changed(WORLD, "no = jnp.zeros((), bool)", "no = np.zeros((), bool)")
    odd = changed(
        odd, "self._state(x, jnp.zeros(()))", "self._state(x, 0.0).replace(info={'goal': x})"
    )
    odd = changed(odd, LINE, "x = state.info['goal'] + jax.random.normal(KEY, (2,))")
    odd = changed(odd, "@dataclass", "KEY = jax.random.key(3)\n\n\n@dataclass")
    check(world(folder, odd))


def test_a_state_needs_no_metrics_and_no_info(folder):
    check(world(folder, changed(WORLD, STATE, "EnvState(x, x, reward, no, no)")))


@pytest.mark.parametrize("value", ["3", "0.5", "True", "x[0] > 0", "jnp.int32(3)"])
def test_a_metric_may_be_any_one_number(folder, value):
    """Also where no `vmap` makes arrays of Python's numbers, as in demonstrations."""
    state = f"EnvState(x, x, reward, no, no, {{'count': {value}}})"
    made = world(folder, changed(WORLD, STATE, state))
    check(made)
    episode, key = Episode(made, steps=3), jax.random.key(0)
    states = rollout_with_actions(episode, ConstantController(), Params(), key, 3)[1]
    assert states.metrics["count"].shape == (4,)


@pytest.mark.parametrize("task", TASKS)
def test_the_worlds_of_the_library_pass(task):
    check(make(task, "native"))
