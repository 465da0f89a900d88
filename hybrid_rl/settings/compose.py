"""Around Hydra's composition (config.py): what conf/ offers, errors, a user's task file."""

import difflib
import re
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import yaml
from hydra.errors import HydraException, MissingConfigException, OverrideParseException
from omegaconf import DictConfig, OmegaConf
from omegaconf.errors import InterpolationKeyError, OmegaConfBaseException

from hybrid_rl.errors import UsageError, install, printable, relative
from hybrid_rl.files.targets import asked, part_class
from hybrid_rl.settings import words as overrides
from hybrid_rl.settings.complete import keys, nearest
from hybrid_rl.settings.groups import CONF, THESIS, options
from hybrid_rl.settings.values import COUNTS, check_fields
from hybrid_rl.training.episode import Episode

OF_A_TASK = ("task", "env", *COUNTS, "random_steps")  # keys without which no run can begin
SLURM = "submitit_slurm"  # the launcher of an extra
MANY = 40  # names that are too many for a line; tasks are fewer
GLOBAL, METHODS = "# @package _global_", "`python -m hybrid_rl.list` shows methods"
OF_GYMNASIUM = re.compile(r"(?P<id>-v\d+$)|(?P<make>\w:\w)")  # ids, and MODULE:CLASS
UNCOMPOSED = (HydraException, OmegaConfBaseException, yaml.YAMLError)  # what `explain` explains
ROOT_KEY = re.compile(r"^(\w+):", re.MULTILINE)
INHERIT = "set them, or begin with defaults: [/task@_global_: pendulum, _self_] to take its values"


def keys_of(texts: Sequence[str], hydra: Any) -> dict[str, str]:
    """Key -> override, of a job: that of a value, and of a choice that of the part it makes.

    A choice that spreads over the configuration, as `algo`, and `sweep.KEY` have none.
    """
    found = {}
    for text, each in zip(texts, overrides.parse(texts), strict=True):
        file = chosen(hydra, each.key_or_group)
        spreads = file is not None and GLOBAL in file.read_text(encoding="utf-8")[:100]
        if not (spreads or each.is_delete() or overrides.is_swept(each.key_or_group)):
            found[overrides.key(each).replace("/", ".")] = text
    return found


def settings_keys(hydra: Any) -> dict[str, Any]:
    """The keys that the chosen file of `settings` sets."""
    file = chosen(hydra, "settings")
    found: Any = OmegaConf.to_container(OmegaConf.load(file)) if file else {}
    return keys({key: value for key, value in found.items() if key != "defaults"})


def check_choices(texts: Sequence[str]) -> None:
    """Refuse an override that gives a group something else than a name, and two environments."""
    typed = overrides.typed_values(texts)
    one, other = (typed.get(key, "") for key in ("env.id", "env.make"))
    if overrides.value_of(one) and overrides.value_of(other):
        raise UsageError(f"env.id={one}: env.make={other} is another environment; give one of them")
    for text in texts:
        key, _, value = text.lstrip("+").partition("=")
        each = [value] if value.startswith(("[", "{")) else value.split(",")
        read = [overrides.value_of(one) for one in each]
        names = read[0] if isinstance(read[0], list) else read  # a list: options one after another
        if all(isinstance(one, str) for one in names):
            continue
        if known := options(key.partition("@")[0]):
            raise UsageError(f"{text}: {_choice(value, known)}")


def tasks_with(*methods: str, keys: Collection[str] = ()) -> list[str]:
    """Tasks whose environment has these methods, as `dynamics` if it is analytic, and keys."""
    names = []
    for path in sorted((CONF / "task").glob("*.yaml")):
        task: Any = OmegaConf.load(path)
        with suppress(ValueError, KeyError, AttributeError):  # an unfinished task of the user
            kind, has = part_class(task.env._target_), {*keys} <= {*task.env}
            names += [path.stem] if has and all(hasattr(kind, name) for name in methods) else []
    return names


