"""What the tests of runs share."""

import shutil

import pytest
from states import state_at

from hybrid_rl.run.checkpoints import checkpoint


@pytest.fixture
def three(tmp_path):
    """A folder with three checkpoints, of which the newest two stay."""
    for step in (10, 20, 30):
        checkpoint.save(tmp_path, step, state_at(step), {"offset": step})
    return tmp_path


@pytest.fixture
def copied(trained, tmp_path):
    """A copy of the file's run that is done, to harm."""
    return shutil.copytree(trained, tmp_path / "run")
