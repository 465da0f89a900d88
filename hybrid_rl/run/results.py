"""What run folders hold, read for figures: the rows of metrics.jsonl and the settings of a run."""

import glob
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import yaml  # OmegaConf's own parser, in C: a configuration has a thousand lines

from hybrid_rl.config import SECTIONS
from hybrid_rl.errors import UsageError

NOT_ROWS = ("step", "seed", "wall_s", "diverged")  # of a row; every other name is a metric
# Keys in which runs of the same settings may differ: which learners they hold, how long they run,
# what they write and when, and where. None of them changes what a learner does up to a given step.
NOT_SETTINGS = (
    *("task", "algo", "seed", "num_seeds", "run_dir", "resume", "total_steps", "log_every"),
    *("eval_every", "eval_episodes", "eval_modes", "checkpoint_every", "checkpoint_replay"),
    "compile_cache",
)
NOT_SETTINGS_ANYWHERE = ("physics",)  # who computes the same equations
UNSET, SET = "unset", "set"  # of a key that only some of the runs have, and of a group of keys
MOST_KEYS, MOST_CHARACTERS = 3, 40  # of a label; beyond that it is a letter


@dataclass(frozen=True)
class RunFolder:
    """A folder that training wrote; its files are read when they are first needed.

    Raises:
        UsageError: where a file is damaged; the line names it.
    """

    path: Path

    @cached_property
    def _read(self) -> tuple[list[dict[str, Any]], bool]:
        """The rows, and whether the last one was cut."""
        file = self.path / "metrics.jsonl"
        lines = _text(file).split("\n")
        rows = []
        for number, line in enumerate(lines[:-1], 1):  # what follows the last line end is cut
            try:
                row = json.loads(line)
            except ValueError:
                row = None
            if not isinstance(row, dict) or not {"step", "seed", "wall_s"} <= row.keys():
                raise UsageError(
                    f"{file}: line {number} is no row of metrics (JSON with step, seed and wall_s)"
                )
            rows.append(row)
        return rows, bool(lines[-1].strip())

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The whole rows of metrics.jsonl; a run at work may be in the middle of the last one."""
        return self._read[0]

    @property
    def cut(self) -> bool:
        """Whether the last row was left out, since it is not whole."""
        return self._read[1]

    @cached_property
    def settings(self) -> dict[str, Any]:
        """Every value of config.yaml by its full key, such as "env.reward"; none without a file."""
        file = self.path / "config.yaml"
        if not file.exists():
            return {}
        try:
            read = yaml.load(_text(file), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            line = f", line {mark.line + 1}" if mark else ""
            raise UsageError(f"{file}{line}: is not YAML") from error
        if not isinstance(read, dict):
            raise UsageError(f"{file}: is empty, or no group of keys")
        return _flat(read)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """What summary.json holds; nothing before there is one."""
        file = self.path / "summary.json"
        if not file.exists():
            return {}
        try:
            read = json.loads(_text(file))
        except ValueError as error:
            raise UsageError(f"{file}: is not JSON") from error
        if not isinstance(read, dict):
            raise UsageError(f"{file}: is no group of keys")
        return read

    def word(self, key: str) -> str:
        """The value at `key`, of a part its class; "null" where it has none."""
        settings = self.settings
        if key in settings:
            return _shown(key, settings[key])
        if f"{key}._target_" in settings:
            return _shown("_target_", settings[f"{key}._target_"])
        if key in self.summary:
            return _shown(key, self.summary[key])
        raise UsageError(f"group={key}: {self.path} says nothing of it in config.yaml")

    def number(self, key: str) -> float:
        """The number at `key`."""
        value = self.settings.get(key)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise UsageError(
                f"x={key}: must be step, wall_s, or a number in every run's config.yaml"
            )
        return float(value)


def find(runs: str | Path | Iterable[str | Path]) -> list[Path]:
    """Run folders that match a glob, or that lie in the folders given."""
    if isinstance(runs, (str, Path)):
        matches = [Path(match) for match in glob.glob(str(Path(runs).expanduser()), recursive=True)]
    else:
        matches = [Path(run) for run in runs]
    below = {path.parent for match in matches for path in match.glob("**/metrics.jsonl")}
    if not below:
        raise UsageError(f"runs={runs}: no run there (a folder that holds metrics.jsonl)")
    return sorted(below)


def differences(runs: Sequence[RunFolder], expected: Sequence[str] = ()) -> list[dict[str, str]]:
    """Of each run the settings in which the runs differ: key -> value, as words.

    Compared is what was built: the sections `env`, `episode`, `replay`, `controllers` and
    `learners` of the resolved configuration, and its single keys; not the parts that the method
    does not use. A value that is in several sections counts once, by the shortest key that has it.
    expected: keys that may differ, with all that follows them.
    """
    settings = [run.settings for run in runs]
    built = [_built(each) for each in settings]
    known = {_column(settings, key) for key in expected}
    differ = {key: column for key, column in _columns(built).items() if column not in known}
    found = _columns(settings) if differ else {}
    names: dict[tuple[str, tuple[str, ...]], str] = {}
    for key, column in differ.items():
        if UNSET in column and any(parent in differ for parent in _parents(key)):
            continue  # a field of a part that the others do not have
        leaf = key.rpartition(".")[2]
        same = [k for k, c in found.items() if c == column and k.rpartition(".")[2] == leaf]
        part = _class(settings[0], key)
        names[leaf, column] = min(
            same, key=lambda k: (_class(settings[0], k) != part, k.count("."), len(k))
        )
    return [
        {name.removesuffix("._target_"): column[i] for (_, column), name in sorted(names.items())}
        for i in range(len(runs))
    ]


def short(differing: Sequence[Mapping[str, str]]) -> list[str]:
    """A label for each set of settings: "reward=pybullet", or A, B, ... where that is long."""
    keys = list(dict.fromkeys(key for each in differing for key in each))
    leaves = [key.rpartition(".")[2] for key in keys]
    shown = {
        k: leaf if leaves.count(leaf) == 1 else k for k, leaf in zip(keys, leaves, strict=True)
    }
    labels = [" ".join(f"{shown[k]}={v}" for k, v in each.items()) for each in differing]
    if len(keys) <= MOST_KEYS and all(len(label) <= MOST_CHARACTERS for label in labels):
        return labels
    order = sorted(set(labels))
    return [_letters(order.index(label)) for label in labels]


def _letters(number: int) -> str:
    """A, B, ..., Z, A1, B1, ..."""
    return chr(ord("A") + number % 26) + (str(number // 26) if number >= 26 else "")


def _text(file: Path) -> str:
    try:
        return file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise UsageError(f"{file}: is not text (UTF-8)") from error
    except OSError as error:
        raise UsageError(f"{file}: cannot be read ({error.strerror})") from error


def _flat(node: Mapping[str, Any], where: str = "") -> dict[str, Any]:
    """The values of a tree by their full keys."""
    found: dict[str, Any] = {}
    for key, value in node.items():
        if isinstance(value, Mapping) and value:
            found |= _flat(value, f"{where}{key}.")
        else:
            found[f"{where}{key}"] = value
    return found


def _built(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings that a run was made of; all of them where it is no run of ours."""
    ours = any(key.startswith("learners.") for key in settings)
    return {
        key: value
        for key, value in settings.items()
        if key not in NOT_SETTINGS
        and key.rpartition(".")[2] not in NOT_SETTINGS_ANYWHERE
        and not (ours and "." in key and key.partition(".")[0] not in SECTIONS)
    }


