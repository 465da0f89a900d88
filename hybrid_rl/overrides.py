"""Overrides of the user: keys that do not exist, keys that nothing reads, values as typed.

A run reads the keys `config.READ` and the keys to which they refer by interpolation. An override of
any other key has no effect and is refused; a YAML file may set it, as it serves several methods.
"""

import difflib
import re
from collections.abc import Iterable, Mapping, Sequence
from itertools import compress
from typing import Any

from hydra import compose
from hydra.core.global_hydra import GlobalHydra
from hydra.core.override_parser.overrides_parser import OverridesParser
from hydra.core.override_parser.types import Override, Quote, QuotedString
from omegaconf import DictConfig, OmegaConf

from hybrid_rl.errors import UsageError

REFERENCE = re.compile(r"\$\{([\w.@]+)\}")  # an interpolation, which names a key
PLAIN = re.compile(r"(?s)(?:node `|override )([^`=]+).*(?:not a container|merge DictConfig)")
TYPED = "key=value, text as 'key=\"TEXT\"'"
MOST = 4  # keys that one line suggests
GROUPS = ("learning", "settings", "experiment")  # groups that leave no key of their name
SHOW = "`python -m hybrid_rl.train --cfg job` shows all of them"
THEIRS = {"gamma": "discount", "lr": "learning_rate", "buffer_size": "capacity"}
THEIRS |= {"learning_starts": "random_steps", "total_timesteps": "total_steps"}  # elsewhere
LACKING: Any = object()  # the value of a key that does not exist


def parse(texts: Iterable[str]) -> list[Override]:
    """Overrides of the configuration, those of Hydra's own keys left out."""
    parser = OverridesParser.create()
    parsed = [parser.parse_override(text) for text in texts]
    return [each for each in parsed if not each.key_or_group.startswith("hydra")]


def of_job(hydra: Any) -> list[str]:
    """The overrides of a job as typed, by Hydra's configuration; `a=${b}` stays as it is."""
    texts: Any = OmegaConf.to_container(hydra.overrides.task, resolve=False)
    return texts


def typed_values(texts: Iterable[str]) -> dict[str, str]:
    """Overrides as key -> value, as they were typed."""
    pairs = (text.lstrip("+~").partition("=") for text in texts)
    return {key: value for key, _, value in pairs}


def quoted(value: str) -> str:
    """A value as it is typed in an override, in quotes if Hydra would read it as something else."""
    if re.fullmatch(r"[\w./-]+", value) and value_of(value) == value:
        return value
    return QuotedString(value, Quote.double).with_quotes()


def is_swept(text: str) -> bool:
    """Whether an override is sweep.KEY=[A,B], of learners in one program."""
    return text.lstrip("+").startswith("sweep.")


def allow_sweep_keys(texts: Iterable[str]) -> list[str]:
    """The overrides as Hydra takes them, to which sweep.KEY is a new key."""
    return [f"+{text}" if text.startswith("sweep.") else text for text in texts]


def key(override: Override) -> str:
    """The key of the configuration that an override changes."""
    return override.package or override.key_or_group


def raw_values(config: DictConfig) -> dict[str, Any]:
    """`config` with its interpolations as text."""
    raw: Any = OmegaConf.to_container(config, resolve=False)
    return {name: value for name, value in raw.items() if name != "hydra"}


def source(raw: dict[str, Any], path: str) -> str:
    """The key that holds what `path` names: interpolations on the way are followed."""
    at, node = "", raw
    for name in path.split("."):
        while isinstance(node, str) and (link := REFERENCE.fullmatch(node)):
            at, node = link[1], select(raw, link[1])
        at = f"{at}.{name}" if at else name
        node = node.get(name, LACKING) if isinstance(node, dict) else LACKING
    return at


def select(raw: dict[str, Any], path: str) -> Any:
    """The value at `path`, LACKING if there is none."""
    node: Any = raw
    for name in source(raw, path).split("."):
        node = node.get(name, LACKING) if isinstance(node, dict) else LACKING
    return node


def reachable_keys(raw: dict[str, Any], roots: Iterable[str]) -> dict[str, Any]:
    """Every key at or below `roots`, and below the keys that these name, with its value."""
    values: dict[str, Any] = {}

    def visit(path: str, node: Any) -> None:
        if path in values:
            return
        values[path] = node
        if isinstance(node, dict):
            for name, value in node.items():
                visit(f"{path}.{name}", value)
        for target in REFERENCE.findall(str(node)) if isinstance(node, (str, list)) else ():
            target = source(raw, target)
            visit(target, select(raw, target))

    for root in roots:
        if root in raw:
            visit(root, raw[root])
    return values


