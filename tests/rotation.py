"""Which of the long tests run: a share of them, chosen by the hash of the commit.

TURN=N in the environment chooses the share instead. `turns` in conftest.py uses it.
"""

import os
from collections.abc import Sequence
from functools import cache
from typing import TypeVar

from hybrid_rl.run.machine.provenance import git_commit

Item = TypeVar("Item")


@cache
def turn() -> int:
    """The number that chooses the share: TURN, else the commit's hash; 0 outside a checkout."""
    return int(os.environ.get("TURN") or f"0x{git_commit() or 0}", 0)


def share(items: Sequence[Item], turns: int) -> list[Item]:
    """Every `turns`-th item, from one that the commit chooses."""
    return list(items[turn() % turns :: turns])
