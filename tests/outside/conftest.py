"""What the tests of a robot's processes share."""

import pytest
from counting import LINE

from hybrid_rl.settings import build as config


@pytest.fixture(scope="module")
def agent():
    """Soft actor-critic of small parts."""
    return config.build(config.load(LINE)).agent
