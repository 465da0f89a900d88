"""The configuration of a run that begins with another one: that of run=DIR, with the overrides.

config.yaml holds values without references, and not all names of the parts that were chosen. So
the overrides are composed with the task and the method of DIR (`add_choices`), and what they
change, there or by reference elsewhere, is changed in the values of DIR (`resolve_config`).
"""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from omegaconf import DictConfig, OmegaConf

from hybrid_rl import config as configuration
from hybrid_rl import overrides
from hybrid_rl.conf_files import file, options
from hybrid_rl.errors import UsageError
from hybrid_rl.overrides import parse, raw_values
from hybrid_rl.run import folder
from hybrid_rl.settings.complete import LACKING, REFERENCE, select, source

CHOSEN = ("task", "algo", "learning")  # they make the parameters
WIDE = ("settings", "experiment")  # they would set what DIR has set
OWN = {"random_steps": 0, "pretrain": 0, "run_dir": None, "freeze": [], "distributed": False}


def add_choices(texts: Sequence[str]) -> list[str]:
    """The words of a command, with the task and the method of DIR before run=DIR.

    Raises:
        UsageError: if there is no such run, for another task or method, or with resume=DIR.
    """
    named = [text for text in texts if text.startswith("run=") and text != "run=null"]
    if not named:
        return [*texts]
    given = overrides.typed_values(texts)
    if given.get("resume", "null") != "null":
        raise UsageError(
            "run, resume: give one of them; run=DIR begins a new run with what DIR has learned, "
            "resume=DIR continues DIR itself"
        )
    (which,) = parse(named[-1:])
    folders = list(which.sweep_iterator()) if which.is_sweep_override() else [which.value()]
    runs = [folder.read(Path(str(each).strip("'\"")), "run") for each in folders]
    words = [_choices(each) for each in runs]
    if any(each != words[0] for each in words):
        raise UsageError(f"{named[-1]}: runs of one task and method only")
    for key in (*CHOSEN, *WIDE):
        if key in given and given[key] != words[0].get(key):
            has = f"; it has {key}={words[0][key]}" if key in words[0] else ""
            line = f"what is learned in {named[-1]} does not fit" if key in CHOSEN else ""
            line = line or f"with {named[-1]} the settings come from there; give single keys"
            raise UsageError(f"{key}={given[key]}: {line}{has}")
    more = [f"{key}={value}" for key, value in words[0].items() if key not in given]
    at, known = texts.index(named[-1]), raw_values(runs[0])
    kept = [text if select(known, _key(text)) is LACKING else f"++{text}" for text in texts]
    return [*kept[:at], *more, *kept[at:]]


def _key(text: str) -> str:
    """KEY.KEY of KEY.KEY=VALUE: that of a value in a part, which may be another part in conf/."""
    key = text.partition("=")[0]
    return key if re.fullmatch(r"\w+(\.\w+)+", key) else ""


def _choices(config: DictConfig) -> dict[str, str]:
    """The groups that make the parts of a run."""
    words = {"task": config.task, "algo": config.algo}
    if config.task not in options("task"):  # such as an environment of Gymnasium, by its id
        for name in options("task"):
            task: Any = OmegaConf.load(file("task", name))
            if select(raw_values(task), "env._target_") == config.env.get("_target_"):
                words["task"] = name
                break
    method = file("algo", config.algo).read_text() if config.algo in options("algo") else ""
    if "policy_learning" in config and "override /learning:" in method:
        words["learning"] = config.policy_learning
    return words


def resolve_config(config: DictConfig, texts: Sequence[str]) -> DictConfig:
    """The resolved configuration of a run, with the values of DIR if it has run=DIR.

    config: composed from the overrides `texts`, with its interpolations.

    Raises:
        UsageError: if there is no such run, or an override deletes a key.
    """
    if config.get("run") is None:
        return configuration.resolve(config, texts)
    raw, typed = raw_values(config), parse(texts)
    if deleted := [each for each in typed if each.is_delete()]:
        raise UsageError(f"{deleted[0].input_line}: with run=DIR keys cannot be deleted")
    now = configuration.resolved(config)
    stored: Any = OmegaConf.to_container(folder.read(Path(str(config.run)), "run"))
    for each in texts:
        if each.startswith("+") and select(stored, each.lstrip("+").partition("=")[0]) is LACKING:
            raise UsageError(f"{each}: unknown key; the run in run={config.run} has none")
    for key in ("version", "begun"):
        stored.pop(key, None)
    values = _linked(stored, raw) | OWN
    for key in configuration.READ:
        if key in now:
            values.setdefault(key, now[key])
    for key in sorted({source(raw, overrides.key(each)) for each in typed} - {*CHOSEN}):
        while (above := key.rpartition(".")[0]) and select(values, above) is LACKING:
            key = above  # a group that is newer than the run
        _put(values, key, _node(select(raw, key), select(now, key), values, raw))
    made: Any = OmegaConf.create(configuration.resolved(OmegaConf.create(values)))
    OmegaConf.set_struct(made, True)
    return made


def _linked(stored: dict[str, Any], raw: dict[str, Any]) -> dict[str, Any]:
    """The values, in which one is a reference that is one in `raw`, or a part with its own key.

    raw: the composed configuration. Values that differ from what it refers to stay.
    """

    def referred(node: Any, path: str) -> str:
        key = source(raw, path)
        return key if key != path and select(stored, key) == node else ""

    groups = {key: part for key, part in stored.items() if isinstance(part, dict)}
    named = {k: p for k, p in groups.items() if "_target_" in p and not referred(p, k)}

    def link(node: Any, path: str) -> Any:
        same = [k for k, part in named.items() if part == node] if path not in named else []
        if key := referred(node, path) or next(iter(same), ""):
            return f"${{{key}}}"
        if isinstance(node, list):
            return [link(each, f"{path}.{i}") for i, each in enumerate(node)]
        if isinstance(node, dict):
            return {key: link(each, f"{path}.{key}") for key, each in node.items()}
        return node

    return {key: link(node, key) for key, node in stored.items()}


def _put(values: dict[str, Any], path: str, value: Any) -> None:
    """Put what is composed at `path` into the values, if they have a part there."""
    above, _, name = path.rpartition(".")
    holder = select(values, above) if above else values
    if isinstance(holder, dict) and value is not LACKING:
        holder[name] = value


def _node(node: Any, value: Any, values: dict[str, Any], raw: dict[str, Any]) -> Any:
    """A part as composed, `value`, in which references to what `values` has stay."""
    if link := REFERENCE.fullmatch(str(node)):
        known = select(values, link[1]) is not LACKING
        return node if known else _node(select(raw, link[1]), value, values, raw)
    if isinstance(node, dict) and isinstance(value, dict):
        return {key: _node(each, value[key], values, raw) for key, each in node.items()}
    if isinstance(node, list) and isinstance(value, list):
        return [_node(each, v, values, raw) for each, v in zip(node, value, strict=True)]
    return value
