"""Run folders, read for figures: the rows of metrics.jsonl and the settings of a run.

A setting is named by a key that train takes, such as planner.horizon, by its full key in
config.yaml, such as controllers.full.horizon, or by the last names of that key, such as
full.horizon or horizon. Runs of older versions are read, too.
"""

import glob
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from hybrid_rl.errors import UsageError
from hybrid_rl.files.reading import json_file, open_file, yaml_file
from hybrid_rl.run.logs.records import COORDINATES, WORD, arrays, flatten_keys, row_of
from hybrid_rl.settings.complete import nearest

NOT_METRICS = (*COORDINATES, WORD)  # of a row; every other name is a metric
# Keys in which runs of the same settings may differ: which learners they hold, how long they run,
# what they write, when and where. None of them changes what a learner does up to a given step.
NOT_SETTINGS = {
    *("task", "algo", "seed", "num_seeds", "run_dir", "resume", "total_steps", "log_every"),
    *("eval_every", "eval_episodes", "eval_modes", "checkpoint_every", "checkpoint_replay"),
    *("compile_cache", "version", "logger", "physics"),
}
IMPLEMENTATION = ".physics"  # ending of the keys that choose one of the same equations
UNSET, SET = "unset", "set"  # for a key that only some of the runs have, and for a group of keys
MOST_KEYS, MOST_CHARACTERS = 3, 40  # of a label; beyond that it is a letter


@dataclass(frozen=True)
class RunFolder:
    """A folder that training wrote; its files are read when they are first needed."""

    path: Path

    @cached_property
    def rows(self) -> list[dict[str, Any]]:
        """The complete rows of metrics.jsonl; a running process may be writing the last one."""
        file, rows = self.path / "metrics.jsonl", []
        with open_file(file) as data:
            for number, line in enumerate(data, 1):
                if not line.endswith(b"\n"):
                    break
                if (row := row_of(line)) is None:
                    what = "is no row of metrics (JSON with step, seed and wall_s)"
                    raise UsageError(f"{file}: line {number} {what}")
                rows.append(row)
        return rows

    @cached_property
    def settings(self) -> dict[str, Any]:
        """The values of config.yaml by their full keys, such as "env.reward"; {} without a file."""
        file = self.path / "config.yaml"
        if not file.exists():
            return {}
        values = yaml_file(file)
        for key in ("recipe", "config_dir"):  # the words; the values follow
            values.pop(key, None)
        return flatten_keys(values)

    @cached_property
    def summary(self) -> dict[str, Any]:
        """What summary.json holds; {} before there is one."""
        return json_file(self.path / "summary.json", optional=True)

    def word(self, key: str, argument: str = "group") -> str:
        """The value at `key`, which `argument` names, as a word; of a part its class."""
        found = _matches(self.settings, key)
        if not found and key in self.summary:
            found = {key: self.summary[key]}
        words = {name: _as_word(name, value) for name, value in found.items()}
        if len(set(words.values())) == 1:
            return next(iter(words.values()))
        listed = ", ".join(f"{name}={word}" for name, word in words.items())
        if words:
            problem = f"has several values in {self.path}/config.yaml ({listed})"
        else:
            names = (name for name in self.settings if not name.endswith("_target_"))
            near = nearest(key.rpartition(".")[2], sorted(names, key=lambda name: name.count(".")))
            problem = f"not in {self.path}/config.yaml{f'; it has {near}' if near else ''}"
        raise UsageError(f"{argument}={key}: {problem}")

    def number(self, key: str) -> float:
        """The number at `key`, the x of a picture."""
        word = self.word(key, "x")
        try:
            return float(word)
        except ValueError:
            raise UsageError(f"x={key}: must be a number; {self.path} has {word}") from None


def _matches(settings: Mapping[str, Any], key: str) -> dict[str, Any]:
    """The setting with the full key `key`, or else those whose keys end with it."""
    for end in (key, f"{key}._target_"):
        if end in settings:
            return {end: settings[end]}
    ends = f".{key}", f".{key}._target_"
    return {name: value for name, value in settings.items() if name.endswith(ends)}


