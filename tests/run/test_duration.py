"""The note about the time of a run, and what the command shows at its end."""

import json

import pytest
from tiny import TINY, call_train, rows_of

from hybrid_rl import config
from hybrid_rl.run import duration
from hybrid_rl.run.duration import Duration

HINT = "; settings=light takes less"


def test_the_speed_of_a_hundred_decisions_gives_the_whole_time_once():
    """Of two learners, 200 decisions at 4 a second; 8,000 to come."""
    for on_cpu, hint in ((True, HINT), (False, "")):
        made = Duration(on_cpu, "settings=light")
        assert made.after(120, 40.0, 2, 8_080, 60.0) is None
        assert made.after(80, 10.0, 2, 8_000, 70.0) == (
            "about 0:34:30 for the whole run, without the evaluations to come, "
            "by the speed of its first learning, 4.0 decisions/s" + hint
        )
        assert made.after(80, 10.0, 2, 7_920, 80.0) is None
    short = Duration(True, "settings=light").after(200, 50.0, 2, 400, 1.0)
    assert str(short).endswith("decisions/s")


@pytest.mark.parametrize(
    ("overrides", "takes_less"),
    [
        ([], "settings=light"),
        (["algo=sac"], "settings=light"),
        (["settings=light"], "a smaller total_steps"),
        (["task=pendulum", "algo=ddpg"], "settings=light"),
        (["task=pendulum", "algo=flash_sac"], "a smaller total_steps"),  # its critic has other keys
        (["task=pendulum", "algo=kle3"], "a smaller total_steps"),
    ],
)
def test_what_takes_less_is_named(overrides, takes_less):
    assert duration.instead(config.load(overrides)) == takes_less


def test_a_run_says_how_long_it_takes_and_ends_with_its_curve(monkeypatch, tmp_path, capfd):
    monkeypatch.setattr(duration, "LONG", 0.0)
    folder = tmp_path / "run"
    assert call_train(*TINY, "algo=sac", "eval_every=200", f"run_dir={folder}") == 0
    printed = capfd.readouterr().out
    estimate = printed.index("for the whole run")
    assert printed.index("compiling on") < estimate < printed.index("Evaluation return")
    assert printed.count(HINT) == 1
    assert "600 decisions\n" in printed
    assert (folder / "curve.png").stat().st_size > 1000
    rows = rows_of(folder)
    (line,) = json.loads((folder / "curve.json").read_text())["curves"]
    evaluated = {row["step"]: row["eval/return"] for row in rows if "eval/return" in row}
    assert dict(zip(line["x"], line["iqm"], strict=True)) == pytest.approx(evaluated)
