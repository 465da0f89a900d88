"""Which of the long checks a commit runs: a share of them, by its hash.

TURN=N in the environment chooses a share instead.
"""

import os
from collections.abc import Sequence
from typing import TypeVar

from hybrid_rl.run.provenance import git_commit

Item = TypeVar("Item")


def share(items: Sequence[Item], turns: int) -> list[Item]:
    """Every `turns`-th item, from one that the commit chooses; outside a checkout the first."""
    turn = os.environ.get("TURN") or f"0x{git_commit() or 0}"
    return list(items[int(turn, 0) % turns :: turns])
