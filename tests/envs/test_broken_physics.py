"""A world of one's own in MuJoCo that is wrong: one line names its file, and what it must be."""

import pytest
from faulty import CRANE, RAIL, changed, refused, world

from hybrid_rl.envs import check

SIMULATED = [  # the same of a world in MuJoCo; None: of its model
    (
        "two actions for one actuator",
        "act=1",
        "act=2",
        r"w\.py:21: W\.step: returned env\.data\.ctrl float32\[2\], reset gave .*",
    ),
    (
        "no such file",
        '"rail.xml"',
        '"rial.xml"',
        r"w\.py:\d+: W\.reset: ValueError: .*/rial\.xml: no such file",
    ),
    (
        "two joints of one",
        "reset(jnp.zeros(1),",
        "reset(jnp.zeros(2),",
        r"w\.py:19: W\.reset: ValueError: qpos has the shape \(2,\); the model's has \(1,\)",
    ),
    (
        "an unknown sensor",
        "-x[0] ** 2",
        'Physics(ASSET).sensor(data, "hand")[0]',
        r"""w\.py:26: W\.reset: KeyError: "Invalid name 'hand'\. Valid names: \[\]\"""",
    ),
    (
        "a motor of a joint that is not there",
        None,
        ('<motor joint="', '<motor joint="un'),
        r"w\.py:19: W\.reset: ValueError: .*/rail\.xml: Error: unknown transmission target 'un.*",
    ),
    (
        "a model that is no MJCF",
        None,
        ('type="slide"', 'kind="slide"'),
        r"w\.py:19: W\.reset: ValueError: .*/rail\.xml: XML Error: .*, line 3",
    ),
]


@pytest.mark.parametrize(
    ("old", "new", "line"), [c[1:] for c in SIMULATED], ids=[c[0] for c in SIMULATED]
)
def test_a_world_in_mujoco_is_refused_in_a_line_with_its_file(folder, old, new, line):
    code, model = (CRANE, changed(RAIL, *new)) if old is None else (changed(CRANE, old, new), RAIL)
    refused(line, check, world(folder, code, model))