def unused(config: DictConfig, typed: Iterable[Override], roots: Iterable[str]) -> dict[str, str]:
    """Typed keys that nothing at or below `roots` reads -> the keys that are read instead.

    config: composed, with its interpolations.
    """
    raw, lost = raw_values(config), {}
    read = reachable_keys(raw, roots)
    for each in typed:
        node = select(raw, at := source(raw, key(each)))
        if node is LACKING or each.is_delete():  # a group that spreads over the configuration
            continue
        part = _target(node) is not None  # of which one value that another part reads is no use
        if at not in read and (part or not any(name.startswith(f"{at}.") for name in read)):
            group = f"{each.key_or_group}@" if part else ""
            lost[key(each)] = ", ".join(f"{group}{name}" for name in _instead(raw, read, at))
    return lost


def _instead(raw: dict[str, Any], read: dict[str, Any], path: str) -> list[str]:
    """Keys that are read in place of `path`: a part for a part, a value for a value.

    They have its last name and a value of their own, or else they are what such a key refers to.
    """
    last, part = path.rsplit(".", 1)[-1], isinstance(select(raw, path), dict)
    own, referred = [], []
    for name, value in read.items():
        link = REFERENCE.fullmatch(str(value))
        at = source(raw, link[1]) if link else name
        target = select(raw, at)
        if name.rsplit(".", 1)[-1] != last or target in (None, LACKING) or at == path:
            continue
        if isinstance(target, dict) == part:
            (referred if link else own).append(at)
    return list(dict.fromkeys(own or referred))[:MOST]


def near(config: DictConfig, path: str) -> str:
    """Existing keys similar to `path`, which no node of what `config` is part of has; or ""."""
    whole: Any = config._get_root()
    raw = raw_values(whole)
    parent, _, name = path.rpartition(".")
    name = THEIRS.get(name, name)
    siblings = select(raw, parent) if parent else [*raw, *GROUPS]
    siblings = siblings if isinstance(siblings, (dict, list)) else ()
    siblings = [each for each in siblings if each != "_target_"]
    close = difflib.get_close_matches(name, siblings, cutoff=0.8)
    named = [each for each in reachable_keys(raw, raw) if each.endswith((f".{name}", f"_{name}"))]
    if named and not close:  # learning_rate: policy_learner.policy_learning_rate
        here, ends = f"{source(raw, parent)}.", path.split(".")[-2:]
        named.sort(key=lambda each: (each.split(".")[-2:] != ends, not each.startswith(here)))
        return ", ".join(named[:MOST])
    close = difflib.get_close_matches(name, siblings)
    return ", ".join(f"{parent}.{each}".lstrip(".") for each in close)


def closest_hint(word: str, known: Iterable[str]) -> str:
    """The end of a message: a hint at the closest of the `known`, or "" if none is close."""
    close = difflib.get_close_matches(word, list(known), n=1, cutoff=0.65)
    return f"; did you mean {close[0]}?" if close else ""


def of_keys(values: dict[str, Any], read: Mapping[str, Any], where: str = "") -> dict[str, Any]:
    """The values whose full keys are in `read`, and the groups that hold one."""
    kept = {}
    for key, value in values.items():
        path = f"{where}{key}"
        inner = of_keys(value, read, f"{path}.") if isinstance(value, dict) else {}
        if path in read or inner:
            kept[key] = value if path in read else inner
    return kept


def as_typed(line: str, texts: Sequence[str]) -> str:
    """A message that begins with FIELD=VALUE of a part, with the key and the value as typed.

    A part names only its field: `reward='foo': ...` was typed as env.reward=foo. YAML reads 1e4 as
    10000.0.
    """
    head = re.match(r"([\w.]+)=(.*?): ", line)
    if head is None:
        return line
    value, values = value_of(head[2]), {str(value_of(head[2])), head[2].strip("'\"")}
    for each in parse(texts):
        path, text = key(each), each.get_value_element_as_str()
        if each.is_delete() or path.rsplit(".", 1)[-1] != head[1].rsplit(".", 1)[-1]:
            continue
        written = (each.input_line or "").partition("=")[2] or text
        if each.value() == value or {text.strip("'\""), str(each.value())} & values:
            return f"{path}={written}: {line[head.end() :]}"
    return line


