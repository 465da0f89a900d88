"""The part of a composed configuration that a run reads, with every field of its parts.

A YAML file says only in what a part differs from its class. A field that no file sets has the
default of the class; one without a default is the part of its name, as the `policy` of a planner is
`${policy}`, and a `world` is `${env}`. Nothing is left that the sections of a run do not read,
themselves or by reference, so a key that is not there is a key without effect.
"""

import difflib
import inspect
import re
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from hybrid_rl.errors import UsageError
from hybrid_rl.files.targets import TARGET, part_class

REFERENCE = re.compile(r"\$\{([\w.@]+)\}")  # an interpolation, which names a key
LACKING: Any = object()  # the value of a key that does not exist
NAMES = {"world": "env"}  # field -> the key that it refers to, where its name is another
CLASSES = {"episode": "hybrid_rl.training.episode.Episode"}  # of a section without a `_target_`
CHOICES = ("settings", "experiment", "learning", "planner")  # groups without a key of their name


def found(raw: Mapping[str, Any], path: str) -> tuple[str, Any]:
    """The key of what `path` names, references on the way followed, and its value or LACKING."""
    at, node = "", raw
    for name in path.split("."):
        while isinstance(node, str) and (link := REFERENCE.fullmatch(node)):
            at, node = found(raw, link[1])
        at = f"{at}.{name}" if at else name
        node = _item(node, name)
    return at, node


def select(raw: Mapping[str, Any], path: str) -> Any:
    """The value at `path`, LACKING if there is none."""
    return found(raw, path)[1]


def _item(node: Any, name: str) -> Any:
    """An entry of a group of keys, or of a list by its index."""
    if isinstance(node, list) and name.isdecimal() and int(name) < len(node):
        return node[int(name)]
    return node.get(name, LACKING) if isinstance(node, dict) else LACKING


def complete(
    raw: dict[str, Any], roots: Iterable[str], typed: Collection[str] = ()
) -> dict[str, Any]:
    """The keys of `raw` at or below `roots`, and those that they refer to; parts are complete.

    raw: what was composed, with its references. typed: keys of the user, which are left out where
    a part has no such field; `require` refuses them then.
    """
    for path in typed:
        above, _, name = found(raw, path)[0].rpartition(".")
        node = select(raw, above) if above else raw
        if isinstance(node, dict) and name in node and name != TARGET:
            fields = _fields(node, above)
            if fields is not None and name not in fields:
                del node[name]
    return _kept(raw, keys(raw, roots, fill=True))


def _fields(node: dict[str, Any], path: str) -> Mapping[str, inspect.Parameter] | None:
    """The fields of the class of a part; None if it is no part, or takes any."""
    if (target := node.get(TARGET, CLASSES.get(path))) is None:
        return None
    try:
        takes = inspect.signature(part_class(target)).parameters
    except ValueError as error:
        raise UsageError(f"{path}.{TARGET}={target}: {error}") from error
    return None if any(field.kind is field.VAR_KEYWORD for field in takes.values()) else takes


def keys(raw: dict[str, Any], roots: Iterable[str] = (), fill: bool = False) -> dict[str, Any]:
    """Key -> value at or below `roots`, and below what they refer to; fill: parts are complete."""
    read: dict[str, Any] = {}
    for root in roots or raw:
        if root in raw:
            _visit(raw, root, raw[root], read, fill)
    return read


def _visit(raw: dict[str, Any], path: str, node: Any, read: dict[str, Any], fill: bool) -> None:
    """Put a key, all below it and all that these refer to into `read`."""
    if path in read:
        return
    read[path] = node
    if fill and isinstance(node, dict) and TARGET in node:
        _fill(raw, path, node)
    listed = dict(enumerate(node)) if isinstance(node, list) else node
    for name, value in listed.items() if isinstance(listed, dict) else ():
        _visit(raw, f"{path}.{name}", value, read, fill)
    for target in REFERENCE.findall(node) if isinstance(node, str) else ():
        at = found(raw, target)[0]
        if fill and select(raw, at) is LACKING:  # perhaps a field that its part does not write
            above = at.rpartition(".")[0]
            holder = select(raw, above) if above else None
            if isinstance(holder, dict) and TARGET in holder:
                _fill(raw, above, holder)
        _visit(raw, at, select(raw, at), read, fill)


def _fill(raw: dict[str, Any], path: str, node: dict[str, Any]) -> None:
    """Give a part the fields that it lacks, in the order of its class."""
    fields = _fields(node, path)
    if fields is None:
        return
    given = dict(node)
    node.clear()
    node[TARGET] = given.pop(TARGET)
    for name, field in fields.items():
        link = NAMES.get(name, name)
        if name in given:
            node[name] = given.pop(name)
        elif field.default is not field.empty:
            value = _written(field.default)
            node |= {} if value is LACKING else {name: value}
        elif not f"{path}.".startswith(f"{link}."):
            node[name] = f"${{{link}}}"  # `build.resolve` refuses what is lacking
    node |= given


def _written(value: Any) -> Any:
    """A value with lists for its tuples; LACKING if YAML cannot hold it."""
    if isinstance(value, tuple):
        entries = [*map(_written, value)]
        return LACKING if any(entry is LACKING for entry in entries) else entries
    return value if value is None or type(value) in (bool, int, float, str) else LACKING


def _kept(node: Any, read: Mapping[str, Any], where: str = "") -> Any:
    """What of a node has its key in `read`."""
    kept = {}
    for key, value in node.items():
        path = f"{where}{key}"
        inner = _kept(value, read, f"{path}.") if isinstance(value, dict) else {}
        if path in read or inner:
            kept[key] = inner if isinstance(value, dict) else value
    return kept


def require(raw: dict[str, Any], path: str, choice: str | None = None, prefix: str = "") -> None:
    """Raise UsageError for a typed key that a configuration lacks.

    choice: what it is to be, of conf/; prefix: what was typed before it, such as `sweep.`.
    """
    if select(raw, path) is not LACKING:
        return
    owner = f"task={raw.get('task')}" if path.startswith("env.") else raw.get("algo")
    if choice:
        near = [f"; did you mean {path}@{key}={choice}?" for key in raw if key.endswith("_" + path)]
        raise UsageError(f"{path}={choice}: {owner} has no {path}{''.join(near[:1])}")
    above, _, last = path.rpartition(".")
    group = select(raw, above) if above else None
    if isinstance(group, dict):
        names = [key for key in group if key != TARGET]
        known, hint = [f"{above}.{key}" for key in names], f"{above} has {', '.join(names)}"
    else:
        values = keys(raw).items()
        known = [*(key for key, value in values if not REFERENCE.match(str(value))), *CHOICES]
        hint = "`--cfg job` shows every key"
    near = nearest(last, known)
    hint = f"did you mean {near}?" if near else hint
    raise UsageError(f"{prefix}{path}: {owner} has no such key; {hint}")


def nearest(word: str, known: Iterable[str]) -> str:
    """The known key that is most like a word: with its last name, or by its letters; or ""."""
    known = [*known]
    ends = re.compile(rf"(^|[._]){re.escape(word)}$")
    if same := [key for key in known if ends.search(key)]:
        return min(same, key=lambda key: (key.split(".")[-1] != word, key.count(".")))
    names = {key.rpartition(".")[2]: key for key in reversed(known)}
    close = difflib.get_close_matches(word, names, 1)
    return names[close[0]] if close else ""