def _columns(settings: Sequence[Mapping[str, Any]]) -> dict[str, tuple[str, ...]]:
    """The keys whose values differ, and the value of each run."""
    found = {key: _column(settings, key) for key in sorted(set().union(*settings))}
    return {key: column for key, column in found.items() if len(set(column)) > 1}


def _column(settings: Sequence[Mapping[str, Any]], key: str) -> tuple[str, ...]:
    def one(each: Mapping[str, Any]) -> str:
        if key in each:
            return _shown(key, each[key])
        return SET if any(name.startswith(f"{key}.") for name in each) else UNSET

    return tuple(map(one, settings))


def _class(settings: Mapping[str, Any], key: str) -> Any:
    """The class of the part that a key belongs to."""
    return settings.get(f"{key.rpartition('.')[0]}._target_")


def _parents(key: str) -> list[str]:
    """The groups that hold a key, and the keys of their classes: "a", "a._target_", ..."""
    parts = key.split(".")
    above = [".".join(parts[:i]) for i in range(1, len(parts))]
    return [name for group in above for name in (group, f"{group}._target_") if name != key]


def _shown(key: str, value: Any) -> str:
    if key.endswith("_target_"):
        return str(value).rpartition(".")[2]
    return value if isinstance(value, str) else json.dumps(value, default=str)