def value_of(text: str) -> Any:
    """A value as Hydra reads it."""
    try:
        return OverridesParser.create().parse_override(f"a={text}").value()
    except Exception:
        return text


def refuse_new_keys(hydra: Any) -> None:
    """Raise UsageError for `+key=value` if conf/ has no such key, as nothing would read it."""
    more = [text for text in hydra.overrides.hydra if text.startswith("hydra.searchpath=")]
    overrides = [text for text in of_job(hydra) if not is_swept(text)]
    groups = GlobalHydra.instance().config_loader()
    added = {}
    for text in (text for text in overrides if text.startswith("+")):
        name = text.lstrip("+").partition("=")[0]
        if not groups.get_group_options(name.partition("@")[0]):
            added[text] = name
    if not added:
        return
    known = compose("train", [*more, *(text for text in overrides if text not in added)])
    if known.run is not None:  # it may have keys of parts that are chosen there
        return
    for each in added.values():
        if OmegaConf.select(known, each, default=LACKING) is LACKING:
            raise UsageError(unknown(known, each))


def refuse_unused(
    composed: Sequence[DictConfig], overrides: Sequence[str], roots: Sequence[str]
) -> None:
    """Raise UsageError for an override that none of the configurations reads, or a word for a part.

    composed: with their interpolations, one for each job of a sweep. roots: the keys
    that a run reads. A resumed run has settings of its own, so there nothing is refused here.
    """
    if any(config.resume is not None for config in composed):
        return
    for config in composed:
        _refuse_words(raw_values(config))
    typed = parse(text for text in overrides if not is_swept(text))
    each = [unused(config, typed, roots) for config in composed]
    for path in dict.fromkeys(path for lost in each for path in lost):
        having = [select(raw_values(config), path) is not LACKING for config in composed]
        if all(path in lost for lost in compress(each, having)):
            instead = next(filter(None, (lost.get(path) for lost in each)), "")
            methods = list(dict.fromkeys(config.algo for config in composed))
            does, use = ("does", "it uses") if len(methods) == 1 else ("do", "what they use is")
            line = f"{path}: {', '.join(methods)} {does} not use it"
            raise UsageError(f"{line}; {use} {instead}" if instead else line)


def _refuse_words(raw: dict[str, Any]) -> None:
    """Raise UsageError for a controller that is a word, or names no part, with the parts' names."""
    named = raw["controllers"] if isinstance(raw["controllers"], dict) else {}
    for path in (f"controllers.{name}" for name in named):
        at, node = source(raw, path), select(raw, path)
        for _ in raw:  # at most once for each key: references may form a circle
            if link := REFERENCE.fullmatch(str(node)):
                at, node = source(raw, link[1]), select(raw, link[1])
        if not (isinstance(node, str) or node is LACKING):
            continue
        parts = [name for name, part in raw.items() if ".controllers." in str(_target(part))]
        typed = f"{path}=${{{at}}}" if node is LACKING else f"{at}={node}"
        line = "must be a part, a group of keys with _target_; another one of the method's acts by"
        more = "one of your own needs +controller@NAME=FILE, too"
        raise UsageError(f"{typed}: {line} '{path}=${{NAME}}': {', '.join(parts)}; {more}")


def _target(part: Any) -> Any:
    """What a part of the configuration is made by; None for what is no part."""
    return part.get("_target_") if isinstance(part, dict) else None


def unknown(config: DictConfig, key: str) -> str:
    """The line for a key that `config`, any node of what was composed, does not have."""
    root: Any = config._get_root()
    parent, _, name = key.rpartition(".")
    inside: Any = select(raw_values(root), parent) if parent else None
    theirs = str(_target(inside) or "hybrid_rl.").partition("hybrid_rl.")[0]  # a class of the user
    if (close := near(config, key)) and (not theirs or close.startswith(f"{parent}.")):
        return f"{key}: unknown key; did you mean {close}?"
    if not isinstance(inside, dict):
        return f"{key}: unknown key; {SHOW}"
    names = ", ".join(each for each in inside if not each.startswith("_")) or "no keys"
    more = f"; a field of {theirs} must be in its YAML file, as {name}: VALUE" if theirs else ""
    more = f"; {key} needs task=gymnasium" if key in ("env.id", "env.make") else more
    return f"{key}: unknown key; {parent} has {names}{more}"
