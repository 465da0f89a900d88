"""What surrounds Hydra's composition (build.py): errors in one line, the user's tasks, methods."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml
from hydra.errors import HydraException, MissingConfigException, OverrideParseException
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import OmegaConfBaseException

from hybrid_rl.errors import UsageError, install, relative
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.complete import keys, nearest
from hybrid_rl.settings.groups import CONF, THESIS, options
from hybrid_rl.settings.values import COUNTS

OF_A_TASK = ("env", *COUNTS, "random_steps")  # keys without which no run can begin
MANY = 40  # names that are too many for a line; tasks are fewer
GLOBAL = "# @package _global_"
OF_GYMNASIUM = re.compile(r"(?P<id>-v\d+$)|(?P<make>\w:\w)")  # ids, and MODULE:CLASS
UNCOMPOSED = (HydraException, OmegaConfBaseException, yaml.YAMLError)  # what `explain` explains
INHERIT = "set them, or begin with defaults: [/task@_global_: pendulum, _self_] to take its values"


def typed_keys(hydra: Any) -> list[str]:
    """The keys that the user's overrides change: of a choice that of the part it makes.

    A choice that spreads over the configuration, as `algo`, and `sweep.KEY` have none.
    """
    found = []
    for override in overrides.parse(overrides.of_job(hydra)):
        file = chosen(hydra, override.key_or_group)
        spreads = file is not None and GLOBAL in file.read_text(encoding="utf-8")[:100]
        if not (spreads or override.is_delete() or overrides.is_swept(override.key_or_group)):
            found.append((override.package or override.key_or_group).replace("/", "."))
    return found


def settings_keys(hydra: Any) -> dict[str, Any]:
    """The keys that the chosen file of `settings` sets."""
    file = chosen(hydra, "settings")
    found = overrides.plain(OmegaConf.load(file)) if file else {}
    return keys({key: value for key, value in found.items() if key != "defaults"})


def explain(error: Exception) -> str:
    """One line from an error of Hydra's, OmegaConf's or a YAML file's."""
    if isinstance(error, MissingConfigException) and error.missing_cfg_file is not None:
        return _unknown(error.missing_cfg_file, error.options or ())
    if isinstance(error, OverrideParseException):
        typed = str(error.override).removeprefix("++")
        return f"{typed}: cannot be read; write key=value, text as 'key=\"TEXT\"'"
    mark = getattr(error, "problem_mark", None)
    if mark is not None:
        problem = getattr(error, "problem", None) or "cannot be read"
        return f"{relative(mark.name)}:{mark.line + 1}: is no YAML: {problem}"
    lines = f"{error}\n{error.__cause__ or ''}".splitlines()
    lines = [line.strip() for line in lines if not re.match(r"\s*(full_key|\w+_type)\b|\s*$", line)]
    text = "; ".join(lines)
    key = getattr(error, "full_key", None)
    return f"{key}: {text}" if key else text


def _unknown(file: str, found: Sequence[str]) -> str:
    """The line about a choice that a group does not have; found: by Hydra, also the user's."""
    names = file.split("/")
    depth = 2 if names[0] == "hydra" else 1
    group, value = "/".join(names[:depth]), "/".join(names[depth:])
    known = sorted({*options(group), *found})
    many = len(known) >= MANY
    some = "those in `python -m hybrid_rl.list`" if many else ", ".join(known)
    near = nearest(value.lower(), known)
    hint = f"did you mean {near}?" if near else ""
    if group == "task" and (kind := OF_GYMNASIUM.search(value)):
        hint = f"did you mean task=gymnasium env.{kind.lastgroup}={value}?"
    if group == "hydra/launcher":
        hint = f"those of Submitit need {install('slurm')}"
    hint = hint or f"your own {group}/{value}.yaml needs config_dir=FOLDER"
    return f"{group}={value}: unknown; choose one of {some}; {hint}"


def chosen(hydra: Any, group: str) -> Path | None:
    """The YAML file of the user's choice in a group; None if there is none.

    hydra: Hydra's own part of what was composed.
    """
    name = f"{group}/{hydra.runtime.choices.get(group)}.yaml"
    folders = [source.path for source in hydra.runtime.config_sources if source.path]
    files = (Path(folder) / name for folder in (*folders, THESIS))
    return next((file for file in files if file.is_file()), None)


def adopt_planner(config: DictConfig, hydra: Any) -> None:
    """Let the planner of the user's file act, with its keys alone; a global file does so itself.

    config, hydra: as of `complete_names`.
    """
    file = chosen(hydra, "planner")
    if file is None or GLOBAL in file.read_text(encoding="utf-8")[:100]:
        return
    typed = (overrides.name(text).split(".") for text in overrides.of_job(hydra))
    own = {*OmegaConf.load(file), *(key[0] for group, *key in typed if group == "planner" and key)}
    config.planner = OmegaConf.masked_copy(config.planner, sorted(own))
    config.controllers.full = "${planner}"
    if "model_planner" in config:
        config.model_planner = "${planner}"


def complete_names(config: DictConfig, hydra: Any) -> None:
    """Give the runs of a task or a method of the user's the name of its file, if it says none.

    Raises UsageError, in one line that names the file, for an incomplete task.

    config: what was composed, with its references; hydra: Hydra's own part of it.
    """
    for group in ("task", "algo"):
        file = chosen(hydra, group)
        if file is None or {CONF, THESIS} & {*file.parents} or config["resume"] is not None:
            continue  # no file of the user's
        raw = overrides.plain(config)
        lacking = [key for key in OF_A_TASK if raw.get(key) is None]
        if isinstance(raw.get(group), dict):
            raise UsageError(f"{relative(file)}: its first line must be {GLOBAL}")
        if group == "task" and lacking:
            raise UsageError(f"{relative(file)}: lacks {', '.join(lacking)}; {INHERIT}")
        if group not in OmegaConf.load(file):
            config[group] = file.stem
