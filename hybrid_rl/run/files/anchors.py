"""YAML in which a part that occurs several times is written once, with an anchor."""

from typing import Any

import yaml
from omegaconf import DictConfig, OmegaConf


def as_yaml(config: DictConfig) -> str:
    """`config` as YAML; equal parts are one object, which PyYAML writes once."""
    first: dict[str, Any] = {}  # a part as text -> its first occurrence

    def share(node: Any) -> Any:
        if not isinstance(node, dict):
            return node
        names = sorted(node, key=lambda name: name != "_target_")  # it comes first
        node = {name: share(node[name]) for name in names}
        return first.setdefault(str(node), node) if "_target_" in node else node

    values = share(OmegaConf.to_container(config))
    return yaml.dump(values, Dumper=_Dumper, sort_keys=False, allow_unicode=True)


class _Dumper(yaml.SafeDumper):
    """Lists on a line, and what reads as a number in YAML 1.2, such as 1e-3, in quotes."""

    def sequence(self, data: list[Any]) -> yaml.Node:
        flow = not any(isinstance(value, (dict, list)) for value in data)
        return self.represent_sequence("tag:yaml.org,2002:seq", data, flow_style=flow)

    def word(self, data: str) -> yaml.Node:
        try:
            float(data)
        except ValueError:
            return self.represent_str(data)
        return self.represent_scalar("tag:yaml.org,2002:str", data, style="'")


_Dumper.add_representer(list, _Dumper.sequence)
_Dumper.add_representer(str, _Dumper.word)
