"""The curve that the command shows at the end of a run."""

import json

import pytest
from tiny import TINY, call_train, rows_of


def test_a_run_ends_with_its_curve(tmp_path, capfd):
    folder = tmp_path / "run"
    assert call_train(*TINY, "algo=sac", "eval_every=200", f"run_dir={folder}") == 0
    printed = capfd.readouterr().out
    assert printed.index("compiling on") < printed.index("Evaluation return")
    assert "600 decisions\n" in printed
    assert (folder / "curve.png").stat().st_size > 1000
    rows = rows_of(folder)
    (line,) = json.loads((folder / "curve.json").read_text())["curves"]
    evaluated = {row["step"]: row["eval/return"] for row in rows if "eval/return" in row}
    assert dict(zip(line["x"], line["iqm"], strict=True)) == pytest.approx(evaluated)