def explain(error: Exception) -> str:
    """One line that names the key, the value and what is allowed, from an error of Hydra's."""
    if isinstance(error, yaml.YAMLError):
        return _no_yaml(error)
    if isinstance(error, MissingConfigException) and error.missing_cfg_file is not None:
        parts = error.missing_cfg_file.split("/")
        deep = 2 if parts[0] == "hydra" else 1
        group, value = "/".join(parts[:deep]), "/".join(parts[deep:])
        known = sorted({*options(group), *(error.options or ())})  # theirs: of --config-dir too
        close = nearest(value, known) if len(known) < MANY else ""
        close = close and f"; did you mean {close}?"
        if group == "task" and (kind := OF_GYMNASIUM.search(value)):
            close = f"; did you mean task=gymnasium env.{kind.lastgroup}={value}?"
        if group == "hydra/launcher" and SLURM not in known:
            close = f"; submitit_local and {SLURM} need {install('slurm')}"
        if not close and deep == 1:
            close = f"; your own {group}/{value}.yaml needs config_dir=FOLDER"
        return f"{group}={value}: unknown; {_choice(value, known)}{close}"
    cause, text, absent = error.__cause__, str(error), _absent(error)
    if absent:
        more = f"; +{absent}=NAME adds it" if "@" in absent else ""
        return f"{absent}: the method has no such part{more}; {METHODS}"
    if isinstance(error, OverrideParseException):
        problem = text.splitlines()[-2]
        if set(problem) == {" ", "^"}:  # it points at a character
            problem = f"{printable(text[len(problem) - 1])} stands outside quotes"
        problem = problem.partition(" expecting {")[0]  # of kinds of signs
        return f"{error.override}: {problem}; write {overrides.TYPED}"
    if inner := re.match(r"In '(\w+)/(.+)': Could not override '([^'@]+)", text):
        return f"{inner[1]}={inner[2]}: is not for this method, which has no {inner[3]} to change"
    if several := re.match(r"Ambiguous value for argument '([^']+)'", text):
        return f"{several[1]}: several values are a sweep, which needs -m; a list is key=[a,b]"
    if twice := re.match(r"(\S+) appears more than once", text):
        return f"{twice[1]}: is loaded twice; leave your line out, or write override before it"
    if isinstance(error, InterpolationKeyError):
        key = named[1] if (named := re.search(r"'([^']+)'", text)) else "a key"
        if key.startswith("env.") and (line := _of_other_tasks(error, key)):
            return line
        at, lacks = error.full_key, f"refers to {key}, which neither this task nor this method sets"
        return f"{at}: {lacks}; give {at}=VALUE"
    if isinstance(error, OmegaConfBaseException) and re.search("to parent node|Recursive", text):
        return f"{error.full_key}: refers to itself; give it another part"
    if word := overrides.PLAIN.search(f"{text} {cause}"):
        return f"{word[1].lstrip('+')}: must be a group of keys; {overrides.SHOW}"
    return _sentences(f"{text}\n{cause or ''}")


def _of_other_tasks(error: InterpolationKeyError, key: str) -> str:
    """Which tasks have what a part of the method reads of the environment; "" if none has it."""
    part: Any = error.parent_node
    whole, text = part._get_root(), str(OmegaConf.to_container(part))
    read = {*re.findall(r"\$\{env\.(\w+)\}", text)}
    having = ", ".join(tasks_with(*asked(OmegaConf.to_container(whole)), keys=read))
    line = f"task={whole.task}: has no {key}, which {whole.algo} ({error.full_key}) reads"
    return f"{line}; choose one of {having}" if having else ""


def _absent(error: BaseException | None) -> str:
    """The key or the group of an override that is not there, by an error of Hydra's; or ""."""
    cause = error and error.__cause__
    if isinstance(cause, OmegaConfBaseException) and "is not in struct" in str(cause):
        return str(cause.full_key)
    found = re.match(r"Could not override '([^']+)'", str(error))
    return found[1] if found else ""


def concerns(error: BaseException | None, override: str) -> bool:
    """Whether an error of Hydra's says that what an override changes is not there."""
    absent, key = _absent(error), override.partition("=")[0]
    return bool(absent) and f"{key}.".startswith(f"{absent}.")


def _choice(word: str, known: Sequence[str]) -> str:
    """What to choose in place of a word: one of all names, or of MANY one of the nearest."""
    if len(known) < MANY:
        return f"choose one of {', '.join(known)}"
    close = difflib.get_close_matches(word.lower(), known, n=1, cutoff=0.4)
    nearest = f"; nearest: {', '.join(close)}" if close else ""
    return f"choose one of the {len(known)} in `python -m hybrid_rl.list`{nearest}"


