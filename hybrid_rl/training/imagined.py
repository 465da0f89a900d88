"""What learners imagined in another world, or for another goal, is not what they begin with."""

from typing import Any

import jax

from hybrid_rl.core.branches import Branches


def forgotten(learners: Any) -> Any:
    """States of learners whose branches start again, where they keep some."""

    def one(node: Any) -> Any:
        return node.restarted() if isinstance(node, Branches) else node

    return jax.tree.map(one, learners, is_leaf=lambda node: isinstance(node, Branches))
