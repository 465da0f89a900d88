"""The sources of the documentation site: every method has a section, the core alone plans."""

import re
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]


def test_every_method_has_one_section():
    """From which scripts/docs.py makes the method's page."""
    page = (ROOT / "docs" / "methods.md").read_text(encoding="utf-8")
    names = [
        name for line in re.findall(r"^### (.+)$", page, re.MULTILINE) for name in line.split(", ")
    ]
    assert sorted(names) == sorted(path.stem for path in (ROOT / "conf" / "algo").glob("*.yaml"))


def test_the_page_of_concepts_plans_with_the_adjoint_core():
    """Its example, against the least-squares solution of the same problem."""
    page = (ROOT / "docs" / "concepts.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    names = {}
    exec(code, names)
    horizon, dt = len(names["plan"]), 0.1
    effect = np.zeros((horizon + 1, 2, horizon))  # of each action on each state
    for t in range(horizon):
        effect[t + 1] = effect[t] + dt * np.array([effect[t, 1], np.eye(horizon)[t]])
    rows = np.concatenate([effect.reshape(-1, horizon), np.sqrt(0.1) * np.eye(horizon)])
    aims = np.concatenate([np.tile([1.0, 0.0], horizon + 1), np.zeros(horizon)])
    _, [least], *_ = np.linalg.lstsq(rows, aims, rcond=None)
    np.testing.assert_allclose(-names["J"](names["path"]), least, rtol=0.01)