def _no_yaml(error: yaml.YAMLError) -> str:
    """The file, the line and what is wrong there."""
    if (mark := getattr(error, "problem_mark", None)) is None:
        return _sentences(str(error))
    problem = str(getattr(error, "problem", "it cannot be read"))
    tab = "; indent with spaces, not with a tab" if "'\\t'" in problem else ""
    return f"{relative(mark.name)}:{mark.line + 1}: is no YAML: {problem}{tab}"


def _sentences(text: str) -> str:
    """The lines of a message, joined to one line."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    lines = [line for line in lines if not re.match(r"(full_key|\w+_type)\b", line)]  # OmegaConf's
    return " ".join(line if line[-1] in ".:;,?!" else f"{line};" for line in lines).rstrip(";")


def chosen(hydra: Any, group: str) -> Path | None:
    """The YAML file of the user's choice in a group; None if there is none.

    hydra: Hydra's own part of what was composed.
    """
    name = f"{group}/{hydra.runtime.choices.get(group)}.yaml"
    files = (Path(each.path) / name for each in hydra.runtime.config_sources if each.path)
    return next((file for file in files if file.is_file()), None)


def check_task(config: DictConfig, hydra: Any) -> None:
    """Raise UsageError, in one line that names the file, for an incomplete task of the user's.

    config: what was composed, with its references; hydra: Hydra's own part of it.
    """
    raw, file = overrides.raw_values(config), chosen(hydra, "task")
    if raw.get("resume") is not None:
        return
    _refuse_nameless(raw, chosen(hydra, "algo"), "algo")
    if file is None or CONF in file.parents:
        return
    name = relative(file)
    if isinstance(raw.get("task"), dict):
        raise UsageError(f"{name}: its first line must be {GLOBAL}")
    if lacking := [key for key in OF_A_TASK if raw.get(key) is None]:
        raise UsageError(f"{name}: lacks {', '.join(lacking)}; {INHERIT}")
    _refuse_nameless(raw, file, "task")
    if "_target_" not in raw["env"]:
        raise UsageError(f"{name}: env lacks _target_; write _target_: MODULE.CLASS")
    try:
        check_fields(config.episode, Episode, "episode.")
    except UsageError as error:
        raise UsageError(f"{name}: {error}") from error


def check_keys(hydra: Any, read: Mapping[str, Any]) -> None:
    """Raise UsageError for a key of the user's task that no method reads, as after a slip.

    hydra: Hydra's own part of what was composed; read: what the run reads of it.
    """
    file = chosen(hydra, "task")
    if file is None or CONF in file.parents:
        return
    own, known = OmegaConf.load(file), _root_keys(hydra, file) | read.keys() | {"defaults"}
    if lost := [str(key) for key in own if key not in known]:
        near = nearest(lost[0], known)
        hint = f"; did you mean {near}?" if near else ""
        line = f"{relative(file)}: {lost[0]}: unknown key, which nothing reads{hint}"
        raise UsageError(line)


def _root_keys(hydra: Any, without: Path) -> set[str]:
    """The keys at the root of all YAML files that can be chosen, one left out."""
    sources = [Path(each.path) for each in hydra.runtime.config_sources if each.schema == "file"]
    files = {file for source in (*sources, THESIS) for file in source.rglob("*.yaml")} - {without}
    texts = (file.read_text(encoding="utf-8", errors="replace") for file in files)
    root = (CONF / "train.yaml").read_text(encoding="utf-8")
    return set(ROOT_KEY.findall("\n".join([root, *(text for text in texts if GLOBAL in text)])))


def _refuse_nameless(raw: Mapping[str, Any], file: Path | None, group: str) -> None:
    """Raise UsageError for a user's file of a task or a method that does not name its runs.

    They would have the name, and the folder, of what the file begins with.
    """
    if file is None or {CONF, THESIS} & {*file.parents} or isinstance(raw.get(group), dict):
        return
    if group not in OmegaConf.load(file):
        raise UsageError(f"{relative(file)}: lacks {group}: {file.stem}, the name of its runs")
