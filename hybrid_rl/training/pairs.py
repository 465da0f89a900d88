"""A column and a row of the same numbers, of which JAX and NumPy make a table without a word.

    r [B, 1] - q [B]  is  [B, B], every reward less every value

Source: JAX's documentation, "Rank promotion warning".
"""

import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import jax

PROMOTION = "Following NumPy automatic rank promotion"  # how JAX's warning begins


@contextmanager
def refuse() -> Iterator[None]:
    """While it is open, what is traced may not combine [.., n, 1] with [n], n above 1.

    Other ranks may differ, as those of a batch [B, n] and a weight [n].

    Raises:
        ValueError: from the line that does.
    """
    with warnings.catch_warnings(), jax.numpy_rank_promotion("warn"):
        warnings.filterwarnings("always", message=PROMOTION)
        show = warnings.showwarning

        def judge(message: Warning | str, *rest: Any) -> None:
            if str(message).startswith(PROMOTION):
                _judge(str(message))
            else:
                show(message, *rest)

        warnings.showwarning = judge
        yield


def _judge(warning: str) -> None:
    """Raise ValueError if the shapes in JAX's warning are a column and a row of the same size."""
    name, shapes = re.findall(r"for (\w+) on shapes (.*?)\. ", warning)[0]  # sub, (4, 1) (4,)
    sizes = [[*map(int, re.findall(r"\d+", each))] for each in re.findall(r"\((.*?)\)", shapes)]
    for row in (each for each in sizes if len(each) == 1 and each[0] > 1):
        for column in (each for each in sizes if each[-2:] == [row[0], 1]):
            table = [*column[:-1], row[0]]
            raise ValueError(
                f"{name} of {column} and {row} gives {table}, every one with every other; write "
                "x[..., 0] for the column, or y[None] for the row if that is meant"
            )
