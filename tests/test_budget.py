"""Sizes of the project stay within their budgets, which are only lowered."""

import json

from scripts import measures


def test_no_measure_is_above_its_budget():
    budgets, stands = json.loads(measures.BUDGETS.read_text()), measures.measures()
    assert budgets.keys() >= {name for name in stands if not name.startswith("lines of ")}
    above = {name: (value, budgets.get(name, 0)) for name, value in stands.items()}
    above = {name: pair for name, pair in above.items() if pair[0] > pair[1]}
    assert not above  # what stands, and its budget
