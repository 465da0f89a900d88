"""Numbers in which the learners of one program differ, beside their seeds.

    axis = Axis.of([{"agent": one}, {"agent": other}])  # which differ in numbers alone
    axis.numbers                            # {"agent.learners.policy.discount": (0.99, 0.995)}
    axis.put(one, "agent", {"agent.learners.policy.discount": 0.995})  # equals `other`

Within a program the numbers [] are traced. A part checks its fields when it is made, for which
they must be known: each agent was checked on its own, and `put` makes parts without the checks.
"""

from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, fields, is_dataclass
from typing import Any

import numpy as np

from hybrid_rl.fields import choices, plain

Numbers = Mapping[str, Any]  # path in a tree of parts -> number


class DifferError(ValueError):
    """Trees of parts differ in more than numbers; `path` is where."""

    def __init__(self, path: str) -> None:
        super().__init__(f"{path}: differs, and is no number")
        self.path = path


@dataclass(frozen=True)
class Axis:
    """K sets of numbers for one tree of parts; none, of which there is one, by default."""

    count: int = 1  # K
    numbers: Mapping[str, tuple[float, ...]] = field(default_factory=dict)  # path -> [K]
    names: tuple[str, ...] = ("",)  # [K] of the sets, for messages

    @classmethod
    def of(cls, trees: Sequence[Any], names: tuple[str, ...] = ()) -> "Axis":
        """The numbers in which K trees differ: parts, with mappings and tuples of parts.

        Raises:
            DifferError: if they differ in anything else, such as a whole number of a field that
                takes no others.
        """
        return cls(len(trees), dict(_differing(trees, "")), names or ("",) * len(trees))

    def put(self, node: Any, path: str, numbers: Numbers) -> Any:
        """The tree `node`, which is at `path`, with `numbers` [] in it."""
        ours = {name for name in numbers if f"{name}.".startswith(f"{path}.")}
        if not ours:
            return node
        if path in ours:
            return numbers[path]
        if isinstance(node, Mapping):
            return {name: self.put(each, f"{path}.{name}", numbers) for name, each in node.items()}
        if isinstance(node, (list, tuple)):
            each = (self.put(one, f"{path}.{i}", numbers) for i, one in enumerate(node))
            return type(node)(each)
        made = copy(node)
        for name in (each.name for each in fields(node)):
            value = self.put(getattr(node, name), f"{path}.{name}", numbers)
            object.__setattr__(made, name, value)
        return made


def _differing(nodes: Sequence[Any], path: str, kind: Any = float) -> Iterator[tuple[str, Any]]:
    """The paths at which trees have different numbers, and these; kind: type of the field."""
    first = nodes[0]
    if all(node is first for node in nodes):
        return
    if all(isinstance(node, (int, float)) and not isinstance(node, bool) for node in nodes):
        if len(set(nodes)) > 1:
            if float not in map(plain, choices(kind)):
                raise DifferError(path)
            yield path, tuple(map(float, nodes))
        return
    below = [_below(node) for node in nodes]
    same = all(type(node) is type(first) for node in nodes)
    same &= all([*each] == [*below[0]] for each in below)
    if not same or not (below[0] or all(np.array_equal(node, first) for node in nodes)):
        raise DifferError(path)
    for name, (_, kind) in below[0].items():
        inner = [each[name][0] for each in below]
        yield from _differing(inner, f"{path}.{name}".lstrip("."), kind)


def _below(node: Any) -> dict[str, tuple[Any, Any]]:
    """The values right below a node by name, each with the type of its field."""
    if is_dataclass(node):
        return {each.name: (getattr(node, each.name), each.type) for each in fields(node)}
    if isinstance(node, Mapping):
        return {str(name): (value, float) for name, value in node.items()}
    if isinstance(node, (list, tuple)):  # a list of numbers is no number
        return {str(i): (value, int) for i, value in enumerate(node)}
    return {}
