"""Which of the long tests a commit runs: a share of them, by its hash.

TURN=N in the environment chooses a share instead. See `turns` in conftest.py, too.
"""

import os
from collections.abc import Sequence
from functools import cache
from typing import TypeVar

from hybrid_rl.run.provenance import git_commit

Item = TypeVar("Item")


@cache
def turn() -> int:
    """The number of the share: the hash of the commit; outside a checkout 0."""
    return int(os.environ.get("TURN") or f"0x{git_commit() or 0}", 0)


def share(items: Sequence[Item], turns: int) -> list[Item]:
    """Every `turns`-th item, from one that the commit chooses."""
    return list(items[turn() % turns :: turns])
