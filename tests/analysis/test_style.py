"""The style of pictures: colours, dashes, words, legends; and pictures from their JSON."""

import json
from pathlib import Path

import matplotlib
import numpy as np
import pytest

from hybrid_rl.analysis.results import redrawn
from hybrid_rl.analysis.style import (
    COLOURS,
    METHODS,
    STROKES,
    STYLE,
    VERMILION,
    beginning,
    colours,
    line_styles,
    words,
)
from hybrid_rl.figures import study_of

RESULTS = Path(__file__).parents[2] / "docs" / "results"
REDRAWN = [  # a study, and a JSON file from which it draws
    ("contact_maps", "fig_5_4_filters"),
    ("held_out", "exploration_model"),
    ("imitation", "fig_6_9"),
    ("koopman", "fig_7_3"),
    ("learning_curves", "walker_faster"),
]


def label_sets():
    """The labels of each picture that is in the documentation."""
    for file in sorted(RESULTS.glob("*.json")):
        numbers = json.loads(file.read_text())
        if isinstance(numbers, dict):
            parts = [numbers.get(key) for key in ("methods", "rows", "runs", "two_link")]
            yield [curve["label"] for curve in numbers.get("curves", ())]
            yield from (list(part) for part in parts if isinstance(part, dict))


def shown_by(styles, *names):
    return [tuple(str(style[name]) for name in names) for style in styles.values()]


def test_no_two_lines_of_a_picture_share_colour_and_dashes():
    """For the labels of all results, for all methods at once, and for any others."""
    rng = np.random.default_rng(0)
    known = [*METHODS, *(f"{name} {key}=1" for name in METHODS for key in "ab")]
    some = [list(rng.choice(known, count, replace=False)) for count in range(1, 55)]
    others = [[f"label {i}" for i in range(count)] for count in range(1, 55)]
    each = [*label_sets(), *some, *others]
    assert len(each) > 200
    for labels in each:
        shown = shown_by(line_styles(labels), "color", "linestyle")
        assert len(set(shown)) == len(set(labels)), labels
    many = [f"label {i}" for i in range(2 * len(COLOURS) * len(STROKES))]
    assert len(set(shown_by(line_styles(many), "color", "linestyle", "marker"))) == len(many)


def test_a_method_has_one_colour_in_every_picture():
    """Also as a setting; of several whose colour is one, the first of METHODS has it."""
    for labels in label_sets():
        own = {beginning(label, METHODS): colour for label, colour in colours(labels).items()}
        first = {METHODS[name]: name for name in reversed(METHODS) if name in own}
        assert {own[name]: name for name in first.values()} == first, labels
    styles = line_styles(["hybrid_stochastic tau=1", "sac", "hybrid_stochastic"])
    assert styles["hybrid_stochastic"]["linestyle"] == "-"
    assert styles["hybrid_stochastic tau=1"]["color"] == VERMILION
    assert styles["hybrid_stochastic tau=1"]["linestyle"] == "--"


def test_methods_have_whole_lines_of_their_own_colours_while_there_are_colours():
    every = [name for name in METHODS if " " not in name]
    for seed in range(50):
        some = list(np.random.default_rng(seed).choice(every, len(COLOURS), replace=False))
        assert {*shown_by(line_styles(some), "color", "linestyle")} == {(c, "-") for c in COLOURS}


@pytest.mark.parametrize(
    ("label", "shown"),
    [
        (
            "koopman_active deviation=0.316 prior=1e-06",
            "koopman_active, deviation 0.316, prior 1e-6",
        ),
        ("z15_gain_frozen", "z 15, information gain, K frozen"),
        ("bc, experiment=robots/ant", "bc, experiment robots/ant"),
        ("num_demonstrations=5", "num demonstrations 5"),
        ("my_method", "my_method"),
        ("algo=sac settings=quick", "algo=sac settings=quick"),
        ("sac", "sac"),
    ],
)
def test_labels_are_words(label, shown):
    assert words(label) == shown


@pytest.mark.parametrize(("study", "name"), REDRAWN)
def test_a_picture_is_drawn_again_from_its_json(study, name):
    """In it no two named lines have the same style, and no text is smaller than 7 pixels at 700."""
    with matplotlib.rc_context(STYLE):
        figure, numbers = redrawn(RESULTS / f"{name}.json", "from", study_of(study).draw)
    assert numbers == json.loads((RESULTS / f"{name}.json").read_text())
    assert 8 / 72 * 700 / figure.get_figwidth() >= 7
    for axes in figure.axes:
        named = [line for line in axes.lines if not line.get_label().startswith("_")]
        shown = [
            (str(x.get_color()), str(x._dash_pattern), x.get_marker(), str(x.get_mfc()))
            for x in named
        ]
        assert len(set(shown)) == len(shown)
