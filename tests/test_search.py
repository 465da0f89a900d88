"""The search with Optuna that a how-to writes down."""

import re
from pathlib import Path

import hybrid_rl as hr

PAGE = Path(__file__).resolve().parents[1] / "docs/howto_train.md"


def test_the_search_finds_the_best_value_and_ends_poor_runs(tmp_path, monkeypatch):
    """Runs whose returns grow towards a value that depends on the discount; then it goes on."""
    ended = []

    def train(words, on_row):
        peak = 1.0 if "policy_learner.discount=0.99" in words else 0.0
        for step in (1000, 2000, 3000):
            rows = [{"step": step, "seed": s, "eval/return": peak + s + step} for s in range(3)]
            if not all(map(on_row, [*rows, {"step": step, "sac/entropy": 0.0}])):
                ended.append(words)
                return {"finished": False}
        return {"finished": True, "final_eval": [peak, peak + 1.0, peak + 2.0]}

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(hr, "train", train, raising=False)
    (code,) = re.findall(r"## Search.*?```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    for count in (20, 40):
        names = {}
        exec(code, names)
        assert len(names["study"].trials) == count
    assert names["study"].best_params["discount"] == 0.99
    assert names["study"].best_value == 2.0
    assert ended
    assert not any("policy_learner.discount=0.99" in words for words in ended)
