"""The note about a long run, and what the command shows at its end."""

import json

import pytest
from tiny import TINY, call_train, rows_of

from hybrid_rl import config
from hybrid_rl.run import launch, session

HINT = " left; settings=light takes less"


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
    assert launch.shorter_by(config.load(overrides)) == takes_less


def test_a_long_run_says_what_takes_less_and_ends_with_its_curve(monkeypatch, tmp_path, capfd):
    monkeypatch.setattr(session, "LONG", 0.0)
    folder = tmp_path / "run"
    assert call_train(*TINY, "algo=sac", "eval_every=200", f"run_dir={folder}") == 0
    printed = capfd.readouterr().out
    estimate = printed.index(HINT)
    assert printed.index("compiling on") < estimate < printed.index("Evaluation return")
    assert printed.count(HINT) == 1
    assert "600 decisions\n" in printed
    assert (folder / "curve.png").stat().st_size > 1000
    rows = rows_of(folder)
    (line,) = json.loads((folder / "curve.json").read_text())["curves"]
    evaluated = {row["step"]: row["eval/return"] for row in rows if "eval/return" in row}
    assert dict(zip(line["x"], line["iqm"], strict=True)) == pytest.approx(evaluated)


@pytest.mark.parametrize(
    ("given", "lines"),
    [
        ("random_steps=200", ["policy learns nothing in total_steps=100: it begins after 257"]),
        ("random_steps=0", ["policy learns nothing in total_steps=100: it begins after 257"]),
        ("random_steps=0 freeze=[policy]", []),
        ("random_steps=50 policy_learner.batch_size=40", []),
        ("random_steps=100 policy_learner.batch_size=40", ["it begins after 100 decisions"]),
    ],
)
def test_a_learner_that_begins_after_the_last_decision_is_named(given, lines):
    run = config.build(
        config.load(["task=pendulum", "algo=sac", "total_steps=100", *given.split()])
    )
    named = launch._idle(run)
    assert len(named) == len(lines)
    assert all(words in line for words, line in zip(lines, named, strict=True))
