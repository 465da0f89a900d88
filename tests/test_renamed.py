"""Names of version 0.2: whoever types one reads the present one."""

from pathlib import Path

import pytest
from tiny import call_train, only_line

from hybrid_rl import config, renamed
from hybrid_rl.errors import UsageError

PAGE = (Path(__file__).parents[1] / "docs" / "renamed.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("old", renamed.RENAMED)
def test_an_old_key_is_refused_with_its_new_name(old):
    """With and without a value; the page has it."""
    with pytest.raises(UsageError) as error:
        config.load([old if "=" in old else f"{old}=1"])
    assert renamed.RENAMED[old] in str(error.value)
    assert "\n" not in str(error.value)
    assert old in PAGE


def test_a_key_below_an_old_one_keeps_its_end(capfd):
    assert call_train("task=pendulum", "mbpo.learner.updates=3") == 2
    line = only_line(capfd)
    assert "mbpo.learner.updates=3: since 0.3 it is policy_learner.updates" in line


def test_a_key_that_only_begins_like_an_old_one_passes():
    renamed.check(["policy_learner.expander=1", "settings=mbpox", "learning=mbpo", "mbpo.steps=3"])


def test_a_value_among_several_is_found():
    with pytest.raises(UsageError, match=r"since 0\.3 settings=mbpo is learning=mbpo"):
        renamed.check(["settings=light,mbpo"])