def find(runs: str | Path | Iterable[str | Path], key: str = "runs") -> list[Path]:
    """Run folders with metrics that match a glob, or lie in a folder; what exists is no glob.

    runs: one, or several, also as "a/*,b/*" or "[a/*,b/*]". key: the argument that named them.
    """
    given = [runs] if isinstance(runs, (str, Path)) else runs
    matches: list[Path] = []
    for each in given:
        path = Path(each).expanduser()
        exists = str(each) and path.exists()
        matches += [path] if exists else map(Path, glob.glob(str(path), recursive=True))
    if isinstance(runs, str) and "," in runs and not matches:
        text = runs[1:-1] if runs[0] + runs[-1] == "[]" else runs
        several = filter(None, map(str.strip, text.split(",")))
        return [*dict.fromkeys(path for each in several for path in find(each, key))]
    files = sorted({path for match in matches for path in match.glob("**/metrics.jsonl")})
    if begun := [path.parent for path in files if path.stat().st_size]:
        return begun  # a start that failed leaves an empty file
    problem = "no run there (a folder that holds metrics.jsonl)"
    if files:
        more = f" and {len(files) - 1} more" if len(files) > 1 else ""
        problem = f"{files[0]}{more}: no row of metrics yet"
    raise UsageError(f"{key}={runs}: {problem}")


def redrawn(
    file: str | Path, argument: str, draw: Callable[[dict[str, Any]], Any]
) -> tuple[Any, dict[str, Any]]:
    """The picture that `draw` makes of the JSON of an earlier one, which `argument` names."""
    try:
        numbers = json_file(Path(file))
        return draw(arrays(numbers)), numbers
    except UsageError as error:
        raise UsageError(f"{argument}={error}") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise UsageError(f"{argument}={file}: has no numbers of this study") from error


def differences(runs: Sequence[RunFolder], expected: Sequence[str] = ()) -> list[dict[str, str]]:
    """For each run the settings in which the runs differ: key -> value, as words.

    Groups are compared, and single values at the root that all runs have. A value that occurs
    several times, as in the parts to which these refer, counts once, by its shortest key: the one
    that a user overrides. expected: keys that may differ, with all settings of the same values.
    """
    settings = [run.settings for run in runs]
    names = {name for key in expected for each in settings for name in _matches(each, key)}
    known = {_column(settings, name) for name in names | set(expected)}
    columns = {key: _column(settings, key) for key in set().union(*settings)}
    differ = {key: c for key, c in columns.items() if len(set(c)) > 1 and c not in known}
    compared = {
        (key.rpartition(".")[2], column)
        for key, column in differ.items()
        if key not in NOT_SETTINGS
        and not key.endswith(IMPLEMENTATION)
        and ("." in key or UNSET not in column)
        and not (  # of a group that only some have
            UNSET in column
            and len(set(column)) == 2
            and any(parent in differ for parent in _parents(key))
        )
    }
    shortest: dict[tuple[str, tuple[str, ...]], str] = {}
    for key in sorted(differ, key=lambda key: (key.count("."), len(key), key)):
        if (name := (key.rpartition(".")[2], differ[key])) in compared:
            shortest.setdefault(name, key)
    return [
        {key.removesuffix("._target_"): column[i] for (_, column), key in sorted(shortest.items())}
        for i in range(len(runs))
    ]


def short(differing: Sequence[Mapping[str, str]]) -> list[str]:
    """A label for each set of settings: "reward=pybullet", or A, B, ... if that would be long."""
    keys = list(dict.fromkeys(key for each in differing for key in each))
    shown = {key: _ending(key, keys) for key in keys}
    labels = [" ".join(f"{shown[k]}={v}" for k, v in each.items()) for each in differing]
    if len(keys) <= MOST_KEYS and all(len(label) <= MOST_CHARACTERS for label in labels):
        return labels
    numbers = [sorted(set(labels)).index(label) for label in labels]
    return [chr(ord("A") + n % 26) + str(n // 26 or "") for n in numbers]  # ..., Z, A1, B1, ...


def _ending(key: str, keys: Sequence[str]) -> str:
    """The fewest last names of `key` that no other of the keys ends with."""
    names = key.split(".")
    endings = [".".join(names[-number:]) for number in range(1, len(names) + 1)]
    others = [other for other in keys if other != key]
    unique = (end for end in endings if not any(f".{o}".endswith(f".{end}") for o in others))
    return next(unique, key)


def _column(settings: Sequence[Mapping[str, Any]], key: str) -> tuple[str, ...]:
    def one(each: Mapping[str, Any]) -> str:
        for name in (key, f"{key}._target_"):
            if name in each:
                return _as_word(name, each[name])
        return SET if any(name.startswith(f"{key}.") for name in each) else UNSET

    return tuple(map(one, settings))


def _parents(key: str) -> list[str]:
    """The groups that hold a key, and the keys of their classes: "a", "a._target_", ..."""
    parts = key.split(".")
    above = [".".join(parts[:i]) for i in range(1, len(parts))]
    return [name for group in above for name in (group, f"{group}._target_") if name != key]


def _as_word(key: str, value: Any) -> str:
    """The value of a key as a word: of a part its class, of anything else but text its JSON."""
    if key.endswith("_target_"):
        return str(value).rpartition(".")[2]
    return value if isinstance(value, str) else json.dumps(value, default=str)
