"""YAML in which a part that occurs several times is written once, with an anchor by its key."""

import re
from typing import Any

import yaml
from omegaconf import DictConfig, OmegaConf


def as_yaml(config: DictConfig) -> str:
    """`config` as YAML, in which a part that occurs several times is written once."""
    first: dict[str, Any] = {}  # a part as text -> its first occurrence

    def share(key: str, node: Any) -> Any:
        if not isinstance(node, dict):
            return node
        names = sorted(node, key=lambda name: name != "_target_")  # it comes first
        node = _Part({name: share(name, node[name]) for name in names})
        node.key = key
        return first.setdefault(str(node), node) if "_target_" in node else node

    values = share("", OmegaConf.to_container(config))
    return yaml.dump(values, Dumper=_Dumper, sort_keys=False, allow_unicode=True)


class _Part(dict):
    """A mapping that remembers its key."""

    key: str


class _Dumper(yaml.SafeDumper):
    """Names an anchor by the key of the part that it marks: model_1, policy_2, ..."""

    ANCHOR_TEMPLATE = "%d"  # the number of an anchor

    def generate_anchor(self, node: Any) -> str:
        name = re.sub(r"\W", "_", node.key)
        return f"{name}_{super().generate_anchor(node)}"

    def part(self, data: _Part) -> yaml.Node:
        node: Any = self.represent_dict(data)
        node.key = data.key
        return node

    def sequence(self, data: list[Any]) -> yaml.Node:
        flow = not any(isinstance(value, (dict, list)) for value in data)
        return self.represent_sequence("tag:yaml.org,2002:seq", data, flow_style=flow)

    def word(self, data: str) -> yaml.Node:
        """Quote what reads as a number in YAML 1.2, such as 1e-3."""
        try:
            float(data)
        except ValueError:
            return self.represent_str(data)
        return self.represent_scalar("tag:yaml.org,2002:str", data, style="'")


_Dumper.add_representer(_Part, _Dumper.part)
_Dumper.add_representer(list, _Dumper.sequence)
_Dumper.add_representer(str, _Dumper.word)
